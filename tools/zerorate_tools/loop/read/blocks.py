"""From ticks to the blocks that the loop fits; channels in coarse steps become smooth courses."""

from itertools import pairwise

import numpy as np
from scipy.stats import norm

from .earth import earth_of
from .sessions import OWN_SOURCES, Session, block_means
from .still import runs, still_ticks
from .ticks import Ticks, gap_filled

#: Of a step, from a whole one: a mean further off is of samples that waver between two steps.
_WHOLE = 0.03
#: Ticks that a step lasts on average where it is a staircase at all.
_LONG = 2
#: Ticks for which no mean of samples that waver between two steps stays the same.
_STANDS = 10
#: Deviations of the samples' own noise that are tried, in steps; more of it averages the steps out.
_NOISES = (0.02, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3)
#: By how much the course must be less rough than what was read.
_SMOOTHER = 0.95
_ROUGH_TICKS = 20


def dequantise(raw_lsb: np.ndarray) -> np.ndarray:
    """(m,) means of an integer channel -> its likely course, or the means themselves where it does
    not stand on steps, or where no course is smoother.
    """
    level = np.round(raw_lsb)
    changes = int((np.diff(level) != 0).sum())
    if not 1 <= changes <= len(level) / _LONG:
        return raw_lsb
    courses = [_course(raw_lsb, noise) for noise in _NOISES]
    rough = [_roughness(c) for c in courses]
    best = int(np.argmin(rough))
    return courses[best] if rough[best] < _SMOOTHER * _roughness(raw_lsb) else raw_lsb


def step_lsb(raw_lsb: np.ndarray) -> float:
    """The step of (m,) means of an integer channel: the least between two levels, one after the
    other, on which it stands for long; 0 where it does not do so.
    """
    whole = np.abs(raw_lsb - np.round(raw_lsb)) <= _WHOLE
    stays = [(a, b) for a, b in _stays(raw_lsb, whole) if b - a >= _STANDS]
    near = [(a, c) for (a, b), (c, _) in pairwise(stays) if c - b <= _STANDS]
    steps = [abs(round(raw_lsb[c]) - round(raw_lsb[a])) for a, c in near]
    return float(min((s for s in steps if s), default=0))


def _roughness(course: np.ndarray) -> float:
    """RMS second difference of its means over a block."""
    blocks = len(course) // _ROUGH_TICKS
    means = course[: blocks * _ROUGH_TICKS].reshape(blocks, _ROUGH_TICKS).mean(axis=1)
    return float(np.sqrt((np.diff(means, 2) ** 2).mean())) if blocks > 2 else np.inf


def _course(raw: np.ndarray, noise: float) -> np.ndarray:
    """Straight between what is known: ticks that waver tell how far from the change of step they
    are, whole ones only that a step changed beside them.
    """
    whole = np.abs(raw - np.round(raw)) <= _WHOLE
    low = np.floor(raw)
    told = np.clip(low + 0.5 + noise * norm.ppf(raw - low), low, low + 1.0)
    told[whole] = np.round(raw[whole])
    stays = _stays(raw, whole)
    usual = float(np.median([last - first for first, last in stays] or [1])) / 2
    nodes = [(float(at), told[at]) for at in np.flatnonzero(~whole)]
    for first, last in stays:
        nodes += _stay(told, whole, first, last, usual)
    at, value = np.transpose(sorted(nodes))
    return np.interp(np.arange(len(raw)), at, value)


def _stays(raw: np.ndarray, whole: np.ndarray) -> list[tuple[int, int]]:
    """(first, one past last) of every run of whole ticks on one step."""
    key = np.where(whole, np.round(raw), np.nan)
    starts = np.flatnonzero(np.r_[True, key[1:] != key[:-1]])
    ends = np.r_[starts[1:], len(raw)]
    return [(int(a), int(b)) for a, b in zip(starts, ends) if whole[a]]


def _stay(
    told: np.ndarray, whole: np.ndarray, first: int, last: int, usual: float
) -> list[tuple[float, float]]:
    """Nodes (place, value) of a stay on one step: where it is entered, and, where it is entered and
    left on one side or at an end of the recording, its middle. usual: ticks from an edge to the
    middle; told: (m,) the step of whole ticks, the value of others.
    """
    here = told[first]
    enter, leave = (
        (told[at] + here) / 2 if whole[at] else told[at]
        for at in (max(first - 1, 0), min(last, len(told) - 1))
    )
    entered = [(first - 0.5, enter)] if first > 0 and whole[first - 1] else []
    if first == 0 or last == len(told):
        middle = min(usual, last - first - 1.0)
        return [*entered, (last - 1 - middle if first == 0 else first + middle, here)]
    turns = (enter - here) * (leave - here) >= 0
    return [*entered, *([((first + last - 1) / 2, here)] if turns else [])]


