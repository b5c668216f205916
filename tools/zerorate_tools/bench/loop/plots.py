"""Pictures of the real recordings: what was measured, and what the models leave of it."""

from pathlib import Path

import numpy as np

from . import bin_tables

_COLOURS = {"line": "tab:gray", "after": "tab:blue", "cubic": "tab:orange"}


def draw_recording(analysis, rival, title: str, path: Path) -> None:
    """Temperature, and an axis a panel: the rate less a straight line, less what was found, and
    less a cubic (rival: what it leaves, None without temperature), each by what has not seen it;
    the floor is a band."""
    import matplotlib.pyplot as plt

    session = analysis.holdout[0]
    minutes = (np.arange(session.blocks) + 0.5) * session.block_s / 60
    figure, panels = plt.subplots(4, 1, figsize=(9, 10), sharex=True, layout="constrained")
    figure.suptitle(title)
    _temperature(panels[0], session, minutes)
    left = _left(analysis, rival)
    for axis, panel in enumerate(panels[1:]):
        floor = 1e3 * analysis.floor_dps[axis]
        panel.axhspan(-floor, floor, color="tab:green", alpha=0.2, label="floor")
        for name, rows in left.items():
            panel.plot(minutes, 1e3 * rows[:, axis], ".-", ms=3, lw=0.8, color=_COLOURS[name],
                       label=name)  # fmt: skip
        panel.set_ylabel(f"{'xyz'[axis]}, mdps")
    panels[1].legend(ncols=4, fontsize="small")
    panels[-1].set_xlabel("minutes")
    figure.savefig(path, dpi=80)
    plt.close(figure)


def _temperature(panel, session, minutes):
    if "temp" in session.sources:
        panel.plot(minutes, session.block_mean(session.sources["temp"]), color="tab:red")
        panel.set_ylabel("degC")
    else:
        panel.text(0.5, 0.5, "no temperature recorded", transform=panel.transAxes, ha="center")


def _left(analysis, rival):
    """Name -> (n, 3) dps left of what was held out."""
    judged = analysis.judgement
    left = {"line": judged.residual_before[0], "after": judged.residual_after[0]}
    return left if rival is None else {**left, "cubic": rival[0]}


def draw_chip(path: Path, to: Path) -> None:
    """A chip's table: bins, and what line, cubic and the chosen order leave of those held out."""
    import matplotlib.pyplot as plt

    table = bin_tables.read(path)
    even = np.arange(len(table.temp_degc)) % 2 == 0
    train = table.of(even)
    order = bin_tables.chosen(train)
    figure, panels = plt.subplots(3, 1, figsize=(8, 8), sharex=True, layout="constrained")
    figure.suptitle(path.name)
    for axis, panel in enumerate(panels):
        for k, name in ((1, "line"), (3, "cubic"), (order, f"order {order}")):
            rows = table.rate_dps - bin_tables.fitted(train, table.temp_degc, k)
            colour = _COLOURS.get(name, _COLOURS["after"])
            panel.plot(table.temp_degc, 1e3 * rows[:, axis], color=colour, lw=0.8, label=name)
            panel.plot(table.temp_degc[~even], 1e3 * rows[~even, axis], "o", ms=4, color=colour)
        panel.set_ylabel(f"{'xyz'[axis]}, mdps left")
    panels[0].legend(title="dots: bins held out", ncols=3, fontsize="small")
    panels[-1].set_xlabel("degC")
    figure.savefig(to, dpi=80)
    plt.close(figure)
