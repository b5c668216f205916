"""A slow channel in coarse steps, as a course that crosses from step to step when they change.

Steps are an error in the regressor: fits that look at quick changes make its slope too small, and
what is then left of a warm-up looks like an effect of its own, the same at each power-on.
"""

from __future__ import annotations

import numpy as np

#: Of a step, from a whole one: a mean further off is of samples that already waver between steps.
_WHOLE = 0.02
#: Ticks that a step lasts on average where it is a staircase at all.
_LONG = 5


def unstepped(raw_lsb: np.ndarray) -> np.ndarray:
    """(m,) means of an integer channel -> its likely course, where it stands on steps for most of
    the time; where noise makes it waver all the time, the means are as good as they get.
    """
    level = np.round(raw_lsb)
    if (np.abs(raw_lsb - level) > _WHOLE).mean() > 0.5:
        return raw_lsb
    first = np.r_[0, np.flatnonzero(np.diff(level)) + 1]
    if not 2 <= len(first) <= len(level) / _LONG:
        return raw_lsb
    return np.interp(np.arange(len(level)), *_nodes(first, level[first], len(level)))


def _nodes(first, level, size):
    """Places and values between which the course is straight: half-way where a step changes, and
    what lies between two changes on the same side.
    """
    length = np.diff(np.r_[first, size])
    at, value = [], []
    for j, here in enumerate(level):
        before = level[j - 1] if j else None
        after = level[j + 1] if j + 1 < len(level) else None
        if before is not None:
            at.append(first[j] - 0.5)
            value.append((before + here) / 2)
        if before is None or after is None or (before - here) * (here - after) < 0:
            enter = None if before is None else (length[j - 1] / 2, (before - here) / 2)
            leave = None if after is None else (length[j + 1] / 2, (after - here) / 2)
            more = _turning_back(length[j], enter, leave)
            at += [first[j] - 0.5 + x for x, _ in more]
            value += [here + v for _, v in more]
    return at, value


def _turning_back(length, enter, leave):
    """Of a stay on one step, entered and left on one side: how far it goes to the step's middle, by
    how long the neighbouring steps lasted. enter, leave: (ticks to the middle, value at the change)
    or None at an end. Returns (place, value) beside the start and the middle of the step.
    """
    rise, fall = (0.0 if side is None else side[0] for side in (enter, leave))
    edge = (enter or leave)[1]
    if rise + fall <= length:
        return [(rise, 0.0), (length - fall, 0.0)]
    reached = length / (rise + fall)
    return [(length * rise / (rise + fall), edge * (1.0 - reached))]
