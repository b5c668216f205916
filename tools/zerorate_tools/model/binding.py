"""For which chip and settings a model is made, as far as its recordings say."""

from zerorate_i2c.parts import part_by_name
from zerorate_i2c.settings import ACCEL_LSB_PER_G, GYRO_LSB_PER_DPS

from ..recordings import Scales
from .model import Binding

KEY = "binding"
NAMES = ("chip_id", "gyro_range", "accel_range", "filter")


def binding_of(scales: Scales) -> Binding:
    """The binding that a recording's scales hold (`zerorate record` writes it); else what follows
    from the sensor's name and scales for a part of the MPU-6050 family; else nothing.
    """
    recorded = scales.more.get(KEY)
    if isinstance(recorded, dict):
        codes = {name: recorded.get(name) for name in NAMES}
        if all(c is None or (type(c) is int and 0 <= c < 255) for c in codes.values()):
            return Binding(**codes)
    try:
        chip_id = part_by_name(scales.sensor)[0]
    except ValueError:
        return Binding()
    return Binding(
        chip_id,
        _code(scales.gyro_lsb_per_dps, GYRO_LSB_PER_DPS),
        _code(scales.accel_lsb_per_g, ACCEL_LSB_PER_G),
    )


def _code(lsb: float | None, known: tuple[float, ...]) -> int | None:
    """The index of the range with that scale, within a thousandth."""
    near = [i for i, one in enumerate(known) if lsb and abs(lsb - one) <= 1e-3 * one]
    return near[0] if near else None
