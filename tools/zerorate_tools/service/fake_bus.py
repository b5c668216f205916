"""An emulated chip at rest: `zerorate run fake:` tries the service without hardware."""

from zerorate_fakes import FakeI2C, FakeMPU6050, Physical
from zerorate_i2c import clock

_BIAS_DPS = (0.31, -0.19, 0.08)


class FakeBus(FakeI2C):
    """The bus of a chip with a bias, whose time is this machine's."""

    def __init__(self, address: int = 0x68, part: str | None = None) -> None:
        self.chip = FakeMPU6050(Physical(gyro_dps=_BIAS_DPS), part=part or "MPU-6050")
        super().__init__({address: self.chip})
        self._last_us = clock.ticks_us()

    def _begin(self, wire_bytes: int) -> str | None:
        now_us = clock.ticks_us()
        self.chip.advance_us(clock.ticks_diff(now_us, self._last_us))
        self._last_us = now_us
        return super()._begin(wire_bytes)

    def close(self) -> None:
        """Nothing to close: the chip goes on."""
