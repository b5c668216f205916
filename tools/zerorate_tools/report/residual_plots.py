"""The error of the held-out part: against time, and against temperature by heating and cooling."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..allan import Noise, overlapping
from ..loop.fit.regression import noise_of, predicted
from ..loop.read.sessions import Session
from ..loop.verify.analysis import Analysis
from .plot import ZERO, Line, Numbers, Panel, Plot, Series, panels_of_axes, thinned

_LEAST = 9
#: Letters of an axis' label for which a phone has room.
_LONGEST_LABEL = 48
TRENDS = ((1, "heating", "triangle-up"), (-1, "cooling", "triangle-down"), (0, "held", "circle"))
_ROWS = ("all axes", "x axis", "y axis", "z axis")
_APART = 0.14
_MDPS = 1e3
#: Blocks on either side from which a temperature's trend is taken, and from one to the other.
_BESIDE, _ACROSS = 2, 4
_HELD_DEGC_PER_MIN = 0.06


def against_time(parts: list[HeldOut], events: list[dict[str, Any]]) -> Plot:
    """Before and after by axis, the temperature below, steps as lines across."""
    series, warm = [], any(p.temp_degc is not None for p in parts)
    for part, start in zip(parts, _starts(parts)):
        at = start + part.minutes
        for a in range(3):
            for name, error in (("before", part.before_mdps), ("after", part.after_mdps)):
                x, y = thinned(at, error[:, a])
                series.append(Series(a, x, y, name, name))
        if part.temp_degc is not None:
            x, y = thinned(at, part.temp_degc)
            series.append(Series(3, x, y, "temperature", "context"))
    label = f"minutes since the start of {', '.join(p.name for p in parts)}"
    brief = (
        label if len(label) <= _LONGEST_LABEL else "minutes since the start of what was held out"
    )
    lines = (ZERO, *_steps(parts, events))
    panels = [*panels_of_axes(label, lines=lines, x_narrow=brief)]
    if warm:
        panels.append(Panel("die temperature, °C", label, "°C", share=0.7, x_narrow=brief))
    return Plot(
        key="residual-time",
        title="Error against time",
        caption="Means of the stretches at rest, and of motion where a reference was given, as the "
        "board would have corrected them. The first minute sets the turn-on offset and is not "
        "scored; gaps are motion, or time that was not held out.",
        description="Lines of the held-out error over time for each axis, before and after"
        + (", with the die temperature below them." if warm else "."),
        panels=tuple(panels),
        series=tuple(series),
        stacked=True,
    )


def against_temperature(parts: list[HeldOut]) -> Plot | None:
    """Error over temperature, heating and cooling apart; None without a thermometer."""
    parts = [p for p in parts if p.temp_degc is not None]
    if not parts:
        return None
    series = []
    for view in ("after", "before"):
        for a in range(3):
            for code, name, symbol in TRENDS:
                x, y = _pooled(parts, view, a, code)
                look: dict[str, Any] = {"mark": "points", "symbol": symbol, "views": (view,)}
                series.append(Series(a, x, y, name, name, **look))
    most = 1.08 * max(np.nanmax(np.abs(s.y), initial=1e-3) for s in series)
    return Plot(
        key="residual-temperature",
        title="Error against temperature",
        caption="A gap between heating and cooling at the same temperature is what no curve over "
        "temperature can correct: hysteresis, a lag, or a rate. Both views have the same scale.",
        description="Points of the held-out error over die temperature for each axis; triangles "
        "pointing up are heating, down cooling, circles a held temperature.",
        panels=panels_of_axes("°C", lines=(ZERO,), y_range=(-most, most)),
        series=tuple(series),
        views=("after", "before"),
    )


def _pooled(parts: list[HeldOut], view: str, axis: int, code: int) -> tuple[Numbers, Numbers]:
    x, y = [], []
    for part in parts:
        assert part.temp_degc is not None, "others were left out"
        error = (part.after_mdps if view == "after" else part.before_mdps)[:, axis]
        there = (part.trend == code) & np.isfinite(error)
        x.append(part.temp_degc[there])
        y.append(error[there])
    return thinned(np.concatenate(x), np.concatenate(y))


def _starts(parts: list[HeldOut]) -> Numbers:
    """Minute at which each part begins when they are laid end to end."""
    lengths = [p.minutes[-1] + p.block_s / 120 for p in parts]
    return np.cumsum([0.0, *lengths[:-1]])


def _steps(parts: list[HeldOut], events: list[dict[str, Any]]) -> list[Line]:
    return [
        Line("x", start + (event["t_us"] - part.start_us) / 60e6, "event", "step")
        for part, start in zip(parts, _starts(parts))
        for event in events
        if event["recording"] == part.name
    ]


def at_a_glance(result: Mapping[str, Any]) -> Plot:
    """Every number in it is one of report.json."""
    series, rows = [], -np.arange(len(_ROWS), dtype=float)
    for name, shift in (("before", _APART), ("after", -_APART)):
        value, low, high = _figures(result, name)
        whiskers = np.column_stack([low, high, np.full(len(rows), np.nan)]).ravel()
        series.append(Series(0, whiskers, np.repeat(rows + shift, 3), name, name))
        series.append(Series(0, value, rows + shift, name, name, "points", size=11.0))
    floor = np.array([result["in_all"]["floor_mdps"], *result["floor_mdps"]])
    mark: dict[str, Any] = {"mark": "points", "symbol": "line-ns", "size": 16.0}
    series.append(Series(0, floor, rows, "floor", "floor", **mark))
    most = 1.05 * max(float(np.nanmax(s.x)) for s in series)
    return Plot(
        key="at-a-glance",
        title="At a glance",
        caption="Bars are 95 % intervals.",
        description="For all axes together and for each, the error before and after with its 95 % "
        "interval, and the floor; the table beside has the same numbers.",
        panels=(Panel("", "mdps", "", x_range=(0.0, most), y_names=_ROWS),),
        series=tuple(series),
        stacked=True,
    )


def _figures(result: Mapping[str, Any], name: str) -> tuple[Numbers, Numbers, Numbers]:
    """Value and limits, each (4,): all axes first."""
    whole = result["in_all"]
    limits = np.array([whole["ci95_mdps"][name], *result["ci95_mdps"][name]])
    value = np.array([whole[f"{name}_mdps"], *result[f"{name}_mdps"]])
    return value, limits[:, 0], limits[:, 1]


def deviations(parts: list[HeldOut], noise: list[Noise], floor_mdps: list[float]) -> Plot | None:
    """None where no stretch without a gap is long enough."""
    stretch = longest(parts)
    if stretch is None:
        return None
    block_s, before, after = stretch
    tau_s, of_before = overlapping(before, block_s)
    _, of_after = overlapping(after, block_s)
    series = []
    for a in range(3):
        series.append(Series(a, tau_s, of_before[:, a], "before", "before", "both"))
        series.append(Series(a, tau_s, of_after[:, a], "after", "after", "both"))
        expected = 1e3 * noise[a].deviation(tau_s)
        series.append(Series(a, tau_s, expected, "its noise alone", "floor", dash="dot"))
    panels = [
        replace(panel, lines=(Line("y", floor, "floor", "floor"),))
        for panel, floor in zip(panels_of_axes("averaging time, s", log=True), floor_mdps)
    ]
    return Plot(
        key="allan",
        title="Allan deviation",
        caption="How far two neighbouring averages differ, by how long is averaged. The dotted "
        "curve is what the part's own noise gives, which no model takes away; its lowest point "
        "within a session is the floor. Towards the right end few averages are left, and chance "
        "bends the curves.",
        description="Allan deviation of the held-out error for each axis on logarithmic scales: "
        "before, after, the part's noise alone, and the floor as a horizontal line.",
        panels=tuple(panels),
        series=tuple(series),
    )


def longest(parts: list[HeldOut]) -> tuple[float, Numbers, Numbers] | None:
    """block_s, before and after, each (n, 3), of the longest stretch without a gap, if enough."""
    best = None
    for part in parts:
        there = np.isfinite(np.hstack([part.before_mdps, part.after_mdps])).all(axis=1)
        for run in np.split(np.arange(len(there)), np.flatnonzero(np.diff(there)) + 1):
            if there[run[0]] and (best is None or len(run) > len(best[1])):
                best = (part.block_s, part.before_mdps[run], part.after_mdps[run])
    return best if best is not None and len(best[1]) >= _LEAST else None


@dataclass(frozen=True)
class HeldOut:
    """A held-out recording by blocks: minutes (n,), temp_degc (n,) or None, trend (n,) +1 heating,
    -1 cooling, 0 held; before_mdps, after_mdps (n, 3), NaN where nothing was scored.
    """

    name: str
    minutes: Numbers
    block_s: float
    temp_degc: Numbers | None
    trend: Numbers
    before_mdps: Numbers
    after_mdps: Numbers
    start_us: int


def held_out(analysis: Analysis) -> list[HeldOut]:
    """The recordings that were held out, with their error before and after."""
    judged = analysis.judgement
    return [
        HeldOut(
            name=session.name,
            minutes=minutes(session),
            block_s=session.block_s,
            temp_degc=temperature(session),
            trend=trend(session),
            before_mdps=_MDPS * before,
            after_mdps=_MDPS * after,
            start_us=session.start_us,
        )
        for session, before, after in zip(
            analysis.holdout, judged.residual_before, judged.residual_after
        )
    ]


def trained_residuals(analysis: Analysis) -> list[tuple[Session, Numbers]]:
    """(session, (n, 3) mdps left by the whole model) of what was fitted on."""
    terms = [*analysis.selection.straight, *analysis.selection.terms]
    out = []
    for session in analysis.train:
        left = session.rate_dps - predicted(terms, analysis.coefficients, session)
        left = np.where(session.available[:, None], left, np.nan)
        out.append((session, _MDPS * (left - np.nanmean(left, axis=0))))
    return out


def fitted_noise(analysis: Analysis) -> list[Noise]:
    """White noise, flicker and random walk of each axis, as the floor is taken from."""
    whole = [*analysis.selection.straight, *analysis.selection.terms]
    return noise_of(analysis.judgement.whole, whole)


def minutes(session: Session) -> Numbers:
    """(n,) middle of each block, minutes since the recording's start."""
    return (np.arange(session.blocks) + 0.5) * session.block_s / 60


def temperature(session: Session) -> Numbers | None:
    """(n,) degC by block, None without a thermometer."""
    ticks = session.sources.get("temp")
    return None if ticks is None else session.block_mean(ticks)


def trend(session: Session) -> Numbers:
    """(n,) int: 1 where the temperature rises, -1 where it falls, 0 where it is held."""
    temp = temperature(session)
    if temp is None:
        return np.zeros(session.blocks, int)
    padded = np.pad(temp, _BESIDE, mode="edge")
    per_min = (padded[_ACROSS:] - padded[:-_ACROSS]) / (_ACROSS * session.block_s / 60)
    return np.where(np.abs(per_min) < _HELD_DEGC_PER_MIN, 0, np.sign(per_min)).astype(int)
