"""Emulated chips for `fake:` by the driver's names of parts; settings judged without a chip."""

from zerorate_fakes import FakeI2C, FakeMPU6050, Physical
from zerorate_i2c import clock
from zerorate_i2c.parts import MPU6050_KIND, MPU6500_KIND, part_by_id, part_by_name
from zerorate_i2c.settings import choose_divider, choose_filter

_BIAS_DPS = (0.31, -0.19, 0.08)


def fake_chip(felt: Physical, part: str | None = None) -> FakeMPU6050:
    """The part of that name, MPU-6050 by default. Raises ValueError for an unknown one."""
    # parts of one id are the same chip
    row = part_by_id(part_by_name(part or "MPU-6050")[0])
    return FakeMPU6050(felt, part=row[1])


def require_settings(
    odr_hz: float = 100, dlpf_hz: float | None = None, part: str | None = None
) -> None:
    """Raise ValueError for a rate and a filter that no part can take, or not the part named."""
    kinds = (part_by_name(part)[6],) if part else (MPU6050_KIND, MPU6500_KIND)
    for kind in kinds:
        try:
            choose_divider(choose_filter(kind, odr_hz, dlpf_hz)[0], odr_hz)
            return
        except ValueError:
            if kind == kinds[-1]:
                raise


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
