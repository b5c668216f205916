"""The other way to start a device from the part: estimators filled as if it had lived already."""

# Measured beside the prior as a model (benefit.py): a new device lies off the part's level by more
# than a power-on's offset ever does, so the firmware holds its first rests back as implausible, and
# the estimators at other temperatures keep the part's level, not the device's.

from os import PathLike

import numpy as np

from ..recordings import Recording, Scales
from ..replay import AT_REST_ALONE, replay

_STEPS = 8
_SECONDS_A_STEP = 12.0
_NOISE_DPS = 0.05


def prefill(
    degc: np.ndarray, bias_dps: np.ndarray, scales: Scales, state: str | PathLike[str]
) -> None:
    """Write the state of a firmware that rested at eight temperatures of a curve.

    degc: (n,) rising, bias_dps: (n, 3). Each rest is just long enough to be kept for long.
    """
    steps = np.linspace(degc[0], degc[-1], _STEPS)
    each = round(_SECONDS_A_STEP * scales.odr_hz)
    warm = np.repeat(steps, each)
    rates = np.stack([np.interp(warm, degc, bias_dps[:, a]) for a in range(3)], axis=1)
    rng = np.random.default_rng(1)
    rates = (rates + rng.normal(0, _NOISE_DPS, rates.shape)) * scales.gyro_lsb_per_dps
    replay(_recording(warm, rates, scales, rng), state=state, options=AT_REST_ALONE)


def _recording(warm, rates_lsb, scales: Scales, rng) -> Recording:
    n = len(warm)
    columns = {"t_us": (np.arange(n) * 1e6 / scales.odr_hz).astype(np.int64)}
    for axis, name in enumerate("xyz"):
        columns[f"g{name}"] = np.rint(rates_lsb[:, axis]).astype(np.int32)
        if scales.accel_lsb_per_g:
            level = scales.accel_lsb_per_g if name == "z" else 0.0
            columns[f"a{name}"] = np.rint(level + rng.normal(0, 20, n)).astype(np.int32)
    raw = (warm - (scales.temp_offset_degc or 0.0)) * (scales.temp_lsb_per_degc or 0.0)
    columns["temp"] = np.rint(raw).astype(np.int32)
    return Recording(columns, scales, "prior")
