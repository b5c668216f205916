"""The demo's pictures: bias and temperature, and what is left of the bias."""

from pathlib import Path
from typing import Any

import matplotlib
import numpy as np

from .job import SETTLE_S, Array, Demo, seconds

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

_COLOURS = ("#0072B2", "#D55E00", "#009E73")


def draw_job(first: Demo, before: Demo, after: Demo, path: Path) -> None:
    """Write the picture of the whole job as PNG: the first power-on, the last without and with."""
    figure, (top, middle, bottom) = plt.subplots(3, 1, figsize=(9, 10))
    _biases(top, first)
    most = max(_most(before), _most(after))
    for axes, shown, name in (
        (middle, before, "learning alone"),
        (bottom, after, "with model.bin"),
    ):
        _left(axes, shown, most)
        rms = f"{shown.score.firmware_mdps:.1f} mdps rms"
        axes.set_title(f"Left of it in {shown.recording.name}, {name}: {rms}", loc="left")
    bottom.set_xlabel("minutes since power-on")
    figure.tight_layout()
    figure.savefig(path, dpi=110, format="png")
    plt.close(figure)


def _biases(axes: Any, shown: Demo) -> None:
    minutes = seconds(shown.recording) / 60
    for i, axis in enumerate("xyz"):
        known = np.where(shown.bias_dps[:, i] == 0, np.nan, shown.bias_dps[:, i])
        axes.plot(minutes, known, color=_COLOURS[i], label=f"g{axis}")
        few = slice(None, None, max(1, len(minutes) // 200))
        axes.plot(minutes[few], shown.truth_dps[few, i], "k:", linewidth=1)
    axes.set_ylabel("dps")
    _legend_above(axes)
    scales = shown.recording.scales
    if scales.temp_lsb_per_degc and "temp" in shown.recording.columns:
        warm = axes.twinx()
        degc = scales.temp_degc(shown.recording.columns["temp"])
        warm.plot(minutes, degc, color="0.75", zorder=0)
        warm.set_ylabel("die temperature, degC (grey)", color="0.4")
    found = f"Bias found in {shown.recording.name} on MicroPython (dotted: the truth)"
    axes.set_title(found, loc="left")


def _legend_above(axes: Any) -> None:
    axes.legend(loc="lower right", bbox_to_anchor=(1, 1), ncol=3, fontsize=8, frameon=False)


def _error_mdps(shown: Demo, from_s: float = 0.0) -> Array:
    """(n, 3) of the samples from then on, smoothed over five seconds."""
    error = (shown.truth_dps - shown.bias_dps)[seconds(shown.recording) >= from_s] * 1e3
    width = max(1, int(5 * shown.recording.scales.odr_hz))
    smooth = [np.convolve(of, np.ones(width) / width, mode="same") for of in error.T]
    return np.stack(smooth, axis=1)


def _left(axes: Any, shown: Demo, most: float) -> None:
    minutes = seconds(shown.recording) / 60
    for axis, smooth, color in zip("xyz", _error_mdps(shown).T, _COLOURS):
        axes.plot(minutes, smooth, color=color, label=f"g{axis}")
    axes.axhline(0, color="0.8", linewidth=0.8, zorder=0)
    axes.set_ylim(-most, most)
    axes.set_ylabel("mdps")
    _legend_above(axes)


def _most(shown: Demo) -> float:
    return max(5.0, 1.3 * float(np.nanmax(np.abs(_error_mdps(shown, SETTLE_S)))))
