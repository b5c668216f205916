"""The answer as a picture: before, after and the floor of each axis and of all, with intervals."""

from typing import Any

import numpy as np

from .plot import Panel, Plot, Series

_ROWS = ("all axes", "x axis", "y axis", "z axis")
_APART = 0.14


def at_a_glance(result: dict[str, Any]) -> Plot:
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


def _figures(result, name):
    """Value and limits, each (4,): all axes first."""
    whole = result["in_all"]
    limits = np.array([whole["ci95_mdps"][name], *result["ci95_mdps"][name]])
    value = np.array([whole[f"{name}_mdps"], *result[f"{name}_mdps"]])
    return value, limits[:, 0], limits[:, 1]
