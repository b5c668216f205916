"""The longest still stretch of a recording, and its Allan deviation."""

from __future__ import annotations

from os import PathLike

import numpy as np

from ..allan import overlapping
from .gate import CannotClose
from .still import still_ticks
from .ticks import read_ticks

_LEAST_TICKS = 30


def deviation_of(path: str | PathLike[str]) -> tuple[np.ndarray, np.ndarray]:
    """Cluster times (k,) in s from one tick up, and Allan deviation (k, 3) in dps, at rest.

    Of the longest still stretch, overlapping (IEEE Std 952-1997, annex C). Raises BadRecording, and
    CannotClose where less than thirty ticks of 0.1 s in a row are still.
    """
    ticks = read_ticks(path, tick_s=0.1)
    first, last = longest_run(still_ticks(ticks) & (ticks.count > 0))
    if last - first < _LEAST_TICKS:
        seconds = _LEAST_TICKS * ticks.tick_s
        raise CannotClose(f"{ticks.name}: never still for {seconds:.0f} s; leave it at rest longer")
    return overlapping(ticks.rate[first:last], ticks.tick_s)


def longest_run(mask: np.ndarray) -> tuple[int, int]:
    """First and one past the last index of the longest run of True; (0, 0) without any."""
    edges = np.flatnonzero(np.diff(np.r_[0, mask.astype(int), 0]))
    if not len(edges):
        return 0, 0
    starts, ends = edges[::2], edges[1::2]
    at = int((ends - starts).argmax())
    return int(starts[at]), int(ends[at])
