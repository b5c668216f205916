"""Registers of one device on an I2C bus, read with bounded retries and without allocation."""

import sys

TYPE_CHECKING = False
if TYPE_CHECKING:
    from array import array
    from typing import Any

const = int  # on a board the compiler itself reads const(...)

_WORDS = const(7)


class Registers:
    """The registers at address on i2c, any object with readfrom_mem_into and writeto_mem.

    A read is tried 1 + retries times before OSError passes; bus_errors counts every failure.
    """

    def __init__(self, i2c: "Any", address: int, retries: int) -> None:
        self.i2c = i2c
        self.address = address
        self.bus_errors = 0
        self._retries = retries
        self._byte = bytearray(1)
        self._register = 0
        self._target = self._byte

    def read_register(self, register: int) -> int:
        """One register's value."""
        self.read_into(register, self._byte)
        return self._byte[0]

    def write_register(self, register: int, value: int) -> None:
        """Write one register; not tried again, as the first try may have been heard."""
        self._byte[0] = value
        self.i2c.writeto_mem(self.address, register, self._byte)

    def read_into(self, register: int, buffer: "Any") -> None:
        """Fill buffer from register on; OSError after 1 + retries failures."""
        self._register = register
        self._target = buffer
        self._transfer()

    # Arguments by attribute: a frame with an exception handler has room for 8 words, not 11.
    def _transfer(self):
        try:
            self.i2c.readfrom_mem_into(self.address, self._register, self._target)
        except OSError:
            if not self._retry():
                raise

    def _retry(self):
        for _ in range(self._retries):
            self.bus_errors += 1
            try:
                self.i2c.readfrom_mem_into(self.address, self._register, self._target)
                return True
            except OSError:
                pass
        self.bus_errors += 1
        return False


def decode(frames: "bytes | bytearray", start: int, sample: "array[int]") -> None:
    """Seven big-endian 16-bit words of frames from start on to signed integers in sample."""
    for i in range(_WORDS):
        word = frames[start] << 8 | frames[start + 1]
        start += 2
        sample[i] = word - ((word & 0x8000) << 1)


def unload(name):
    """Let a module of the driver go that only a constructor needs; on a board, where it counts."""
    if sys.implementation.name == "micropython":
        sys.modules.pop("zerorate_i2c." + name, None)
        sys.modules["zerorate_i2c"].__dict__.pop(name, None)
