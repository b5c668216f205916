"""FakeI2C seen as CircuitPython's busio.I2C, for drivers written for that."""

TYPE_CHECKING = False

if TYPE_CHECKING:
    from typing import Any

    from _typeshed import ReadableBuffer

    from .bus import FakeI2C


class CircuitPythonI2C:
    """The methods of busio.I2C over a FakeI2C; as there, RuntimeError without the lock."""

    def __init__(self, bus: "FakeI2C") -> None:
        self.bus = bus
        self._locked = False

    def __enter__(self) -> "CircuitPythonI2C":
        return self

    def __exit__(self, *error: "Any") -> None:
        self.deinit()

    def deinit(self) -> None:
        """Nothing to let go."""

    def try_lock(self) -> bool:
        """Take the bus; False when it is taken."""
        if self._locked:
            return False
        self._locked = True
        return True

    def unlock(self) -> None:
        """Give the bus back."""
        self._locked = False

    def scan(self) -> "list[int]":
        """Addresses that acknowledge."""
        self._require_lock()
        return self.bus.scan()

    def writeto(
        self, address: int, buffer: "ReadableBuffer", *, start: int = 0, end: "int | None" = None
    ) -> None:
        """First byte sets the register pointer, the rest is written from there on."""
        self._require_lock()
        self.bus.writeto(address, bytes(buffer)[start:end])

    def readfrom_into(
        self,
        address: int,
        buffer: "bytearray | memoryview",
        *,
        start: int = 0,
        end: "int | None" = None,
    ) -> None:
        """Fill buffer[start:end] from the register pointer on."""
        self._require_lock()
        self.bus.readfrom_into(address, memoryview(buffer)[start:end])

    def writeto_then_readfrom(
        self,
        address: int,
        out_buffer: "ReadableBuffer",
        in_buffer: "bytearray | memoryview",
        *,
        out_start: int = 0,
        out_end: "int | None" = None,
        in_start: int = 0,
        in_end: "int | None" = None,
    ) -> None:
        """Write, repeated start, read."""
        self.writeto(address, out_buffer, start=out_start, end=out_end)
        self.readfrom_into(address, in_buffer, start=in_start, end=in_end)

    def _require_lock(self) -> None:
        if not self._locked:
            raise RuntimeError("Function requires lock")
