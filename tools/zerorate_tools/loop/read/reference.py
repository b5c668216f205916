"""What the rate truly was while the device turned: given rates, or the change of a given attitude.

Columns `ref_gx ref_gy ref_gz` are rates in LSB of the gyroscope; columns `qw qx qy qz`, any common
prefix before them, are the attitude, body to world (z up), each sample's own, in any common unit
and all four 0, or without a value, where it was not seen.
"""

from collections.abc import Mapping

import numpy as np

from ...recordings.checks import GAP
from ...recordings.recording import ATTITUDE
from ...simulate.attitude import multiply

RATES = ("ref_gx", "ref_gy", "ref_gz")


def attitude_names(names: list[str]) -> tuple[str, ...] | None:
    """The four columns of an attitude among a recording's, or None."""
    for name in names:
        if name.endswith("qw"):
            four = tuple(name[:-2] + part for part in ATTITUDE)
            if all(n in names for n in four):
                return four
    return None


def declared(more: Mapping[str, object]) -> set[str]:
    """Columns that a recording's scales declare a reference, as an import does; no bias follows
    them."""
    channels = more.get("channels")
    said = channels.items() if isinstance(channels, dict) else ()
    return {n for n, c in said if isinstance(c, dict) and c.get("role") == "reference"}


class Reference:
    """Reads the reference of a recording batch by batch; it remembers the last sample of each."""

    def __init__(self, names: list[str], gyro_lsb_per_dps: float) -> None:
        self.lsb = gyro_lsb_per_dps
        self.rates = RATES if all(n in names for n in RATES) else None
        self.attitude = attitude_names(names)
        self._last: tuple[int, np.ndarray] | None = None
        self._signed = np.zeros(4)

    @property
    def names(self) -> tuple[str, ...]:
        """Columns that are reference and no channel that a bias could follow."""
        return (*(self.rates or ()), *(self.attitude or ()))

    def quaternions(self, batch: Mapping[str, np.ndarray]) -> np.ndarray:
        """(n, 4) unit attitude of one sign from sample to sample, NaN where it was not seen."""
        assert self.attitude is not None
        q = np.column_stack([batch[n].astype(float) for n in self.attitude])
        q[(q == GAP).any(axis=1)] = 0.0
        length = np.linalg.norm(q, axis=1)
        seen = np.flatnonzero(length > 0)
        q[seen] /= length[seen, None]
        before = np.vstack([self._signed, q[seen][:-1]])[: len(seen)]
        q[seen] *= np.cumprod(np.where((q[seen] * before).sum(axis=1) < 0, -1.0, 1.0))[:, None]
        q[length == 0] = np.nan
        if len(seen):
            self._signed = q[seen[-1]]
        return q

    def rate_dps(
        self, t_us: np.ndarray, batch: Mapping[str, np.ndarray], q: np.ndarray | None
    ) -> np.ndarray:
        """(n, 3) dps, NaN where it is not known: at a gap, and at the first sample.

        q: what `quaternions` gave for this batch, where the reference is an attitude.
        """
        if self.rates:
            words = np.column_stack([batch[n] for n in self.rates])
            return np.where(words == GAP, np.nan, words / self.lsb)
        assert q is not None
        if self._last is None:
            self._last = int(t_us[0]), np.full(4, np.nan)
        before = np.vstack([self._last[1], q[:-1]])
        dt_s = np.diff(t_us, prepend=self._last[0]) * 1e-6
        self._last = int(t_us[-1]), q[-1]
        turned = multiply(before * [1, -1, -1, -1], q)
        turned *= np.where(turned[:, :1] < 0, -1.0, 1.0)
        sine = np.linalg.norm(turned[:, 1:], axis=1)
        angle = 2 * np.degrees(np.arctan2(sine, turned[:, 0]))
        with np.errstate(invalid="ignore", divide="ignore"):
            axis = np.where(sine[:, None] > 1e-12, turned[:, 1:] / sine[:, None], 0.0)
            return axis * (angle / dt_s)[:, None]


def change_of(t_us: np.ndarray, reference_dps: np.ndarray) -> np.ndarray:
    """(n, 3) dps a second; NaN at the ends, beside a gap and where the reference is not known."""
    change = np.full(reference_dps.shape, np.nan)
    if len(t_us) < 3:
        return change
    span_s = (t_us[2:] - t_us[:-2]) * 1e-6
    with np.errstate(invalid="ignore", divide="ignore"):
        slope = (reference_dps[2:] - reference_dps[:-2]) / span_s[:, None]
    change[1:-1] = np.where((span_s < 1.5 * np.median(span_s))[:, None], slope, np.nan)
    return change


def delay_products(miss_dps: np.ndarray, change_dps2: np.ndarray) -> np.ndarray:
    """(n, 2) from which a delay is estimated: the error (n, 3) about its mean with the rate's
    change a second (n, 3), and that squared."""
    miss = miss_dps - (miss_dps.mean(axis=0) if len(miss_dps) else 0.0)
    return np.column_stack([(miss * change_dps2).sum(axis=1), (change_dps2**2).sum(axis=1)])
