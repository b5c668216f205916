"""Where a store's bytes live: anything with readblock(offset, buf) and writeblock(offset, buf).

readblock fills buf with what stands at byte offset; writeblock puts buf there and returns when it
is durable. Both may raise OSError. Bytes never written may read as anything. The driver of an
EEPROM needs these two methods and no more; erasing flash is the storage's own business. One that
has read_pieces and write_pieces as well gives and takes a record in pieces, so that none is made.
"""

import os

TYPE_CHECKING = False
if TYPE_CHECKING:
    from array import array
    from collections.abc import Iterable, Iterator

    Buffer = bytes | bytearray | memoryview | array[int]


class FileStorage:
    """A file, made when first written; a missing file or what is beyond its end reads as 0xFF."""

    def __init__(self, path: str) -> None:
        self.path = path

    def readblock(self, offset: int, buf: "bytearray | memoryview") -> None:
        """Fill buf from the file."""
        for _ in self.read_pieces(offset, len(buf), buf):
            pass

    def read_pieces(
        self, offset: int, length: int, buf: "bytearray | memoryview"
    ) -> "Iterator[memoryview]":
        """Yield what stands there in pieces, each in buf, by one opening of the file."""
        file = None if self._is_missing() else open(self.path, "rb")
        try:
            if file:
                file.seek(offset)
            for done in range(0, length, len(buf)):
                piece = memoryview(buf)[: length - done]
                count = file.readinto(piece) or 0 if file else 0
                for i in range(count, len(piece)):
                    piece[i] = 0xFF
                yield piece
        finally:
            if file:
                file.close()

    def writeblock(self, offset: int, buf: "bytes | bytearray | memoryview") -> None:
        """Write buf into the file and to the medium."""
        self.write_pieces(offset, (buf,))

    def write_pieces(self, offset: int, pieces: "Iterable[Buffer]") -> None:
        """Write what is to stand one behind the other, and all of it to the medium."""
        if self._is_missing():
            pieces = (b"\xff" * offset,) + tuple(pieces)
            offset = 0
            mode = "w+b"
        else:
            mode = "r+b"
        with open(self.path, mode) as file:
            file.seek(offset)
            for piece in pieces:
                file.write(piece)
            file.flush()
            if hasattr(os, "fsync"):
                os.fsync(file.fileno())

    def _is_missing(self):
        try:
            os.stat(self.path)
        except OSError:
            return True
        return False
