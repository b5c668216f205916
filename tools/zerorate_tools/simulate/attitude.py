"""Attitude as unit quaternions (w x y z), body to world, world z up."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

_STRIDE = 16
IDENTITY = np.array([1.0, 0.0, 0.0, 0.0])


def multiply(p: np.ndarray, q: np.ndarray) -> np.ndarray:
    """(..., 4) Hamilton product."""
    pw, px, py, pz = np.moveaxis(p, -1, 0)
    qw, qx, qy, qz = np.moveaxis(q, -1, 0)
    return np.stack(
        [
            pw * qw - px * qx - py * qy - pz * qz,
            pw * qx + px * qw + py * qz - pz * qy,
            pw * qy - px * qz + py * qw + pz * qx,
            pw * qz + px * qy - py * qx + pz * qw,
        ],
        axis=-1,
    )


def rotation(vector_deg: np.ndarray) -> np.ndarray:
    """(..., 4) rotation about each (..., 3) vector by its length in degrees."""
    half = np.radians(vector_deg) / 2
    angle = np.linalg.norm(half, axis=-1, keepdims=True)
    return np.concatenate([np.cos(angle), half * np.sinc(angle / np.pi)], axis=-1)


def integrate(rate_dps: np.ndarray, dt_s: float, start: np.ndarray) -> np.ndarray:
    """(n, 4) attitude after each sample; its rate (n, 3) is the mean over the dt before it."""
    return multiply(start, _running_product(rotation(rate_dps * dt_s)))


def _running_product(q: np.ndarray) -> np.ndarray:
    # blocks side by side, then their ends by the same rule: NumPy speed for a sequential product
    n = len(q)
    if n <= 1:
        return q
    blocks = -(-n // _STRIDE)
    padded = np.tile(IDENTITY, (blocks * _STRIDE, 1))
    padded[:n] = q
    padded = padded.reshape(blocks, _STRIDE, 4)
    for at in range(1, _STRIDE):
        padded[:, at] = multiply(padded[:, at - 1], padded[:, at])
    if blocks > 1:
        ends = _running_product(padded[:, -1].copy())
        padded[1:] = multiply(ends[:-1, None], padded[1:])
    out = padded.reshape(-1, 4)[:n]
    return out / np.linalg.norm(out, axis=-1, keepdims=True)


def into_body(attitude: np.ndarray, vector: np.ndarray) -> np.ndarray:
    """(n, 3) world vector(s) (3,) or (n, 3) as seen from the body."""
    w, r = attitude[..., :1], attitude[..., 1:]
    vector = np.broadcast_to(vector, r.shape)
    t = -2 * np.cross(r, vector)
    return vector + w * t - np.cross(r, t)


def facing(up: np.ndarray) -> np.ndarray:
    """(4,) an attitude in which the body direction `up` points up."""
    up = np.asarray(up, float) / np.linalg.norm(up)
    if up[2] < -1 + 1e-12:
        return np.array([0.0, 1.0, 0.0, 0.0])
    q = np.r_[1 + up[2], np.cross(up, [0.0, 0.0, 1.0])]
    return q / np.linalg.norm(q)


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
