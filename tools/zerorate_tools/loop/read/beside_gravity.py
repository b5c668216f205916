"""Turns between two rests beside gravity: the gyroscope must carry the one direction to the other.

The direction of gravity before a turn, carried through it by the integrated rate, is compared with
the direction after it (as Tedaldi, Pretto and Menegatti calibrate without a turntable, ICRA 2014,
section III). The rate's bias is that of the rests on either side; the accelerometer's own offsets
and scales are nuisances, since a low-cost one is off by as much as the gyroscope's scale.
"""

from dataclasses import dataclass
from os import PathLike

import numpy as np

from ...recordings import open_recording
from ...recordings.recording import GYRO, TIME
from ...simulate.attitude import integrate, into_body
from .reference import Run
from .still import runs

_REST_S, _LONGEST_S, _LEAST_DEG = 3.0, 60.0, 20.0
_MOST = 400
_TO_RAD = np.pi / 180
_DIFFERENCES = np.array([[1.0, 0.0], [0.0, 1.0], [-1.0, -1.0]])


@dataclass(frozen=True)
class Between:
    """A turn to be read: from_s to to_s, gravity (3,) in g and bias (3,) dps about it."""

    from_s: float
    to_s: float
    up_before: np.ndarray
    up_after: np.ndarray
    bias_dps: np.ndarray


def turns_between_rests(ticks, still: np.ndarray) -> list[Between]:
    """Turns of at most a minute with three seconds of rest on either side."""
    if ticks.accel is None:
        return []
    least = max(2, round(_REST_S / ticks.tick_s))
    rests = [(a, b) for a, b in runs(still) if b - a >= least]
    out = []
    for (first, end), (start, last) in zip(rests[:-1], rests[1:]):
        if (start - end + 2) * ticks.tick_s > _LONGEST_S or (ticks.count[end:start] == 0).any():
            continue
        # the ticks next to the turn may hold a part of it
        before = slice(max(first, end - 10), end - 1)
        after = slice(start + 1, min(last, start + 10))
        before_g, after_g = (np.nanmean(ticks.accel[at], axis=0) for at in (before, after))
        bias = 0.5 * sum(np.nanmean(ticks.rate[at], axis=0) for at in (before, after))
        from_s, to_s = (end - 1) * ticks.tick_s, (start + 1) * ticks.tick_s
        turn = Between(from_s, to_s, before_g, after_g, bias)
        if _angle_deg(before_g, after_g) > _LEAST_DEG:
            out.append(turn)
    return out[:_MOST]


def _angle_deg(one, other):
    length = np.linalg.norm(one) * np.linalg.norm(other)
    if not length > 0:  # an accelerometer that gives nothing
        return 0.0
    cosine = one @ other / length
    return np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0)))


def runs_of(path: str | PathLike[str], ticks, turns: list[Between]) -> list[Run]:
    """Runs of a recording, read once more for the samples of its turns."""
    if not turns:
        return []
    opened = open_recording(path, keep_gaps=True)
    at_s, rate = _samples(opened, ticks.start_us, turns)
    out = []
    for turn in turns:
        inside = (at_s >= turn.from_s) & (at_s < turn.to_s)
        run = _run(at_s[inside], rate[inside] / opened.scales.gyro_lsb_per_dps, turn)
        if run is not None:
            out.append(run)
    return out


def _samples(opened, start_us, turns):
    """Times (n,) s and raw rates (n, 3) within any of the turns."""
    starts, ends = np.array([t.from_s for t in turns]), np.array([t.to_s for t in turns])
    times, rates = [], []
    for batch in opened.batches(rows=1 << 18):
        at_s = (batch[TIME] - start_us) * 1e-6
        near = np.searchsorted(starts, at_s, side="right") - 1
        inside = (near >= 0) & (at_s < ends[np.maximum(near, 0)])
        times.append(at_s[inside])
        rates.append(np.column_stack([batch[n][inside] for n in GYRO]))
    return np.concatenate(times), np.vstack(rates).astype(float)


def _run(at_s, rate_dps, turn: Between) -> Run | None:
    if len(at_s) < 8 or np.diff(at_s).max() > 0.25 * (turn.to_s - turn.from_s):
        return None
    # the mean, as stamps may come in bursts
    dt_s = float(at_s[-1] - at_s[0]) / (len(at_s) - 1)
    rate = rate_dps - turn.bias_dps
    attitude = integrate(rate, dt_s, np.array([1.0, 0.0, 0.0, 0.0]))
    ends = [np.column_stack([into_body(attitude, e) for e in np.eye(3)])]
    # (n, 3, 3): from the start's axes into each sample's
    to_body = ends[0].reshape(len(rate), 3, 3).transpose(0, 2, 1)
    end = to_body[-1]
    carry = end[None] @ to_body.transpose(0, 2, 1)
    added = np.einsum("nai,nj->aij", carry, rate * dt_s).reshape(3, 9) * _TO_RAD
    carried = end @ turn.up_before
    offsets = np.eye(3) - end
    # a scale common to the axes does not show in a direction: two differences are free
    scales = (np.diag(turn.up_after) - end @ np.diag(turn.up_before)) @ _DIFFERENCES
    design = np.hstack([-_cross(carried) @ added, offsets, scales])
    error = turn.up_after - carried
    fastest = np.abs(rate).max(axis=0)
    return Run(design.T @ design, design.T @ error, float(error @ error), 3.0, fastest)


def _cross(v):
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])
