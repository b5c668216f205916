"""The longest still stretch of a recording, and its Allan deviation."""

from os import PathLike

import numpy as np

from ...allan import overlapping
from .gate import CannotClose
from .still import runs, still_ticks
from .ticks import TICK_S, Ticks, gap_filled, read_ticks, tick_seconds

_LEAST_TICKS = 30
_SAMPLES = 50
#: The shortest averages, s, and the share of them without a sample that is bridged.
_FINE_S = 0.1
_MOST_EMPTY = 0.02


def deviation_of(path: str | PathLike[str]) -> tuple[np.ndarray, np.ndarray]:
    """Cluster times (k,) in s from one tick up, and Allan deviation (k, 3) in dps, at rest.

    Of the longest still stretch, overlapping (IEEE Std 952-1997, annex C). Raises BadRecording, and
    CannotClose where less than thirty ticks of 0.1 s in a row are still.
    """
    return overlapping(*still_stretch(path))


def still_stretch(path: str | PathLike[str]) -> tuple[np.ndarray, float]:
    """(n, 3) dps, means of the longest still stretch, and of how many s each is: 0.1 where the
    recording has samples for it. Raises BadRecording, CannotClose.

    What is still is judged over fifty samples: fewer spread by chance, and a recording of hours
    would fall to pieces. Below 4 Hz one sample is a tick, which has no spread.
    """
    own_s = tick_seconds(path, 0.0)
    ticks = ticks_with_spread(path)
    first, last = longest_run(still_ticks(ticks) & (ticks.count > 0))
    per = max(1, int(ticks.tick_s / max(_FINE_S, own_s) + 1e-6))
    fine = read_ticks(path, ticks.tick_s / per)
    rate = fine.rate[first * per : last * per]
    empty = ~np.isfinite(rate).all(axis=1)
    if not len(rate) or empty.mean() > _MOST_EMPTY:
        rate, fine = ticks.rate[first:last], ticks
    if len(rate) < _LEAST_TICKS:
        seconds = _LEAST_TICKS * fine.tick_s
        raise CannotClose(f"{ticks.name}: never still for {seconds:.0f} s; leave it at rest longer")
    return np.column_stack([gap_filled(rate[:, a]) for a in range(3)]), fine.tick_s


def ticks_with_spread(path: str | PathLike[str]) -> Ticks:
    """Ticks of at least fifty samples, by whose spread rest is told. Raises BadRecording."""
    own_s = tick_seconds(path, 0.0)
    return read_ticks(path, max(TICK_S, _SAMPLES * own_s) if own_s < 0.25 else TICK_S)


def longest_run(mask: np.ndarray) -> tuple[int, int]:
    """First and one past the last index of the longest run of True; (0, 0) without any."""
    first, last = max(runs(mask), key=lambda run: run[1] - run[0], default=(0, 0))
    return int(first), int(last)
