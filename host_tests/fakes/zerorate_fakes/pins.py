"""The two wires of a FakeI2C as open-drain pins, to free a bus whose SDA is held low."""


class FakePin:
    """A Pin-like object: value() reads the wire, value(1) lets it go, value(0) pulls it low."""

    def __init__(self, wires, name):
        self._wires = wires
        self._name = name

    def value(self, level=None):
        """Read, or drive."""
        if level is None:
            return self._wires.level(self._name)
        self._wires.drive(self._name, level)


class BusWires:
    """scl and sda of bus; its chip lets SDA go after sda_held_bits clocks and a STOP ends it."""

    def __init__(self, bus):
        self._bus = bus
        self._driven = {"scl": 1, "sda": 1}
        self._bits = bus.sda_held_bits
        self.clocks = 0
        self.scl = FakePin(self, "scl")
        self.sda = FakePin(self, "sda")

    def level(self, name):
        """What a pin reads."""
        if name == "sda" and self._bits > 0:
            return 0
        return self._driven[name]

    def drive(self, name, level):
        """What a pin does, and what the chip makes of it."""
        before = self.level(name)
        self._driven[name] = level
        rose = not before and self.level(name)
        if name == "scl" and rose:
            self.clocks += 1
            self._bits = max(0, self._bits - 1)
        if name == "sda" and rose and self._driven["scl"]:
            self._bus.sda_held_bits = 0


class InterruptPin:
    """The pin that a chip's INT goes to; calls its handler at every data-ready pulse."""

    IRQ_RISING = 1

    def __init__(self, chip):
        self._handler = None
        chip.interrupt = self._pulse

    def irq(self, handler, trigger):
        """As machine.Pin.irq."""
        self._handler = handler

    def _pulse(self):
        if self._handler:
            self._handler(self)
