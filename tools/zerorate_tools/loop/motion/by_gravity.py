"""What recordings in motion show of the nine entries, and whether it holds on windows held out."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import reduce

import numpy as np
from scipy.stats import chi2
from scipy.stats import f as fisher

from ..read.gate import CannotClose
from .matrix import FOLDS, Fitted, Shown, beside, distance, entries_of, fit, groups
from .rate_scale import LEVEL, RateScale
from .windows import MATRIX, Moving

BESIDE = "gravity while it moved"
UNIT = "degrees a minute of tilt"
#: Posterior sigma of an entry above which the motion did not show it: a data sheet's 0.5 %.
UNSEEN = 0.005


class DifferentDevices(CannotClose):
    """Recordings whose matrices differ by more than their scatter; groups: names of each."""

    def __init__(self, groups: Sequence[Sequence[str]]) -> None:
        names = " and ".join(f"({', '.join(sorted(g))})" for g in groups)
        super().__init__(
            f"these recordings do not have the same axes: {names} differ by more than recordings "
            "of one device do; close each group by itself"
        )
        self.groups = groups


@dataclass(frozen=True)
class Scatter:
    """A recording's statement, and how far statements of one matrix lie apart."""

    names: tuple[str, ...]
    shown: Shown
    apart: float


def by_gravity(train: list[Moving], holdout: list[Moving]) -> RateScale | None:
    """The matrix of the recordings to fit, judged on windows held out; None where none moves
    or too little to be judged on.

    holdout: recordings held out whole; without any, every fourth part of each is, in turn. Raises
    DifferentDevices.
    """
    matrix, fitted = fit(train)
    if not fitted:
        return None
    inflation = _one_device(fitted, matrix)
    shown = sum((f.shown(matrix) for f in fitted), Shown()).weaker(inflation)
    entries, covariance = entries_of(shown)
    held = [f for f in (beside(m, matrix) for m in holdout) if f is not None]
    judged = [(f, None, entries) for f in held] or list(_folds(fitted, matrix, inflation))
    if not judged:
        return None
    gain = sum(f.shown(matrix, ALL if k is None else [k]).gain(m) for f, k, m in judged)
    before, after = (
        _tilt([f.tilts(matrix, x, k) for f, k, m in judged for x in [0.0 * m if bare else m]])
        for bare in (True, False)
    )
    p = float(chi2.sf(shown.right @ np.linalg.pinv(shown.normal) @ shown.right, MATRIX))
    fastest = np.degrees(np.max([np.abs(f.moving.rate).max(axis=0) for f in fitted], axis=0))
    unseen = np.sqrt(np.diag(np.linalg.pinv(shown.normal + _FAINT))) > UNSEEN
    return RateScale(
        matrix=entries.reshape(3, 3),
        deviation=np.sqrt(np.diag(covariance)).reshape(3, 3),
        p_value=p,
        kind=_kind(entries, covariance),
        reference=BESIDE,
        gains=np.array([gain, before - after]),
        before=before,
        after=after,
        unit=UNIT,
        runs=sum(len(f.errors) for f in fitted),
        fastest_dps=fastest,
        unseen=unseen.reshape(3, 3),
    )


#: Keeps an inverse finite where nothing at all was seen: an entry of ten.
_FAINT = np.eye(MATRIX) * 1e-2
ALL = range(FOLDS)


def _folds(fitted, matrix, inflation):
    """Each recording's part held out, with the entries that all other parts show."""
    for k in ALL:
        others = [j for j in ALL if j != k]
        shown = sum((f.shown(matrix, others) for f in fitted), Shown()).weaker(inflation)
        entries, _ = entries_of(shown)
        for f in fitted:
            if (f.folds == k).any() and np.isin(f.folds, others).any():
                yield f, k, entries


def _tilt(parts) -> float:
    every = np.concatenate(parts) if parts else np.zeros(0)
    return float(np.sqrt((every**2).mean())) if len(every) else float("nan")


def _one_device(fitted: list[Fitted], matrix) -> float:
    """By how much recordings scatter more than their errors allow. Raises DifferentDevices where
    two groups of them lie farther apart than each scatters (an F-test over recordings)."""
    every = [Scatter((f.moving.name,), f.shown(matrix), 0.0) for f in fitted]
    number = len(every)
    if number < 3:
        return 1.0
    whole = reduce(_joined, every).apart
    one, other = min(_splits(every), key=lambda two: two[0].apart + two[1].apart)
    parts, free = one.apart + other.apart, MATRIX * (number - 2)
    ratio = (whole - parts) / MATRIX / max(parts / free, 1.0)
    if fisher.sf(ratio, MATRIX, free) * 2.0 ** (number - 1) < LEVEL:
        raise DifferentDevices([one.names, other.names])
    return max(1.0, whole / (MATRIX * (number - 1)))


def _splits(every: list[Scatter]):
    """All ways to part up to ten recordings in two; of more, each against the others."""
    number = len(every)
    masks = range(1, 2 ** (number - 1)) if number <= 10 else [1 << k for k in range(number)]
    for mask in masks:
        sides = [[s for k, s in enumerate(every) if (mask >> k & 1) == side] for side in (0, 1)]
        yield reduce(_joined, sides[0]), reduce(_joined, sides[1])


def _joined(one: Scatter, other: Scatter) -> Scatter:
    apart = one.apart + other.apart + distance(one.shown, other.shown)
    return Scatter((*one.names, *other.names), one.shown + other.shown, apart)


def _kind(entries, covariance) -> str:
    """Which of the three it is, by what its own entries are worth; all that are clear."""
    said = []
    for name, onto in zip(("scale-factor", "cross-axis", "turned-axes"), groups()):
        size = onto @ entries
        spread = onto @ covariance @ onto.T
        free = round(float(np.trace(onto)))
        if chi2.sf(size @ np.linalg.pinv(spread, rcond=1e-6) @ size, free) < LEVEL:
            said.append(name)
    return "+".join(said) or "scale-factor+cross-axis"
