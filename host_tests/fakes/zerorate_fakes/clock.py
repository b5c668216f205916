"""A clock that moves only when told, and the sample clock of the chips with it."""


class FakeClock:
    """Time in microseconds from start_us; devices are told of every microsecond that passes.

    FakeClock() alone moves no chip: then only FakeMPU6050.step() makes samples.
    """

    def __init__(self, *devices, start_us=0):
        self.devices = list(devices)
        self.now_us = start_us

    def advance_us(self, us):
        """Let us microseconds pass."""
        self.now_us += us
        for device in self.devices:
            device.advance_us(us)

    def ticks_us(self):
        """Now, as time.ticks_us of MicroPython."""
        return self.now_us

    def ticks_diff(self, end, start):
        """Microseconds from start to end."""
        return end - start

    def ticks_add(self, ticks, delta):
        """The time delta microseconds after ticks."""
        return ticks + delta

    def sleep_ms(self, milliseconds):
        """Let time pass at once."""
        self.advance_us(int(1000 * milliseconds))
