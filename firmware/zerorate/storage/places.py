"""Where a store's bytes live: anything with readblock(offset, buf) and writeblock(offset, buf).

readblock fills buf with what stands at byte offset; writeblock puts buf there and returns when it
is durable. Both may raise OSError. Bytes never written may read as anything. The driver of an
EEPROM needs these two methods and no more; erasing flash is the storage's own business.
"""

import os


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
