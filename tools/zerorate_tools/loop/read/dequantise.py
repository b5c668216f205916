"""A slow channel in coarse steps, as a course that crosses from step to step when they change.

Steps are an error in the regressor: fits that look at quick changes make its slope too small, or
take a rate of change for it, and what is then left of a warm-up looks like an effect of its own,
the same at each power-on.
"""

from itertools import pairwise

import numpy as np
from scipy.stats import norm

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


def _roughness(course):
    """RMS second difference of its means over a block."""
    blocks = len(course) // _ROUGH_TICKS
    means = course[: blocks * _ROUGH_TICKS].reshape(blocks, _ROUGH_TICKS).mean(axis=1)
    return float(np.sqrt((np.diff(means, 2) ** 2).mean())) if blocks > 2 else np.inf


def _course(raw, noise):
    """Straight between what is known: ticks that waver tell how far from the change of step they
    are, whole ones only that a step changed beside them.
    """
    whole = np.abs(raw - np.round(raw)) <= _WHOLE
    low = np.floor(raw)
    share = np.clip(raw - low, _WHOLE, 1.0 - _WHOLE)
    told = np.clip(low + 0.5 + noise * norm.ppf(share), low, low + 1.0)
    at, value = [], []
    stays = _stays(raw, whole)
    usual = float(np.median([last - first for first, last in stays] or [1])) / 2
    for first, last in stays:
        nodes = _stay(raw, told, whole, first, last, usual)
        at += [x for x, _ in nodes]
        value += [v for _, v in nodes]
    at = np.r_[np.flatnonzero(~whole), at]
    value = np.r_[told[~whole], value]
    order = np.argsort(at, kind="stable")
    return np.interp(np.arange(len(raw)), at[order], value[order])


def _stays(raw, whole):
    """(first, one past last) of every run of whole ticks on one step."""
    key = np.where(whole, np.round(raw), np.nan)
    starts = np.flatnonzero(np.r_[True, key[1:] != key[:-1]])
    ends = np.r_[starts[1:], len(raw)]
    return [(int(a), int(b)) for a, b in zip(starts, ends) if whole[a]]


def _stay(raw, told, whole, first, last, usual):
    """Nodes (place, value) of a stay on one step: where it is entered and left, and, where that is
    on one side or at an end of the recording, its middle. usual: ticks from an edge to the middle.
    """
    here, nodes = round(raw[first]), []
    enter = _side(raw, told, whole, first - 1, here)
    leave = _side(raw, told, whole, last, here)
    if enter is not None and whole[first - 1]:
        nodes.append((first - 0.5, enter))
    if leave is not None and enter is not None and (enter - here) * (leave - here) < 0:
        return nodes
    length = last - first
    if enter is not None and leave is not None:
        return [*nodes, (first + length / 2 - 0.5, float(here))]
    middle = min(usual, length - 1.0)
    return [*nodes, (first + middle if enter is not None else last - 1 - middle, float(here))]


def _side(raw, told, whole, beside, here):
    """The value where a stay meets the tick beside it, or None at an end of the recording."""
    if not 0 <= beside < len(raw):
        return None
    return (round(raw[beside]) + here) / 2 if whole[beside] else told[beside]
