"""The fleet's pictures: the part's curve, its devices, and what the prior is worth."""

from pathlib import Path
from typing import Any

import numpy as np

from ..numbers import counted, figure, unit_of_page
from ..recordings.atomic import written_beside
from ..report.page import rendered
from ..report.plot import Panel, Plot, Series
from .fleet_in_words import scenario_in_words
from .part import Part, scale_of
from .population import TERMS, UNITS
from .prior import WAYS

_POINTS = 40
_MOST_LINES = 15
_MOST_DEVICES = 400
_VIEWS = ("less each one's level", "as they are")
_AXES = "xyz"
_ROLES = {"without": "before", "prior": "after"}


def plots_of(report: dict[str, Any], part: Part | None) -> list[Plot]:
    plots = []
    if part is not None and not np.isnan(part.low_degc):
        plots.append(part_curve(part))
    if part is not None:
        plots.append(each_device(part))
    if report["prior"] and report["prior"]["benefit"]:
        plots.append(first_minutes(report["prior"]["benefit"]))
    return plots


def part_curve(part: Part) -> Plot:
    degc = np.linspace(part.low_degc, part.high_degc, _POINTS)
    mean, deviation = part.at(degc)
    basis = np.vander((degc - part.reference_degc) * scale_of(1), 3, True)
    series = []
    for axis in range(3):
        own = part.axes[axis].own[:_MOST_LINES]
        shape = basis[:, 1:] @ part.axes[axis].mean[1:]
        spread = part.axes[axis].spread[1:, 1:]
        about = np.sqrt(np.einsum("ni,ij,nj->n", basis[:, 1:], spread, basis[:, 1:]))
        for view, curves, middle, reach in (
            (_VIEWS[0], basis[:, 1:] @ own[:, 1:].T, shape, about),
            (_VIEWS[1], basis @ own.T, mean[:, axis], deviation[:, axis]),
        ):
            at: dict[str, Any] = {"panel": axis, "views": (view,)}
            x, y = _broken(degc, curves)
            series.append(Series(x=x, y=y, name="devices", role="context", size=1, **at))
            series.append(Series(x=degc, y=middle, name="the part", role="after", **at))
            x, y = _broken(degc, np.stack([middle - reach, middle + reach], axis=1))
            name = "one deviation between devices"
            series.append(Series(x=x, y=y, name=name, role="heating", dash="dash", **at))
    return Plot(
        key="part-curve",
        title="Bias over temperature",
        caption=f"Up to {_MOST_LINES} devices are drawn, each shrunken towards the part.",
        description="For each axis the mean curve of the part over temperature, the deviation "
        "between devices about it, and single devices.",
        panels=tuple(Panel(f"{a} axis, dps", "°C", "dps") for a in _AXES),
        series=tuple(series),
        views=_VIEWS,
    )


def _broken(x: np.ndarray, columns: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Lines, one a column, as one that a NaN breaks."""
    gap = np.full((1, columns.shape[1]), np.nan)
    return np.tile(np.append(x, np.nan), columns.shape[1]), np.vstack([columns, gap]).T.ravel()


def each_device(part: Part) -> Plot:
    """Every device's own level, slope and curvature, sorted, those unlike the others marked."""
    panels, series = [], []
    shown = [t for t in TERMS if any(t in c.shown for c in part.curves)]
    for number, name in enumerate(shown):
        term = TERMS.index(name)
        unit = unit_of_page(UNITS[term])
        panels.append(Panel(f"{name}, {unit}", "devices, sorted", unit))
        for axis in range(3):
            series += _sorted(part, axis, term, number)
    return Plot(
        key="each-device",
        title="Device by device",
        caption="Bars are 95 % intervals of each device's own, shrunken towards the part.",
        description="Level, slope and curvature of every device in rising order, with intervals.",
        panels=tuple(panels),
        series=tuple(series),
        views=tuple(f"{a} axis" for a in _AXES),
    )


def _sorted(part: Part, axis: int, term: int, panel: int) -> list[Series]:
    population = part.axes[axis]
    order = np.argsort(population.own[:, term])
    order = order[np.linspace(0, len(order) - 1, min(len(order), _MOST_DEVICES)).astype(int)]
    own = population.own[order, term] * scale_of(term)
    error = 1.96 * np.sqrt(population.own_covariance[order, term, term]) * scale_of(term)
    rank = np.arange(len(order), dtype=float)
    unusual = population.p_unusual[order, term] < 0.05
    names = [part.names[i] for i in order]
    at: dict[str, Any] = {"panel": panel, "views": (f"{_AXES[axis]} axis",)}
    bars = np.stack([own - error, own + error, np.full(len(own), np.nan)], axis=1).ravel()
    out = [Series(x=np.repeat(rank, 3), y=bars, name="95 % interval", role="context", **at)]
    for which, name, role in ((~unusual, "a device", "after"), (unusual, "unlike others", "event")):
        if which.any():
            at |= {"mark": "points", "size": 5.0, "words": [n for n, of in zip(names, which) if of]}
            out.append(Series(x=rank[which], y=own[which], name=name, role=role, **at))
    return out


def first_minutes(tried: dict[str, Any]) -> Plot:
    """A panel a scenario: median error of each way to start, and where 95 % of devices are."""
    panels, series = [], []
    for number, (scenario, found) in enumerate(tried["scenarios"].items()):
        most = 1.05 * max(found[way]["p95_mdps"] for way in WAYS)
        title = scenario_in_words(scenario)
        panels.append(Panel(title, "mdps", "", x_range=(0.0, most), y_names=("", "")))
        for row, way in enumerate(WAYS):
            median, p95 = found[way]["median_mdps"], found[way]["p95_mdps"]
            y = -float(row)
            look: dict[str, Any] = {"panel": number, "name": WAYS[way], "role": _ROLES[way]}
            series.append(Series(x=np.array([median, p95]), y=np.array([y, y]), **look))
            look |= {"mark": "points", "size": 12.0}
            series.append(Series(x=np.array([median]), y=np.array([y]), **look))
    return Plot(
        key="first-minutes",
        title=f"A new device's first {tried['minutes']:g} minutes",
        caption="Points are medians over devices left out of the prior; the lines end where "
        "95 % of them lie below.",
        description="For three ways to begin, the error without and with the prior.",
        panels=tuple(panels),
        series=tuple(series),
    )


def write_page(report: dict[str, Any], part: Part | None, path: Path) -> None:
    """Write the page of a fleet's report (what fleet.json holds). Raises OSError."""
    said = {"headline": headline(report), "ways": WAYS, "scenario": scenario_in_words}
    text = rendered("fleet.html.j2", plots_of(report, part), __package__, r=report, **said)
    with written_beside(path) as temporary:
        temporary.write_text(text, encoding="utf-8", errors="backslashreplace")


def headline(report: dict[str, Any]) -> str:
    tried = (report["prior"] or {}).get("benefit") or {"scenarios": {}}
    found = tried["scenarios"].get("at-rest-for-10-s")
    if not found:
        return f"{counted(report['devices'], 'device')}, {counted(report['sessions'], 'power-on')}"
    before, after = (figure(found[way]["median_mdps"]) for way in ("without", "prior"))
    return (
        f"A device that starts from {report['devices_of_the_part']} others is off by {after} "
        f"instead of {before} mdps in its first {tried['minutes']:g} minutes"
    )
