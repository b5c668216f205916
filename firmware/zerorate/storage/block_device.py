"""A store's bytes on a block device that has no file system; places.py says what is asked of it."""

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any


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
