"""The chip's first-in first-out memory: bytes, oldest lost first, overflow told once."""


class Fifo:
    """size bytes; keep_oldest is FIFO_MODE of the 6500 and later: full, it takes no more."""

    def __init__(self, size: int) -> None:
        self.size = size
        self.keep_oldest = False
        self.overflowed = False
        self._ring = bytearray(size)
        self.clear()

    def clear(self) -> None:
        """Empty, as FIFO_RESET does."""
        self._first = 0
        self.count = 0
        self._last_read = 0xFF

    def put(self, byte: int) -> None:
        """Append a byte; when full the oldest goes, or with keep_oldest the new one."""
        if self.count == self.size:
            self.overflowed = True
            if self.keep_oldest:
                return
            self._first = (self._first + 1) % self.size
            self.count -= 1
        self._ring[(self._first + self.count) % self.size] = byte
        self.count += 1

    def get(self) -> int:
        """Take the oldest byte; empty, the last one again."""
        if self.count:
            self._last_read = self._ring[self._first]
            self._first = (self._first + 1) % self.size
            self.count -= 1
        return self._last_read
