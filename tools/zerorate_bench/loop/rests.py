"""Rest at any rate and noise: how much of it is used, and how much of a turn is taken for it."""

import tempfile
from itertools import product
from pathlib import Path

import numpy as np
from zerorate_tools.loop.read.still import still_ticks
from zerorate_tools.loop.read.ticks import read_ticks
from zerorate_tools.recordings import Recording, Scales, write_recording

from .figures import Figure

RATES_HZ = (1 / 15, 1.0, 2.0, 4.0, 5.0, 10.0)
NOISES_DPS = (0.05, 0.35, 1.0)
_LONG_S, _TURN_S, _TURN_DPS = 9000.0, (4000.0, 4300.0), 3.0
#: Around the ends of a turn, seconds: not counted either way.
_ENDS_S, _LEAST_SHARE = 20.0, 95.0
_BESIDE_S = 500.0


def resting(
    folder: Path, odr_hz: float, noise_dps: float, accel: bool, turn_dps: float = 0.0, seed: int = 7
) -> tuple[np.ndarray, np.ndarray]:
    """(m,) what counts as rest, and (m,) seconds, of two and a half hours with white noise.

    turn_dps: about every axis, for five of the minutes.
    """
    rng = np.random.default_rng(seed)
    at_s = np.arange(0, _LONG_S, 1 / odr_hz)
    turning = (at_s >= _TURN_S[0]) & (at_s < _TURN_S[1])
    columns = {"t_us": np.rint(at_s * 1e6).astype(np.int64)}
    for name in ("gx", "gy", "gz"):
        rate = 1.3 + turn_dps * turning + rng.normal(0, noise_dps, len(at_s))
        columns[name] = np.round(rate * 131).astype(np.int32)
    for name, g in (("ax", 0.0), ("ay", 0.0), ("az", 1.0)) if accel else ():
        force = g + rng.normal(0, 0.004, len(at_s))
        columns[name] = np.round(force * 16384).astype(np.int32)
    scales = Scales("MPU-6050", odr_hz, 131.0, 16384.0 if accel else None)
    path = folder / "rest.parquet"
    write_recording(Recording(columns, scales, "rest"), path)
    ticks = read_ticks(path)
    return still_ticks(ticks), np.arange(len(ticks.count)) * ticks.tick_s


def share_used(folder: Path, odr_hz: float, noise_dps: float, accel: bool) -> float:
    """Percent of a rest that is used."""
    return 100.0 * float(resting(folder, odr_hz, noise_dps, accel)[0].mean())


def shares_with_turn(folder: Path, odr_hz: float, noise_dps: float) -> tuple[float, float]:
    """Percent of a turn that is taken for rest, and of the rest beside it that is used."""
    still, at_s = resting(folder, odr_hz, noise_dps, False, _TURN_DPS)
    inside = (at_s >= _TURN_S[0] + _ENDS_S) & (at_s < _TURN_S[1] - _ENDS_S)
    beside = (at_s < _TURN_S[0] - _BESIDE_S) | (at_s > _TURN_S[1] + _BESIDE_S)
    return 100.0 * float(still[inside].mean()), 100.0 * float(still[beside].mean())


def rest_figures() -> list[Figure]:
    """The worst of all rates and noises, with and without an accelerometer."""
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        rests = [share_used(folder, *one) for one in product(RATES_HZ, NOISES_DPS, (False, True))]
        turns = [shares_with_turn(folder, *one)[0] for one in product(RATES_HZ, NOISES_DPS)]
    span = f"1/15 to {RATES_HZ[-1]:g} Hz, noise {NOISES_DPS[0]:g} to {NOISES_DPS[-1]:g} dps"
    return [
        Figure(f"rest used, the least ({span})", min(rests), _LEAST_SHARE, False, len(rests)),
        Figure(f"turn of {_TURN_DPS:g} dps taken for rest", max(turns), 0.0, True, len(turns)),
    ]
