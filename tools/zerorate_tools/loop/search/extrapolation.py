"""How far beyond what the fitted sessions show a term may follow its source before it is held.

The next session goes a little further in temperature or supply than those before it. Held at the
very edge, a large effect is then wrong by what it still changes; followed too far, by what the fit
does not know. So a term is followed as far as its error there stays within the noise of a block,
judged with a further power of the source in the fit: what is not known of the curve's shape counts.
That takes several power-ons. What one alone shows is held at the edge; its curve over temperature
goes on straight.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

import numpy as np

from ...model.term import Term
from .catalogue import OF_MOTION, is_bounded

#: At most this share of the range seen, on either side, and in how many steps it is looked for.
MOST, _STEPS = 0.25, 10
#: RMS error beyond the edge, over that of a block's white noise.
_WITHIN = 1.0


def follow_further(regression, straight, found) -> None:
    """Move out the limits of every effect found (`select.Found`), in place."""
    moved = iter(followed(regression, straight, [t for f in found for t in f.candidate.terms]))
    for f in found:
        f.candidate = replace(f.candidate, terms=tuple(next(moved) for _ in f.candidate.terms))


def followed(regression, straight, terms: list[Term]) -> list[Term]:
    """The terms with the limits at which they are held moved out as far as the fit is to be
    trusted.

    straight: the terms fitted beside them.
    """
    out = list(terms)
    for name in dict.fromkeys(n for t in terms for n in (t.source, t.second) if n):
        at = [i for i, t in enumerate(terms) if name in (t.source, t.second) and _may_follow(t)]
        if not at:
            continue
        error = _Error(regression, straight, terms, at, name)
        limits = _limits(terms[at[0]], name)
        for side in (0, 1):
            share = _share(error, limits, side)
            for i in at:
                out[i] = _moved(out[i], terms[i], name, side, share)
    return out


def _may_follow(term: Term) -> bool:
    """Time since power-on, and what motion carries far out, are known no further than they were
    seen; a bounded basis has its margin; a table ends where it ends.
    """
    fast = {term.source, term.second} & OF_MOTION
    known = term.source not in ("one", "time") and not term.table
    return known and not fast and not is_bounded(vars(term))


def _limits(term: Term, name: str) -> tuple[float, float]:
    return (term.lo, term.hi) if term.source == name else (term.second_lo, term.second_hi)


def _share(error: _Error, limits: tuple[float, float], side: int) -> float:
    """Share of the range by which the limit at this side may be passed."""
    span = limits[1] - limits[0]
    shares = np.linspace(0.0, MOST, _STEPS + 1)[1:]
    beyond = [limits[side] + (2 * side - 1) * s * span for s in shares]
    known = [error.at(limits[side], b) <= _WITHIN for b in beyond]
    return float(shares[: _STEPS if all(known) else known.index(False)].max(initial=0.0))


def _moved(term: Term, as_fitted: Term, name: str, side: int, share: float) -> Term:
    lo, hi = _limits(as_fitted, name)
    limit = (lo - share * (hi - lo), hi + share * (hi - lo))[side]
    fields: dict[str, Any] = {
        ("" if term.source == name else "second_") + ("lo", "hi")[side]: limit
    }
    return replace(term, **fields)


class _Error:
    """Standard error of what some terms of one source change beyond an edge of its range."""

    def __init__(self, regression, straight, terms: list[Term], at: Iterable[int], name: str):
        own = [terms[i] for i in at]
        further = _further(own, name)
        self.name, self.terms = name, [*own, further]
        self.beside = {t: _beside(t, name, regression.sessions) for t in self.terms}
        every = [*straight, *terms, further]
        self.places = [len(straight) + i for i in at] + [len(every) - 1]
        with regression.in_sensor_axes():
            # (3, J, J), over the variance of a block's white noise
            self.covariance = regression.fit(every).base.unscaled

    def at(self, edge: float, beyond: float) -> float:
        """RMS over the axes, over the white noise of a block."""
        change = np.array([_change(t, self.name, edge, beyond) for t in self.terms])
        change = change * [self.beside[t] for t in self.terms]
        part = self.covariance[:, self.places][:, :, self.places]
        return float(np.sqrt(np.einsum("i,aij,j->a", change, part, change).mean()))


def _further(own: list[Term], name: str) -> Term:
    """One power of the source more than any of the terms has."""
    top = max(own, key=lambda t: t.power if t.source == name else 0)
    if top.source == name:
        return replace(top, power=top.power + 1)
    return Term(
        name,
        *(top.second_lo, top.second_hi, top.second_centre),
        power=2,
        second=top.source,
        second_lo=top.lo,
        second_hi=top.hi,
        second_centre=top.centre,
    )


def _change(term: Term, name: str, edge: float, beyond: float) -> float:
    """By how much the factor of a source at rest changes from the edge to a value beyond."""
    if term.source != name:
        return beyond - edge
    u = np.array([edge, beyond]) - term.centre
    before, after = (u if term.knot is None else np.maximum(u - term.knot, 0.0)) ** term.power
    return float(after - before)


def _beside(term: Term, name: str, sessions) -> float:
    """RMS over the sessions of what a product multiplies the source with; 1 where there is none."""
    if term.second is None:
        return 1.0
    own = term.source if term.source != name else term.second
    centre, power = (term.centre, term.power) if term.source != name else (term.second_centre, 1)
    factor = np.concatenate([s.source(own) for s in sessions]) - centre
    return float(np.sqrt((factor ** (2 * power)).mean()))
