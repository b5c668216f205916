"""Which ticks were still, judged without assuming a small bias."""

import numpy as np
from scipy.ndimage import binary_dilation, median_filter, uniform_filter1d
from scipy.stats import chi2

from ...allan import overlapping
from .gate import CannotClose
from .ticks import TICK_S, AnyPath, Ticks, gap_filled, read_ticks, tick_seconds

_SPREAD = 2.0  # times the quiet spread
_OFF_DPS = 1.0  # from the running middle of quiet ticks
#: Normal deviations beyond which a mean is no noise, and the chance of a spread that is none.
_OFF_SIGMAS, _SPREAD_CHANCE = 5.0, 1e-5
#: No gyroscope at rest has more noise than this in a sample.
_MOST_NOISE_DPS = 5.0
#: Of a normal deviate's size: its 0.2 quantile.
_QUIET_SIZE = 0.2533
#: Of the still ticks' own noise, beyond which a tick beside a motion belongs to it, for so long.
_EDGE_SIGMAS, _EDGE_S = 4.0, 30.0
_QUIET_SHARE = 0.2
_WINDOW_S = 900.0
_SLOPE_LAG_S = 120.0
#: Normal deviations in a median of absolute ones.
_MAD = 1.4826
_LEAST_TICKS = 30
_SAMPLES = 50
#: The shortest averages, s, and the share of them without a sample that is bridged.
_FINE_S = 0.1
_MOST_EMPTY = 0.02


def still_ticks(ticks: Ticks, edges: bool = True) -> np.ndarray:
    """(m,) bool. Quiet: the rate's spread within a tick is near that of the quietest ticks. Still:
    its mean, less a line over temperature, is also near the running middle of quiet ticks, so a
    steady turn does not count; a turn below 1 dps is told by the accelerometer alone, if its axis
    is not vertical. Where a tick's own noise is of that size, as with few samples a tick, the means
    of several are asked. Where a motion sets in or dies down slowly, all of it is motion; edges
    False asks no such thing, for who compares rests among which the bias wandered.
    """
    there = ticks.count > 0
    if not there.any():
        return there
    quiet = there & _is_quiet(ticks, there)
    rate = _less_temperature(ticks, quiet)
    middle = _running_middle(rate, quiet, max(3, int(_WINDOW_S / ticks.tick_s) | 1))
    still = quiet & _is_near(rate - middle, there, quiet)
    if ticks.accel is not None:
        still &= _gravity_holds(ticks, there)
    return still & ~_edges(rate, middle, still, there, ticks.tick_s) if edges else still


def runs(mask: np.ndarray) -> np.ndarray:
    """(k, 2) first and one past the last index of each run of True."""
    return np.flatnonzero(np.diff(np.r_[0, mask.astype(int), 0])).reshape(-1, 2)


