"""A replay drawn: the bias of each axis with its uncertainty, over the temperature."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..recordings import Recording
from .replaying import Replay

if TYPE_CHECKING:
    from plotly.graph_objects import Figure

#: After Okabe and Ito (2008), told apart by the colour-blind; each with its band of two sigma.
_COLOURS = {
    "x": ("#0072b2", "rgba(0,114,178,0.15)"),
    "y": ("#d55e00", "rgba(213,94,0,0.15)"),
    "z": ("#009e73", "rgba(0,158,115,0.15)"),
}
#: More points than these cannot be told apart on a screen.
_MOST_POINTS = 2000


def plot(recording: Recording, replayed: Replay) -> Figure:
    """A Plotly figure of what `replay(recording)` learned; `.show()` or `.write_html(file)` it.

    Above: bias of each axis in dps with +-2 sigma, where there is one yet. Below, where the
    recording has a temperature: that, degC. Raises ValueError if the replay's table went to a file.
    """
    from plotly.subplots import make_subplots

    table = replayed.to_frame()
    every = max(1, len(table) // _MOST_POINTS)
    few = table.iloc[::every]
    minutes = (few["t_us"] - table["t_us"].iloc[0]).to_numpy() / 60e6
    figure = make_subplots(rows=1 + recording.has_temp, shared_xaxes=True, vertical_spacing=0.06)
    for axis in "xyz":
        _draw_axis(figure, minutes, few, recording.scales.gyro_lsb_per_dps, axis)
    figure.update_yaxes(title="bias, dps", row=1)
    if recording.has_temp:
        degrees = recording.temp_degc()[::every]
        figure.add_scatter(
            x=minutes, y=degrees, name="temperature", line_color="#6c6c74", row=2, col=1
        )
        figure.update_yaxes(title="degC", row=2)
    figure.update_xaxes(title="minutes", row=1 + recording.has_temp)
    # a recording's name comes from strangers, and Plotly reads some of HTML in a title
    title = recording.name.replace("<", "&lt;")
    return figure.update_layout(title=title, template="plotly_white", legend_traceorder="normal")


def _draw_axis(figure: Figure, minutes: Any, few: Any, lsb_per_dps: float, axis: str) -> None:
    known = few["source"].to_numpy() != "none"
    bias = np.where(known, few[f"bias_g{axis}"], np.nan) / lsb_per_dps
    two_sigma = 2 * few[f"quality_g{axis}"].to_numpy() / lsb_per_dps
    line, band = _COLOURS[axis]
    edges = {"row": 1, "col": 1, "showlegend": False, "hoverinfo": "skip", "line_width": 0}
    figure.add_scatter(x=minutes, y=bias + two_sigma, **edges)
    figure.add_scatter(x=minutes, y=bias - two_sigma, fill="tonexty", fillcolor=band, **edges)
    figure.add_scatter(x=minutes, y=bias, name=f"g{axis}", line_color=line, row=1, col=1)
