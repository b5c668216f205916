"""The demo's picture: rates, bias and temperature, and the angle that is lost."""

from __future__ import annotations

from pathlib import Path

import matplotlib
import numpy as np

from .run import Demo
from .score import SETTLE_S, rates, seconds

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402

_COLOURS = ("#0072B2", "#D55E00", "#009E73")


def draw(shown: Demo, path: Path) -> None:
    """Write the picture as PNG."""
    figure, (top, middle, bottom) = plt.subplots(3, 1, figsize=(9, 10), sharex=True)
    minutes = seconds(shown.recording) / 60
    _biases(top, shown, minutes)
    _rest_of_rate(middle, shown, minutes)
    _angles(bottom, shown, minutes)
    bottom.set_xlabel("minutes since power-on")
    figure.suptitle(f"{shown.recording.name} on MicroPython ({shown.runtime})")
    figure.tight_layout()
    figure.savefig(path, dpi=110, format="png")
    plt.close(figure)


def _biases(axes, shown: Demo, minutes) -> None:
    for i, axis in enumerate("xyz"):
        known = np.where(shown.bias_dps[:, i] == 0, np.nan, shown.bias_dps[:, i])
        axes.plot(minutes, known, color=_COLOURS[i], label=f"bias found, g{axis}")
        if shown.truth_dps is not None:
            few = slice(None, None, max(1, len(minutes) // 200))
            axes.plot(minutes[few], shown.truth_dps[few, i], "k:", linewidth=1)
    axes.set_ylabel("dps")
    axes.legend(loc="upper left", fontsize=8)
    scales = shown.recording.scales
    if scales.temp_lsb_per_degc and "temp" in shown.recording.columns:
        warm = axes.twinx()
        warm.plot(minutes, scales.temp_degc(shown.recording.columns["temp"]), color="0.7")
        warm.set_ylabel("die temperature, degC", color="0.4")
    axes.set_title("Bias" + ("" if shown.truth_dps is None else " (dotted: the truth)"))


def _rest_of_rate(axes, shown: Demo, minutes) -> None:
    target = rates(shown.recording) if shown.truth_dps is None else shown.truth_dps
    error = (target - shown.bias_dps) * 1e3
    for i, axis in enumerate("xyz"):
        axes.plot(minutes, _smoothed(error[:, i], shown), color=_COLOURS[i], label=f"g{axis}")
    late = error[seconds(shown.recording) >= SETTLE_S]
    smooth = np.concatenate([_smoothed(late[:, i], shown) for i in range(3)])
    most = max(5.0, 1.5 * float(np.nanmax(np.abs(smooth))))
    axes.set_ylim(-most, most)
    axes.set_ylabel("mdps")
    axes.legend(loc="upper right", fontsize=8)
    axes.set_title("What is left of it, 5 s means")


def _smoothed(values, shown: Demo):
    width = max(1, int(5 * shown.recording.scales.odr_hz))
    return np.convolve(values, np.ones(width) / width, mode="same")


def _angles(axes, shown: Demo, minutes) -> None:
    t_s = seconds(shown.recording)
    rate = rates(shown.recording)
    target = rate if shown.truth_dps is None else shown.truth_dps
    later = t_s >= SETTLE_S
    steps = np.diff(t_s[later], append=t_s[-1])[:, None]
    first = rate[t_s < SETTLE_S].mean(axis=0)
    curves = {
        "uncorrected": target[later],
        "mean of the first 10 s": target[later] - first,
        "zerorate": (target - shown.bias_dps)[later],
    }
    for (name, error), style in zip(curves.items(), ("0.6", "#D55E00", "#0072B2")):
        lost = np.linalg.norm(np.cumsum(error * steps, axis=0), axis=1)
        axes.plot(minutes[later], np.maximum(lost, 1e-3), color=style, label=name)
    axes.set_yscale("log")
    axes.set_ylabel("degrees")
    axes.legend(loc="lower right", fontsize=8)
    axes.set_title("Angle lost by integration")
