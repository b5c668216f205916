"""Each found effect as a curve of its own, with the data that it was found in."""

from dataclasses import replace
from typing import Any

import numpy as np

from ..loop.read.sessions import Session, block_basis
from ..loop.verify.analysis import Analysis
from ..model.term import Term
from .plot import ZERO, Numbers, Plot, Series, panels_of_axes, thinned
from .residual_plots import TRENDS, minutes, trained_residuals, trend
from .sentences import quantity

_MOST_DOTS = 600
#: Terms drawn as one curve, each with its (3,) mdps; a session with its residual (n, 3) mdps.
Group = list[tuple[Term, Numbers]]
Judged = tuple[Session, Numbers]


def effect_plots(analysis: Analysis, names: list[str]) -> list[Plot]:
    """One plot for each effect found, in the order found; names: what to call them."""
    sessions = _sessions(analysis)
    rows = analysis.coefficients[len(analysis.selection.straight) :]
    out, at = [], 0
    for number, (found, name) in enumerate(zip(analysis.selection.found, names), 1):
        terms = found.candidate.terms
        own = rows[at : at + len(terms)]
        at += len(terms)
        out.append(_plot(number, name, list(terms), 1e3 * own, sessions))
    return out


def _sessions(analysis: Analysis) -> list[Judged]:
    """(session, residual (n, 3) mdps under the whole model), training first, the holdout last.

    Each is less its own mean: what an offset is, is no news of an effect.
    """
    after = zip(analysis.holdout, analysis.judgement.residual_after)
    every = [*trained_residuals(analysis), *((s, 1e3 * r) for s, r in after)]
    return [(s, r - np.nanmean(r, axis=0)) for s, r in every]


def _plot(
    number: int, name: str, terms: list[Term], coefficients_mdps: Numbers, sessions: list[Judged]
) -> Plot:
    groups = _groups(terms, coefficients_mdps, sessions[0][0])
    views = tuple(groups) if len(groups) > 1 else ()
    series = [
        s
        for label, group in groups.items()
        for s in _series(group, sessions, (label,) if views else ())
    ]
    label = "value of what it follows" if views else next(iter(groups))
    return Plot(
        key=f"effect-{number}",
        title=f"{name}: the curve and its data",
        caption="The line is the correction that is deployed. The points are what is measured with "
        "every other part of the model and the offset of each power-on taken off: they should lie "
        "about the line.",
        description=f"For each axis the correction for {name} as a line over {label}, and the "
        "measured points about it; triangles pointing up are heating, down cooling.",
        panels=panels_of_axes(label, lines=(ZERO,)),
        series=tuple(series),
        views=views,
    )


def _groups(terms: list[Term], coefficients_mdps: Numbers, session: Session) -> dict[str, Group]:
    """Label of the abscissa -> the terms drawn over it, as one curve, each with its (3,) mdps."""
    out: dict[str, Group] = {}
    for term, coefficients in zip(terms, coefficients_mdps):
        out.setdefault(abscissa(term, session)[1], []).append((term, coefficients))
    return out


def _series(group: Group, sessions: list[Judged], views: tuple[str, ...]) -> list[Series]:
    out = []
    for a in range(3):
        cloud = [_points(group, a, s, left[:, a]) for s, left in sessions]
        for code, name, symbol in TRENDS:
            x = np.concatenate([x[t == code] for x, _, t in cloud])
            y = np.concatenate([y[t == code] for _, y, t in cloud])
            stride = max(1, len(x) // _MOST_DOTS)
            look: dict[str, Any] = {"symbol": symbol, "size": 4.0, "views": views}
            out.append(Series(a, x[::stride], y[::stride], name, name, "points", **look))
        x, y = _curve(group, a, [s for s, _ in sessions])
        out.append(Series(a, x, y, "correction", "model", views=views))
    return out


def _correction(group: Group, axis: int, session: Session) -> Numbers:
    """(n,) mdps by block."""
    each = [coefficients[axis] * block_basis(term, session) for term, coefficients in group]
    return np.sum(each, axis=0)


def _points(
    group: Group, axis: int, session: Session, left: Numbers
) -> tuple[Numbers, Numbers, Numbers]:
    """Abscissa, measured mdps and trend of the blocks with a rate."""
    there = np.isfinite(left)
    x = abscissa(group[0][0], session)[0]
    y = _correction(group, axis, session) + left
    return x[there], y[there], trend(session)[there]


def _curve(group: Group, axis: int, sessions: list[Session]) -> tuple[Numbers, Numbers]:
    """Over the sorted abscissa; a loop, which hysteresis is, in the order of time."""
    term = group[0][0]
    is_loop = any(t.memory in ("backlash", "play") for t, _ in group)
    some = sessions[-1:] if is_loop else sessions
    x = np.concatenate([abscissa(term, s)[0] for s in some])
    y = np.concatenate([_correction(group, axis, s) for s in some])
    if is_loop:
        return thinned(x, y)
    order = np.argsort(x, kind="stable")
    return thinned(x[order], y[order])


def abscissa(term: Term, session: Session) -> tuple[Numbers, str]:
    """(n,) what the effect is best drawn over, by block, and its label."""
    name, unit = quantity(term.source)
    if term.decay_s or term.source == "time":
        return minutes(session), "minutes since power-on"
    if term.second is not None:
        other = quantity(term.second)[0]
        return block_basis(term, session), f"{name} times {other}, from their means"
    if term.memory in ("backlash", "play"):
        return session.block_mean(session.source(term.source)), _label(name, unit)
    if term.power_first and term.power > 1:
        return block_basis(replace(term, knot=None), session), f"lagged square of {name}"
    bare = replace(term, knot=None, power=1, table=None)
    value = block_basis(bare, session)
    if term.lag_mode == "rate":
        return 60.0 * value, f"rate of {_label(name, f'{unit} per minute')}"
    if term.lag_mode == "difference":
        return value, f"{name} less its lagged self, {unit}"
    if term.memory == "peak":
        return value, f"highest {name} so far less {_label(name, unit)}"
    value = value + term.centre
    if term.lag_mode == "lag":
        return value, f"lagged {_label(name, unit)}"
    return value, f"delayed {_label(name, unit)}" if term.delay_s else _label(name, unit)


def _label(name: str, unit: str) -> str:
    return f"{name}, {unit}" if unit else name