BLOCK_S = 20.0
_WANTED_BLOCKS = 150
_MOST_BLOCKS = 1500
_MOST_WITH_GAPS = 250
_LEAST_STILL = 0.25
_BRIDGE, BRIDGED_SHARE = 5, 0.1


def block_seconds(ticks: list[Ticks]) -> float:
    """Length of a block, a whole number of ticks, the same for all sessions.

    20 s; shorter where the longest session would have fewer than 150 of them, longer where it would
    have more than 1500. One recording alone, which is cut into parts with gaps, gets at most 250.
    """
    longest = max(len(t.count) * t.tick_s for t in ticks)
    most = _MOST_BLOCKS if len(ticks) > 1 else _MOST_WITH_GAPS
    return _whole_ticks(ticks, max(min(BLOCK_S, longest / _WANTED_BLOCKS), longest / most))


def sessions_from(ticks: list[Ticks]) -> list[Session]:
    """Sessions of equal blocks; at most 250 where one has long gaps, which cost their cube."""
    sessions = [session_of(t, block_seconds(ticks)) for t in ticks]
    if all(can_be_bridged(s.available) for s in sessions):
        return sessions
    longest = max(s.blocks * s.block_s for s in sessions)
    block_s = _whole_ticks(ticks, max(sessions[0].block_s, longest / _MOST_WITH_GAPS))
    return [session_of(t, block_s) for t in ticks]


def can_be_bridged(available: np.ndarray) -> bool:
    """Whether the blocks missing are few and apart."""
    longest = np.diff(runs(~available)).max(initial=0)
    missing = int((~available).sum())
    return bool(longest <= _BRIDGE and missing <= BRIDGED_SHARE * len(available))


def _whole_ticks(ticks: list[Ticks], want_s: float) -> float:
    tick_s = max(t.tick_s for t in ticks)
    return tick_s * max(1, int(np.ceil(want_s / tick_s - 1e-9)))


def session_of(ticks: Ticks, block_s: float) -> Session:
    """Block means of the rate's still part, tick means of the rest, times counted from the first
    sample.
    """
    per = round(block_s / ticks.tick_s)
    blocks = len(ticks.count) // per
    m = blocks * per
    every_still = still_ticks(ticks)
    still = every_still[:m]
    earth = earth_of(ticks)
    rate_at_rest = rate = ticks.rate[:m] - earth.rate_dps[:m]
    used = still
    if ticks.reference is not None:
        used = (ticks.count[:m] > 0) & np.isfinite(ticks.reference[:m]).all(axis=1)
        rate = rate - np.where(used[:, None], ticks.reference[:m], 0.0)
    weight = np.where(used, ticks.count[:m], 0.0)
    mean = block_means(rate, weight, blocks)
    share = used.reshape(blocks, per).mean(axis=1)
    mean[share < _LEAST_STILL] = np.nan
    return Session(
        ticks.name, per * ticks.tick_s, per, mean, np.where(share < _LEAST_STILL, 0.0, share),
        sources_of(ticks, m), ticks.start_us, earth=earth, delay=ticks.delay,
        ticks_dps=np.where(still[:, None], rate_at_rest, np.nan),
        welch=ticks.segments.at_rest(every_still, ticks.scales.odr_hz),
        tick_weight=weight, temp_step_degc=_temp_step_degc(ticks),
    )  # fmt: skip


def _temperature(ticks: Ticks) -> np.ndarray:
    return ticks.scales.temp_degc(0) + dequantise(_temp_lsb(ticks)) / ticks.scales.temp_lsb_per_degc


def _temp_step_degc(ticks: Ticks) -> float:
    lsb_per_degc = ticks.scales.temp_lsb_per_degc
    if ticks.temp is None or not lsb_per_degc:
        return 0.0
    return step_lsb(_temp_lsb(ticks)) / lsb_per_degc


def _temp_lsb(ticks: Ticks) -> np.ndarray:
    return (ticks.temp - ticks.scales.temp_degc(0)) * ticks.scales.temp_lsb_per_degc


def sources_of(ticks: Ticks, m: int) -> dict[str, np.ndarray]:
    """The first m ticks of every source by the names that effect slots know."""
    out = {}
    if ticks.temp is not None:
        out["temp"] = _temperature(ticks)[:m]
    if ticks.accel is not None and ticks.vib is not None:
        out.update({f"acc_{a}": ticks.accel[:m, i] for i, a in enumerate("xyz")})
        out["vib"] = ticks.vib[:m]
    if ticks.reference is not None:
        out.update({f"rate_{a}": of for a, of in zip("xyz", gap_filled(ticks.reference[:m]).T)})
    out.update({n: v[:m] for n, v in ticks.extra.items() if n not in OWN_SOURCES})
    return out
