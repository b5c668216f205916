"""Where a store's bytes live: anything with readblock(offset, buf) and writeblock(offset, buf).

readblock fills buf with what stands at byte offset; writeblock puts buf there and returns when it
is durable. Both may raise OSError. Bytes never written may read as anything. The driver of an
EEPROM needs these two methods and no more; erasing flash is the storage's own business.
"""

import os

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any


class FileStorage:
    """A file, made when first written; a missing file or what is beyond its end reads as 0xFF."""

    def __init__(self, path: str) -> None:
        self.path = path

    def readblock(self, offset: int, buf: "bytearray | memoryview") -> None:
        """Fill buf from the file."""
        count = 0
        try:
            with open(self.path, "rb") as file:
                file.seek(offset)
                count = file.readinto(buf) or 0
        except OSError:
            if not self._is_missing():
                raise
        for i in range(count, len(buf)):
            buf[i] = 0xFF

    def writeblock(self, offset: int, buf: "bytes | bytearray | memoryview") -> None:
        """Write buf into the file and to the medium."""
        with self._open(offset) as file:
            file.seek(offset)
            file.write(buf)
            file.flush()
            if hasattr(os, "fsync"):
                os.fsync(file.fileno())

    def _open(self, offset):
        try:
            return open(self.path, "r+b")
        except OSError:
            if not self._is_missing():
                raise
        file = open(self.path, "w+b")
        file.write(b"\xff" * offset)
        return file

    def _is_missing(self):
        """By stat: errno of a missing file is not 2 on every port."""
        try:
            os.stat(self.path)
        except OSError:
            return True
        return False


class BlockDeviceStorage:
    """MicroPython's block device of the extended kind, as rp2.Flash or esp32.Partition.

    first_block is where the area begins, blocks how many it has. Its blocks are block_bytes long
    and are erased before they are written: give each slot its own (Store's pitch).
    """

    _ERASE = 6  # MP_BLOCKDEV_IOCTL_BLOCK_ERASE

    def __init__(self, device: "Any", first_block: int, block_bytes: int) -> None:
        self.device = device
        self.first_block = first_block
        self.block_bytes = block_bytes

    def readblock(self, offset: int, buf: "bytearray | memoryview") -> None:
        """Fill buf from the device."""
        block = self.first_block + offset // self.block_bytes
        self.device.readblocks(block, buf, offset % self.block_bytes)

    def writeblock(self, offset: int, buf: "bytes | bytearray | memoryview") -> None:
        """Erase the blocks that buf begins or goes on in, and write it."""
        first = self.first_block + offset // self.block_bytes
        last = self.first_block + (offset + len(buf) - 1) // self.block_bytes
        for block in range(first, last + 1):
            self.device.ioctl(self._ERASE, block)
        self.device.writeblocks(first, buf, offset % self.block_bytes)
