"""A Plot as the plain values that the page's script draws."""

from collections.abc import Iterable
from dataclasses import asdict
from html import escape
from typing import Any

import numpy as np

from .plot import Line, Panel, Plot, Series


def plain(plot: Plot) -> dict[str, Any]:
    """Everything that the script needs; names are escaped, for Plotly reads them as markup."""
    return {
        "key": plot.key,
        "stacked": plot.stacked,
        "views": list(plot.views),
        "panels": [_panel(p) for p in plot.panels],
        "series": [_series(s) for s in plot.series],
        "frames": [
            [label, {str(at): _values(s) for at, s in new.items()}] for label, new in plot.frames
        ],
    }


def markup(text: str) -> str:
    """Text as Plotly shows it letter by letter: no markup, no formula, no turning of the line."""
    return "\u2068" + escape(text, quote=False).replace("$", "&#36;") + "\u2069"


def _panel(panel: Panel) -> dict[str, Any]:
    return {
        **asdict(panel),
        "title": markup(panel.title),
        "x_label": markup(panel.x_label),
        "x_narrow": markup(panel.x_narrow or panel.x_label),
        "lines": [_line(line) for line in panel.lines],
    }


def _line(line: Line) -> dict[str, Any]:
    return {**asdict(line), "text": markup(line.text) if line.text else ""}


def _series(series: Series) -> dict[str, Any]:
    look = ("panel", "role", "mark", "symbol", "dash", "size")
    return {
        **{name: getattr(series, name) for name in look},
        "name": markup(series.name),
        "views": list(series.views),
        **_values(series),
    }


def _values(series: Series) -> dict[str, Any]:
    out: dict[str, Any] = {"x": _numbers(series.x), "y": _numbers(series.y)}
    if series.width is not None:
        out["width"] = _numbers(series.width)
    if series.words is not None:
        out["words"] = [markup(w) for w in series.words]
    return out


def _numbers(values: Iterable[float]) -> list[float | None]:
    """Five digits, which a screen cannot show; None where a line breaks."""
    return [float(f"{v:.5g}") if np.isfinite(v) else None for v in np.asarray(values, float)]
