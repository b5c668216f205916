"""Earth's rotation: no error of the sensor, so it is taken out where it can be known.

A gyroscope at rest reads 4.18 mdps along the axis of the Earth: with latitude and attitude all of
it is known, with latitude and the direction of gravity its vertical part, without a latitude none.
"""

from dataclasses import dataclass

import numpy as np

from ...simulate.attitude import into_body
from ...simulate.world import earth_rate_dps
from .ticks import Ticks

EARTH_DPS = float(np.linalg.norm(earth_rate_dps(0.0)))
ATTITUDE, LATITUDE = "attitude", "latitude_deg"
ROTATION = "earth-rotation"
_POSES = 100
#: Sigmas beyond which an effect is surely larger.
_SURE = 3.0


@dataclass(frozen=True)
class Earth:
    """Earth's rate in a recording. rate_dps: (m, 3) of each tick, what is known of it, in the
    body; unknown_dps: most that is not known of it; said: a sentence for the report."""

    rate_dps: np.ndarray
    unknown_dps: float
    said: str


def earth_of(ticks: Ticks) -> Earth:
    """What is known of Earth's rate at the ticks of a recording."""
    none = np.zeros((len(ticks.count), 3))
    latitude = ticks.scales.more.get(LATITUDE)
    if not isinstance(latitude, (int, float)):
        return Earth(none, EARTH_DPS, _left(EARTH_DPS, "no latitude_deg is given"))
    world = earth_rate_dps(float(latitude))
    attitude = _attitude(ticks)
    if attitude is not None:
        return Earth(into_body(attitude, world), 0.0, "Earth's rotation is removed, by attitude")
    level = float(np.hypot(world[0], world[1]))
    if ticks.accel is None:
        return Earth(none, EARTH_DPS, _left(EARTH_DPS, "neither attitude nor gravity is recorded"))
    up = ticks.accel / np.maximum(np.linalg.norm(ticks.accel, axis=1, keepdims=True), 1e-6)
    said = "the vertical part of Earth's rotation is removed, by gravity; "
    return Earth(up * world[2], level, said + _left(level, "the heading is not known"))


def _left(dps: float, why: str) -> str:
    return f"up to {1e3 * dps:.1f} mdps of Earth's rotation are in the rates: {why}"


def _attitude(ticks: Ticks) -> np.ndarray | None:
    """(m, 4) or (4,) attitude, or None. A constant one travels in the scales as w x y z."""
    if ticks.attitude is not None:
        return ticks.attitude
    given = ticks.scales.more.get(ATTITUDE)
    if not isinstance(given, (list, tuple)) or len(given) != 4:
        return None
    q = np.asarray(given, float)
    return np.broadcast_to(q / np.linalg.norm(q), (len(ticks.count), 4))


def can_be_earth(
    poses: np.ndarray, coefficients: np.ndarray, covariance: np.ndarray, unknown_dps: float
) -> bool:
    """Whether an effect of acceleration may be no larger than the unknown part of Earth's rate.

    poses: (n, k) its bases in the poses that were seen; coefficients: (k, 3) dps per unit;
    covariance: (3, k, k) of them. The difference between any two poses, less three sigma of it, is
    compared with twice that part, which a part turned over can see.
    """
    some = poses[:: max(1, len(poses) // _POSES)]
    apart = some[:, None] - some
    effect = apart @ coefficients
    size = np.linalg.norm(effect, axis=2)
    spread = np.einsum("mnk,akl,mnl->mna", apart, covariance, apart)
    along = effect / np.maximum(size, 1e-300)[..., None]
    sigma = np.sqrt(np.maximum((along**2 * spread).sum(axis=2), 0.0))
    return bool((size - _SURE * sigma).max() <= 2.0 * unknown_dps)
