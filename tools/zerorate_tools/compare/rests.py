"""The rests of a recording: where it lay still the gyroscope's mean is its bias."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..loop.read.still import runs, still_ticks
from ..loop.read.stretch import ticks_with_spread
from ..peers import Given

_LEAST_TICKS = 3
#: A long rest counts as several: a device that never moves is compared, too.
_MOST_S = 60.0


@dataclass(frozen=True)
class Rest:
    """Samples [first, last) at rest, from start_s on. bias_dps: their mean (3,), sigma_dps: its
    standard error (3,); down: unit vector of gravity, None without an accelerometer.
    """

    first: int
    last: int
    start_s: float
    bias_dps: NDArray[np.float64]
    sigma_dps: NDArray[np.float64]
    down: NDArray[np.float64] | None


def rests_of(path: Path, one: Given) -> list[Rest]:
    """Every rest of three ticks and more, those of over a minute in pieces. Raises BadRecording."""
    ticks = ticks_with_spread(path)
    still = still_ticks(ticks, edges=False) & (ticks.count > 0)
    t_us = one.recording.columns["t_us"]
    found = []
    for start, end in runs(still):
        pieces = max(1, round((end - start) * ticks.tick_s / _MOST_S))
        cuts = np.linspace(start, end, pieces + 1).astype(int)
        for first, last in zip(cuts[:-1], cuts[1:]):
            if last - first >= _LEAST_TICKS:
                at = ticks.start_us + np.array([first, last]) * ticks.tick_s * 1e6
                found.append(_rest(one, ticks.rate[first:last], *np.searchsorted(t_us, at)))
    return found


def _rest(one: Given, means: NDArray[np.float64], first: int, last: int) -> Rest:
    bias = one.rate_dps[first:last].mean(axis=0)
    sigma = np.nanstd(means, axis=0, ddof=1) / np.sqrt(len(means))
    down = None
    if one.accel_g is not None:
        down = one.accel_g[first:last].mean(axis=0)
        down = down / (np.linalg.norm(down) or 1.0)
    t_us = one.recording.columns["t_us"]
    return Rest(first, last, float(t_us[first] - t_us[0]) / 1e6, bias, sigma, down)
