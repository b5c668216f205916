"""Pins beside a FakeI2C: its two wires, open-drain, and the one that a chip's INT goes to."""

TYPE_CHECKING = False

if TYPE_CHECKING:
    from collections.abc import Callable

    from .bus import FakeI2C
    from .device import FakeMPU6050


class FakePin:
    """A Pin-like object: value() reads the wire, value(1) lets it go, value(0) pulls it low."""

    def __init__(self, wires: "BusWires", name: str) -> None:
        self._wires = wires
        self._name = name

    def value(self, level: "int | None" = None) -> "int | None":
        """Read, or drive."""
        if level is None:
            return self._wires.level(self._name)
        self._wires.drive(self._name, level)
        return None


class BusWires:
    """scl and sda of bus; its chip lets SDA go after sda_held_bits clocks and a STOP ends it."""

    def __init__(self, bus: "FakeI2C") -> None:
        self._bus = bus
        self._driven = {"scl": 1, "sda": 1}
        self._bits = bus.sda_held_bits
        self.scl = FakePin(self, "scl")
        self.sda = FakePin(self, "sda")

    def level(self, name: str) -> int:
        """What a pin reads."""
        if name == "sda" and self._bits > 0:
            return 0
        return self._driven[name]

    def drive(self, name: str, level: int) -> None:
        """What a pin does, and what the chip makes of it."""
        before = self.level(name)
        self._driven[name] = level
        rose = not before and self.level(name)
        if name == "scl" and rose:
            self._bits = max(0, self._bits - 1)
        if name == "sda" and rose and self._driven["scl"]:
            self._bus.sda_held_bits = 0


class InterruptPin:
    """The pin that INT of chip goes to: its level, and a handler called at the edges asked for."""

    IRQ_FALLING = 2
    IRQ_RISING = 1

    def __init__(self, chip: "FakeMPU6050") -> None:
        self._handler: "Callable[[InterruptPin], object] | None" = None
        self._trigger = 0
        self._chip = chip
        self._level = chip.int_level
        chip.interrupt = self._changed

    def irq(self, handler: "Callable[[InterruptPin], object] | None", trigger: int = 3) -> None:
        """As machine.Pin.irq."""
        self._handler = handler
        self._trigger = trigger

    def value(self) -> int:
        """As machine.Pin.value."""
        return self._chip.int_level

    def _changed(self) -> None:
        level = self._chip.int_level
        edge = self.IRQ_RISING if level else self.IRQ_FALLING
        if level != self._level and self._handler and self._trigger & edge:
            self._handler(self)
        self._level = level
