"""Emulated chips for `fake:` by the driver's names of parts; settings judged without a chip."""

from zerorate_fakes import FakeMPU6050, Physical
from zerorate_i2c.parts import MPU6050_KIND, MPU6500_KIND, part_by_id, part_by_name
from zerorate_i2c.settings import choose_divider, choose_filter


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
