"""A clock that moves only when told, and the sample clock of the chips with it."""

TYPE_CHECKING = False

if TYPE_CHECKING:
    from .device import FakeMPU6050


class FakeClock:
    """Time in microseconds from start_us; devices are told of every microsecond that passes.

    FakeClock() alone moves no chip: then only FakeMPU6050.step() makes samples.
    """

    def __init__(self, *devices: "FakeMPU6050", start_us: int = 0) -> None:
        self.devices = list(devices)
        self.now_us = start_us

    def advance_us(self, us: int) -> None:
        """Let us microseconds pass."""
        self.now_us += us
        for device in self.devices:
            device.advance_us(us)

    def ticks_us(self) -> int:
        """Now, as time.ticks_us of MicroPython."""
        return self.now_us

    def ticks_diff(self, end: int, start: int) -> int:
        """Microseconds from start to end."""
        return end - start

    def ticks_add(self, ticks: int, delta: int) -> int:
        """The time delta microseconds after ticks."""
        return ticks + delta

    def sleep_ms(self, milliseconds: float) -> None:
        """Let time pass at once."""
        self.advance_us(int(1000 * milliseconds))
