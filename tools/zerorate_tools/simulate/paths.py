"""Paths over time: ramps, holds, exponentials and cycles, one after the other."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

_SECONDS = {"s": 1.0, "minutes": 60.0, "hours": 3600.0}


def seconds(table: Mapping[str, Any]) -> float | None:
    """The duration that a table gives as s, minutes or hours (their sum), or None."""
    given = [float(table[key]) * factor for key, factor in _SECONDS.items() if key in table]
    return sum(given) if given else None


def durations(start: float, segments: Sequence[Mapping[str, Any]]) -> list[float]:
    """Seconds of each segment; a ramp may give `degc_per_min` instead."""
    lengths, value = [], start
    for segment in segments:
        length = seconds(segment)
        if length is None:
            length = abs(segment["to"] - value) / abs(segment["degc_per_min"]) * 60
        lengths.append(length)
        value = float(segment.get("to", value))
    return lengths


def path(
    t_s: np.ndarray, start: float, segments: Sequence[Mapping[str, Any]], lengths: Sequence[float]
) -> np.ndarray:
    """(n,) values at t_s; after the last segment the last value holds.

    Segment: `to` alone is a ramp; `to` with tau_s an exponential that arrives there at its end;
    `cycle` with period_minutes a sine of that amplitude about the value reached; neither a hold.
    """
    out, value, begin = np.full(len(t_s), float(start)), float(start), 0.0
    for segment, length in zip(segments, lengths):
        here = t_s >= begin
        u = np.minimum(t_s[here] - begin, length)
        out[here] = _segment(u, value, segment, length)
        value = float(_segment(np.array([length]), value, segment, length)[0])
        begin += length
    return out


def _segment(u: np.ndarray, value: float, segment: Mapping[str, Any], length: float) -> np.ndarray:
    if "cycle" in segment:
        return value + segment["cycle"] * np.sin(2 * np.pi * u / (segment["period_minutes"] * 60))
    if "tau_s" in segment:
        tau_s = segment["tau_s"]
        return value + (segment["to"] - value) * np.expm1(-u / tau_s) / np.expm1(-length / tau_s)
    return value + (segment.get("to", value) - value) * u / length
