"""A plot before anything draws it: the page hands it to Plotly."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

Numbers = NDArray[Any]

#: Most points of a line: more cannot be told apart on a screen, and make the page slow.
MOST_POINTS = 1500


@dataclass(frozen=True)
class Series:
    """x, y: (n,), a NaN breaks a line; role: what it stands for, which gives its colour.

    mark: line, points, both or bars; width: (n,) of bars; views: in which it is shown, () is all;
    words: (n,) said when pointed at.
    """

    panel: int
    x: Numbers
    y: Numbers
    name: str
    role: str
    mark: str = "line"
    symbol: str = "circle"
    dash: str = "solid"
    size: float = 6.0
    views: tuple[str, ...] = ()
    width: Numbers | None = None
    words: Sequence[str] | None = None


@dataclass(frozen=True)
class Line:
    """A line across a panel at `value` of the axis x or y."""

    axis: str
    value: float
    role: str
    text: str = ""
    dash: str = "dash"


@dataclass(frozen=True)
class Panel:
    """One pair of axes; units are said in the title and in the label of x.

    y_names: what y = 0, -1, -2, ... stand for, where it counts rows; share: of the height;
    x_narrow: the label of x where a phone has no room for the whole one.
    """

    title: str
    x_label: str
    y_unit: str
    log: bool = False
    lines: tuple[Line, ...] = ()
    x_range: tuple[float, float] | None = None
    y_range: tuple[float, float] | None = None
    y_names: tuple[str, ...] = ()
    share: float = 1.0
    x_narrow: str = ""


AXES = ("x", "y", "z")
#: What is off by nothing.
ZERO = Line("y", 0.0, "context", dash="dot")


def panels_of_axes(x_label: str, **look: Any) -> tuple[Panel, ...]:
    """A panel for the error of each axis, all looking alike."""
    return tuple(Panel(f"{axis} axis, mdps", x_label, "mdps", **look) for axis in AXES)


@dataclass(frozen=True)
class Plot:
    """Panels side by side, or with `stacked` one under another along one x.

    key: its name in file names and on the page; description: what it shows, for who cannot see it;
    views: names of which one is shown at a time; frames: label and (series -> new values) of the
    moments among which a slider chooses, the last of them drawn first.
    """

    key: str
    title: str
    caption: str
    description: str
    panels: tuple[Panel, ...]
    series: tuple[Series, ...]
    stacked: bool = False
    views: tuple[str, ...] = ()
    frames: tuple[tuple[str, Mapping[int, Series]], ...] = field(default=())


def thinned(x: Numbers, y: Numbers, most: int = MOST_POINTS) -> tuple[Numbers, Numbers]:
    """Of each stretch of a long line its lowest and its highest point, in their order."""
    n = len(x)
    if n <= most:
        return np.asarray(x), np.asarray(y)
    edges = np.linspace(0, n, most // 2 + 1).astype(int)
    keep: set[int] = set()
    for first, last in zip(edges[:-1], edges[1:]):
        part = np.asarray(y[first:last], float)
        if np.isfinite(part).any():
            keep |= {first + int(np.nanargmin(part)), first + int(np.nanargmax(part))}
        else:
            keep.add(int(first))
    at = np.array(sorted(keep))
    return np.asarray(x)[at], np.asarray(y)[at]
