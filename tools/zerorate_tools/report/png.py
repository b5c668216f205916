"""The plots as pictures, for a README or a notebook."""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..recordings.atomic import written_beside
from .colours import ROLES
from .plot import Line, Panel, Plot, Series

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_DPI = 120
_WIDTH_IN = 9.0
_SYMBOLS = {
    "circle": "o",
    "square": "s",
    "triangle-up": "^",
    "triangle-down": "v",
    "star": "*",
    "line-ns": "|",
}
_DASHES = {"solid": "-", "dash": "--", "dot": ":"}


def write_pngs(plots: Sequence[Plot], folder: str | PathLike[str]) -> list[Path]:
    """Write each plot as KEY.png, on light ground, every view of it; returns the paths."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    paths = []
    for plot in plots:
        paths.append(folder / f"{plot.key}.png")
        with written_beside(paths[-1]) as temporary:
            picture(plot).savefig(temporary, dpi=_DPI, format="png")
    return paths


def picture(plot: Plot) -> Figure:
    """A Matplotlib figure of the plot, views one under another; a notebook shows it as it is."""
    from matplotlib.figure import Figure

    views = plot.views or ("",)
    grid = (len(plot.panels), 1) if plot.stacked else (len(views), len(plot.panels))
    high = 0.9 + (1.5 * grid[0] if plot.stacked and grid[0] > 1 else 2.9 * grid[0])
    figure = Figure(figsize=(_WIDTH_IN, high), layout="constrained")
    axes = figure.subplots(*grid, squeeze=False, sharex="col" if plot.stacked else False)
    for at, one in np.ndenumerate(axes):
        panel, view = (at[0], views[0]) if plot.stacked else (at[1], views[at[0]])
        _panel(one, plot, panel, view)
    if plot.stacked:
        axes[-1, 0].set_xlabel(_text(plot.panels[-1].x_label))
    figure.suptitle(_text(plot.title), x=0.01, ha="left", fontsize=12)
    _legend(figure, axes)
    return figure


def _panel(axes: Axes, plot: Plot, number: int, view: str) -> None:
    panel = plot.panels[number]
    for series in plot.series:
        if series.panel == number and (not series.views or view in series.views):
            _draw(axes, series)
    for line in panel.lines:
        _across(axes, line)
    _dress(axes, panel, view)
    if not plot.stacked:
        axes.set_xlabel(_text(panel.x_label), fontsize=9)


def _draw(axes: Axes, series: Series) -> None:
    colour = ROLES[series.role][0]
    if series.mark == "bars":
        width = np.asarray(series.width)
        axes.bar(series.x, series.y, width, color=colour, label=_text(series.name))
        return
    style: dict[str, Any] = {"color": colour, "label": _text(series.name), "linewidth": 1.3}
    style["linestyle"] = _DASHES[series.dash] if series.mark in ("line", "both") else "none"
    if series.mark in ("points", "both"):
        style |= {"marker": _SYMBOLS[series.symbol], "markersize": 0.7 * series.size}
    axes.plot(series.x, series.y, **style)


def _across(axes: Axes, line: Line) -> None:
    draw = axes.axhline if line.axis == "y" else axes.axvline
    colour = ROLES[line.role][0]
    draw(line.value, color=colour, linestyle=_DASHES[line.dash], linewidth=0.9, zorder=0.5)


def _dress(axes: Axes, panel: Panel, view: str) -> None:
    title = ", ".join(part for part in (panel.title, view) if part)
    axes.set_title(_text(title), loc="left", fontsize=9)
    axes.tick_params(labelsize=8)
    axes.set_axisbelow(True)
    axes.grid(color="0.9", linewidth=0.6)
    axes.spines[["top", "right"]].set_visible(False)
    if panel.log:
        axes.set(xscale="log", yscale="log")
    if panel.x_range:
        axes.set_xlim(*panel.x_range)
    if panel.y_range:
        axes.set_ylim(*panel.y_range)
    if panel.y_names:
        axes.set_yticks([-i for i in range(len(panel.y_names))], panel.y_names)


def _legend(figure: Figure, axes: Any) -> None:
    handles: dict[str, Any] = {}
    for one in axes.flat:
        for handle, name in zip(*one.get_legend_handles_labels()):
            handles[name] = handle
    place: dict[str, Any] = {
        "loc": "outside upper right",
        "ncols": 5,
        "frameon": False,
        "fontsize": 8,
    }
    figure.legend(list(handles.values()), list(handles), **place)


def _text(text: str) -> str:
    """Text as it is: Matplotlib takes a dollar for the beginning of a formula."""
    return text.replace("$", r"\$")
