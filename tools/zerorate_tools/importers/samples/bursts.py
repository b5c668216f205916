"""Time stamps of the arrival: samples that a bus or a host handed over several at a time."""

from collections.abc import Iterator

import numpy as np

from ...recordings.recording import GYRO
from .clock import GAP_LEAST_US
from .spool import TIME, Spool

#: Of all steps: beyond that so many are shorter than half the usual one that stamps come in bursts.
_SHORT = 0.2
#: Of what the stamps leave of the rates beside a pause, what even steps leave: of noise as much.
_CLEARLY = 0.5


def arrive_in_bursts(columns: dict[str, np.ndarray], interval_us: float) -> bool:
    """Whether samples were taken evenly, though their stamps come in bursts. A logger that really
    paused has the same stamps: the rates beside a pause tell, as they go on from their neighbours
    in the order of the samples or in the time of the stamps.

    columns: some samples in order; interval_us: the usual one.
    """
    steps = np.diff(columns[TIME])
    whole = columns[TIME][-1:] - columns[TIME][:1] > 2.0 * GAP_LEAST_US
    if not whole.all() or np.mean(steps < 0.5 * interval_us) <= _SHORT:
        return False
    before, after = steps[:-1], steps[1:]
    at_pause = np.maximum(before, after) > 2.0 * interval_us
    rates = np.array([columns[name] for name in GYRO])
    by_stamps = after / np.maximum(before + after, 1e-9)
    even = np.full_like(by_stamps, 0.5)
    return _misfit(rates, even, at_pause) < _CLEARLY * _misfit(rates, by_stamps, at_pause)


def _misfit(rates: np.ndarray, weight: np.ndarray, take: np.ndarray) -> float:
    """Squares of rates (3, n) less the line through their neighbours, in units of white noise."""
    left = rates[:, 1:-1] - (weight * rates[:, :-2] + (1 - weight) * rates[:, 2:])
    return float(np.nansum((left**2 / (1 + weight**2 + (1 - weight) ** 2))[:, take]))


def evened(spool: Spool, interval_us: float) -> Iterator[dict[str, np.ndarray]]:
    """Yield the same pieces, each sample at the time when an even clock would have handed it over.

    A stamp is late, never early, and within a second a sample comes on time: those that do set
    the clock, and the others lie evenly between. Where samples are lost it stays later for good.
    """
    around = max(1, round(GAP_LEAST_US / interval_us))
    behind = np.full(around, -np.inf)
    place = 0
    for number in range(len(spool.pieces)):
        columns = spool.read(number)
        rows = len(columns[TIME])
        late = columns[TIME] - np.arange(place, place + rows) * interval_us
        ahead = _next_late(spool, number, place + rows, interval_us, around)
        padded = np.concatenate([behind, late, ahead])
        clock = np.maximum(_least(padded, around, -1), _least(padded, around, 1))
        on_time = np.flatnonzero((padded <= clock) & np.isfinite(padded))
        lateness = late - np.interp(np.arange(around, around + rows), on_time, padded[on_time])
        yield {**columns, TIME: columns[TIME] - lateness}
        behind = padded[rows : rows + around]
        place += rows


def _next_late(spool, number, place, interval_us, around) -> np.ndarray:
    """By how much the next samples are later than an even clock says; inf beyond the end."""
    if number + 1 == len(spool.pieces):
        return np.full(around, np.inf)
    t_us = spool.read(number + 1)[TIME][:around]
    late = t_us - np.arange(place, place + len(t_us)) * interval_us
    return np.pad(late, (0, around - len(late)), constant_values=np.inf)


def _least(values: np.ndarray, around: int, side: int) -> np.ndarray:
    """The least of each value and the next `around` of them (side 1), or those before it (-1)."""
    from scipy.ndimage import minimum_filter1d  # which the child that reads a log does without

    size = around + 1
    return minimum_filter1d(values, size, origin=-(size // 2) if side > 0 else around // 2)
