"""The bias of each axis over time, as a picture."""

from pathlib import Path

import numpy as np

from ..errors import MissingLibrary, ZerorateError
from .screen import Shown


def draw(live: Shown, path: Path) -> None:
    """Draw a second's bias after the other into a PNG, SVG or PDF. Raises ZerorateError."""
    try:
        from matplotlib.figure import Figure
    except ImportError as error:
        raise MissingLibrary("matplotlib") from error
    if not live.history:
        do = "watch for longer, a program that prints rates as examples/main.py does"
        raise ZerorateError(f"{path}: no bias came to be drawn; {do}")
    figure = Figure(figsize=(8, 4.5), layout="constrained")
    axes = figure.subplots()
    for name, bias_dps in zip("xyz", np.array(live.history).reshape(-1, 3).T):
        axes.plot(bias_dps, label=f"g{name}")
    axes.set(title=live.name, xlabel="s", ylabel="bias, dps")
    axes.legend()
    try:
        figure.savefig(path)
    except ValueError as error:
        raise ZerorateError(f"{path}: no picture is named so; end it in .png or .svg") from error
