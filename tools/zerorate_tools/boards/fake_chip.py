"""Emulated chips for `fake:` by the driver's names of parts."""

from zerorate_fakes import FakeI2C, FakeMPU6050, Physical
from zerorate_i2c import clock
from zerorate_i2c.parts import part_by_id, part_by_name

_BIAS_DPS = (0.31, -0.19, 0.08)


def fake_chip(felt: Physical, part: str | None = None) -> FakeMPU6050:
    """The part of that name, MPU-6050 by default. Raises ValueError for an unknown one."""
    # parts of one id are the same chip
    row = part_by_id(part_by_name(part or "MPU-6050")[0])
    return FakeMPU6050(felt, part=row[1])


class FakeBus(FakeI2C):
    """The bus of a chip with a bias, whose time is this machine's. Raises ValueError."""

    def __init__(self, address: int = 0x68, part: str | None = None) -> None:
        self.chip = fake_chip(Physical(gyro_dps=_BIAS_DPS), part)
        super().__init__({address: self.chip})
        self._last_us = clock.ticks_us()

    def _begin(self, wire_bytes: int) -> str | None:
        now_us = clock.ticks_us()
        self.chip.advance_us(clock.ticks_diff(now_us, self._last_us))
        self._last_us = now_us
        return super()._begin(wire_bytes)

    def close(self) -> None:
        """Nothing to close: the chip goes on."""
