"""Allan deviation of the held-out error, before and after, with the floor."""

import numpy as np
from numpy.typing import NDArray

from ..allan import Noise, overlapping
from .held_out import HeldOut
from .plot import Line, Panel, Plot, Series
from .residual_plots import AXES

_LEAST = 9


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
        Panel(
            f"{axis} axis, mdps",
            "averaging time, s",
            "mdps",
            log=True,
            lines=(Line("y", floor, "floor", "floor"),),
        )
        for axis, floor in zip(AXES, floor_mdps)
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


def longest(parts: list[HeldOut]) -> tuple[float, NDArray, NDArray] | None:
    """block_s, before and after, each (n, 3), of the longest stretch without a gap, if enough."""
    best = None
    for part in parts:
        there = np.isfinite(part.before_mdps).all(axis=1) & np.isfinite(part.after_mdps).all(axis=1)
        for run in np.split(np.arange(len(there)), np.flatnonzero(np.diff(there)) + 1):
            if there[run[0]] and (best is None or len(run) > len(best[1])):
                best = (part.block_s, part.before_mdps[run], part.after_mdps[run])
    return best if best is not None and len(best[1]) >= _LEAST else None
