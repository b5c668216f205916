"""The chip's interrupt pin: when each sample became ready, taken without allocation."""

TYPE_CHECKING = False
if TYPE_CHECKING:
    from typing import Any

    from .mpu6050 import MPU6050

const = int  # on a board the compiler itself reads const(...)

_INT_PIN_CFG = const(0x37)
_INT_ENABLE = const(0x38)
_ANY_READ_CLEARS = const(0x10)
_DATA_RDY_EN = const(0x01)


class DataReady:
    """Data-ready pulses of imu, an MPU6050, on pin, a machine.Pin wired to the chip's INT.

    After take() or wait(): dt_us is the time from the sample taken before to the newest one, 0
    where none came, and missed counts the samples in between that nobody took, those of a time
    without interrupts too (while flash is written).
    """

    def __init__(self, imu: "MPU6050", pin: "Any") -> None:
        self.imu = imu
        self.missed = 0
        self.dt_us = 0
        self._clock = imu.clock
        self._edges = 0
        self._taken = 0
        self._edge_us = self._clock.ticks_us()
        self._taken_us = self._edge_us
        imu.keep_setting(_INT_PIN_CFG, _ANY_READ_CLEARS)
        imu.keep_setting(_INT_ENABLE, _DATA_RDY_EN)
        pin.irq(handler=self._on_edge, trigger=pin.IRQ_RISING)

    def take(self) -> bool:
        """True when a sample became ready since the last take; read it now."""
        edges = self._edges
        if edges == self._taken:
            return False
        edge_us = self._edge_us
        while edges != self._edges:  # one more came between the two
            edges = self._edges
            edge_us = self._edge_us
        self.dt_us = self._clock.ticks_diff(edge_us, self._taken_us)
        if self.dt_us < 0:  # more than 9 minutes by a board's clock, which wraps after 18
            self.dt_us &= 0x3FFFFFFF
        period_us = self.imu.period_us
        passed = (self.dt_us + period_us // 2) // period_us
        self.missed += max((edges - self._taken) & 0xFFFF, passed) - 1
        self._taken = edges
        self._taken_us = edge_us
        return True

    def wait(self, timeout_ms: int) -> bool:
        """take() as soon as there is one, looking every millisecond; False after timeout_ms.

        A chip that lost its power sends no pulses, so the next read then asks for its settings.
        """
        for _ in range(timeout_ms):
            if self.take():
                return True
            self._clock.sleep_ms(1)
        if self.take():
            return True
        self.dt_us = 0
        self.imu.doubt(False)
        return False

    def _on_edge(self, pin):
        self._edge_us = self._clock.ticks_us()
        self._edges = (self._edges + 1) & 0xFFFF