def _is_near(off: np.ndarray, there: np.ndarray, quiet: np.ndarray) -> np.ndarray:
    """(m,) bool: no mean, and no mean of so many that their noise is small, is far off."""
    near = np.ones(len(off), bool)
    for values in off.T:
        steps = np.abs(np.diff(values))[quiet[1:] & quiet[:-1]]  # a motion's are no noise
        noise = np.quantile(steps, _QUIET_SHARE) / (np.sqrt(2) * _QUIET_SIZE) if len(steps) else 0.0
        least = _OFF_SIGMAS * noise
        near &= np.abs(values) < max(_OFF_DPS, least)
        if least > _OFF_DPS:
            width = int(np.ceil((least / _OFF_DPS) ** 2)) | 1
            far = np.abs(uniform_filter1d(np.where(there, values, 0.0), width)) >= _OFF_DPS
            near &= ~binary_dilation(far, iterations=width // 2)
    return near


def _less_temperature(ticks: Ticks, quiet: np.ndarray) -> np.ndarray:
    """(m, 3) rate less a line over temperature: a fast ramp of a steep part is no motion.

    The slope is the median of what quiet ticks two minutes apart show, weighed by how much the
    temperature moved, so that neither a turn nor its ends count.
    """
    lag, at = max(1, round(_SLOPE_LAG_S / ticks.tick_s)), np.flatnonzero(quiet)
    if ticks.temp is None or len(at) <= lag:
        return ticks.rate
    warmed = ticks.temp[at[lag:]] - ticks.temp[at[:-lag]]
    moved = warmed != 0
    if not moved.any():
        return ticks.rate
    slopes = (ticks.rate[at[lag:]] - ticks.rate[at[:-lag]])[moved] / warmed[moved, None]
    slope = [_weighted_median(slopes[:, a], np.abs(warmed[moved])) for a in range(3)]
    return ticks.rate - np.outer(ticks.temp - ticks.temp[at[0]], slope)


def _weighted_median(values: np.ndarray, weights: np.ndarray) -> float:
    order = np.argsort(values)
    total = np.cumsum(weights[order])
    return values[order[np.searchsorted(total, 0.5 * total[-1])]]


def _edges(
    rate: np.ndarray, middle: np.ndarray, still: np.ndarray, there: np.ndarray, tick_s: float
) -> np.ndarray:
    """(m,) bool: ticks that lead without a break into motion and are off the still ones around them
    by more than noise; no motion takes longer to die down than a lag of the bias does, and what
    stays where a knock put it is a step of the bias. Near the recording's ends, where still ones
    lie on one side alone, off the running middle."""
    if still.sum() < 3:
        return np.zeros(len(still), bool)
    longest = int(np.ceil(_EDGE_S / tick_s))
    first, *_, last = np.flatnonzero(still)
    inside = slice(first + longest, max(last - longest, 0))
    around = _running_middle(rate, still, 2 * longest + 1)
    off = np.abs(rate - middle)
    off[inside] = np.abs(rate - around)[inside]
    usual = _EDGE_SIGMAS * _MAD * np.median(off[still], axis=0)
    moving = there & ~still
    beside = moving | (there & (off > usual).any(axis=1))
    return binary_dilation(moving, mask=beside, iterations=longest)


def _is_quiet(ticks: Ticks, there: np.ndarray) -> np.ndarray:
    """(m,) bool: the spread is at most twice that of the quietest fifth, or what so few samples as
    a tick has may show of the same noise."""
    if np.median(ticks.count[there]) < 4:
        return there
    freedom = np.maximum(ticks.count - 1, 1)
    usual = float(np.median(freedom[there]))
    # as the quietest fifth of spreads of so few samples lies, and as far as they may
    low = np.sqrt(chi2.ppf(_QUIET_SHARE, usual) / usual)
    most = np.maximum(_SPREAD, np.sqrt(chi2.isf(_SPREAD_CHANCE, freedom) / freedom) / low)
    spread = np.sqrt(ticks.rate_var * (1 + 1 / freedom)[:, None])
    quiet = np.quantile(spread[there], _QUIET_SHARE, axis=0)
    least = most[:, None] * quiet + 1.0 / ticks.scales.gyro_lsb_per_dps
    moving = ~(spread <= np.minimum(least, _MOST_NOISE_DPS)).all(axis=1)
    return ~binary_dilation(moving)


def _running_middle(rate: np.ndarray, quiet: np.ndarray, window: int) -> np.ndarray:
    """(m, 3) median of quiet ticks around each; the whole recording's where there are none."""
    every, at = np.arange(len(rate)), np.flatnonzero(quiet)
    if len(at) < 3:
        return np.broadcast_to(np.nanmedian(rate, axis=0), rate.shape)
    window = min(window, len(at) | 1)
    middles = [np.interp(every, at, median_filter(values, window)) for values in rate[at].T]
    return np.column_stack(middles)


def _gravity_holds(ticks: Ticks, there: np.ndarray) -> np.ndarray:
    """(m,) bool: the direction of gravity does not turn by more than its own noise allows over ten
    ticks; near the recording's ends, from there inwards.
    """
    lag = max(1, int(10.0 / ticks.tick_s))
    if len(there) <= 2 * lag:
        return np.ones(len(there), bool)
    smooth = median_filter(ticks.accel, (5, 1), mode="nearest")
    at = np.arange(len(there))
    before, after = np.maximum(at - lag, 0), np.minimum(at + lag, at[-1])
    turned = np.linalg.norm(smooth[after] - smooth[before], axis=1)
    return turned < max(8.0 * np.median(turned[lag:-lag]), 0.03)


def deviation_of(path: AnyPath) -> tuple[np.ndarray, np.ndarray]:
    """Cluster times (k,) in s from one tick up, and Allan deviation (k, 3) in dps, at rest.

    Of the longest still stretch, overlapping (IEEE Std 952-1997, annex C). Raises BadRecording, and
    CannotClose where less than thirty ticks of 0.1 s in a row are still.
    """
    return overlapping(*still_stretch(path))


def still_stretch(path: AnyPath) -> tuple[np.ndarray, float]:
    """(n, 3) dps, means of the longest still stretch, and of how many s each is: 0.1 where the
    recording has samples for it. Raises BadRecording, CannotClose.

    What is still is judged over fifty samples: fewer spread by chance, and a recording of hours
    would fall to pieces. Below 4 Hz one sample is a tick, which has no spread.
    """
    own_s = tick_seconds(path, 0.0)
    ticks = ticks_with_spread(path)
    first, last = max(runs(still_ticks(ticks)), key=np.ptp, default=(0, 0))
    per = max(1, int(ticks.tick_s / max(_FINE_S, own_s) + 1e-6))
    fine = read_ticks(path, ticks.tick_s / per)
    rate = fine.rate[first * per : last * per]
    empty = ~np.isfinite(rate).all(axis=1)
    if not len(rate) or empty.mean() > _MOST_EMPTY:
        rate, fine = ticks.rate[first:last], ticks
    if len(rate) < _LEAST_TICKS:
        seconds = _LEAST_TICKS * fine.tick_s
        raise CannotClose(f"{ticks.name}: never still for {seconds:.0f} s; leave it at rest longer")
    return gap_filled(rate), fine.tick_s


def ticks_with_spread(path: AnyPath) -> Ticks:
    """Ticks of at least fifty samples, by whose spread rest is told. Raises BadRecording."""
    own_s = tick_seconds(path, 0.0)
    return read_ticks(path, max(TICK_S, _SAMPLES * own_s) if own_s < 0.25 else TICK_S)
