"""A memory that loses power: a storage of bytes cut at a chosen byte, or with one bit turned."""


class PowerCut(Exception):
    """The power went in the middle of a write."""


class FakeMemory:
    """size bytes of EEPROM with the two methods of a storage.

    cut_after n lets n more bytes be written, then raises PowerCut; the byte being written then
    becomes torn_byte (None: stays as it was).
    """

    def __init__(self, size: int, erased: int = 0xFF) -> None:
        self.bytes = bytearray([erased] * size)
        self.written = 0
        self.cut_after: "int | None" = None
        self.torn_byte: "int | None" = None
        self.broken = False

    def readblock(self, offset: int, buf: "bytearray | memoryview") -> None:
        """Fill buf."""
        if self.broken:
            raise OSError(5)
        buf[:] = self.bytes[offset : offset + len(buf)]

    def writeblock(self, offset: int, buf: "bytes | bytearray | memoryview") -> None:
        """Write buf, byte by byte."""
        if self.broken:
            raise OSError(5)
        for i in range(len(buf)):
            if self.cut_after == 0:
                if self.torn_byte is not None:
                    self.bytes[offset + i] = self.torn_byte
                raise PowerCut
            if self.cut_after is not None:
                self.cut_after -= 1
            self.bytes[offset + i] = buf[i]
            self.written += 1

    def flip(self, bit: int) -> None:
        """Turn one bit, counted over all bytes."""
        self.bytes[bit >> 3] ^= 1 << (bit & 7)


class FakeMemoryInPieces(FakeMemory):
    """One that takes a record as it comes, as a file does."""

    def write_pieces(self, offset: int, pieces: "tuple[bytes, ...]") -> None:
        """Write one behind the other."""
        for piece in pieces:
            self.writeblock(offset, bytes(piece))
            offset += len(bytes(piece))
