"""The orientation that each pass of the source in motion saw, window by window, for plots."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from os import PathLike
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..recordings import Recording
from ..recordings.atomic import written_beside

_JOB, _PASS, _K, _REASON, _STAGE, _Y, _SLOPES = 13, 14, 15, 17, 12, 51, 76
_NODE_US, _VISITS = 0, 5
_IDLE, _TRAVERSE = 0, 1
REASONS = ("nothing yet", "growing", "learned", "still", "turned", "too fast", "lost", "gap")


@dataclass(frozen=True)
class Window:
    """One window: orientation_deg (passes, nodes, 3): both tilts and the heading, bias removed.

    Row 0 is the orientation with what was known before; each further row has the slope of the
    pass before removed. slopes_dps (passes, 3): what each pass found about the body's axes.
    end_s: since the recording's start; reason: a word of REASONS.
    """

    end_s: float
    node_s: float
    reason: str
    orientation_deg: NDArray[np.float64]
    slopes_dps: NDArray[np.float64]


def windows(recording: Recording, **options: object) -> Iterator[Window]:
    """Every window that the source works on, in order; options: keywords of motion_settings.

    The kernels are those of the firmware, the work of a window being done at once.
    """
    from zerorate.in_motion import update, work
    from zerorate.motion_settings import motion_settings, motion_state

    scales, columns = recording.scales, recording.columns
    settings = motion_settings(
        scales.odr_hz, scales.gyro_lsb_per_dps, scales.accel_lsb_per_g, **options
    )
    state = motion_state(settings)
    # no node is visited by update itself: each is seen one by one below
    settings[_VISITS] = 0
    t_us = columns["t_us"].tolist()
    names = ("ax", "ay", "az", None, "gx", "gy", "gz")
    rows = zip(*(columns[name].tolist() if name else [0] * len(t_us) for name in names))
    for before, now, row in zip([2 * t_us[0] - t_us[1], *t_us], t_us, rows):
        update(state, settings, row, now - before)
        if state[_JOB] != _IDLE:
            settings[_VISITS] = 1
            passes = _passes(state, settings, work)
            settings[_VISITS] = 0
            scale = 256 * scales.gyro_lsb_per_dps
            slopes = np.array(state[_SLOPES : _SLOPES + 9]).reshape(3, 3)[: len(passes)] / scale
            end_s, node_s = (now - t_us[0]) / 1e6, settings[_NODE_US] / 1e6
            yield Window(end_s, node_s, REASONS[state[_REASON]], passes, slopes)


def _passes(state, settings, work) -> NDArray[np.float64]:
    seen: dict[int, list] = {}
    while state[_JOB] != _IDLE:
        number, traversing = state[_PASS], state[_JOB] == _TRAVERSE
        work(state, settings)
        if traversing and number > 0:
            seen.setdefault(number, []).append(list(state[_Y : _Y + 3]))
    return np.degrees(np.array([seen[number] for number in sorted(seen)]) / (1 << 12))


def plot(window: Window, path: str | PathLike[str]) -> None:
    """Write a picture of the window: one row a pass, both tilts and the heading against time."""
    from matplotlib.figure import Figure

    count = len(window.orientation_deg)
    figure = Figure(figsize=(8, 2.2 * count), layout="constrained")
    t = np.arange(window.orientation_deg.shape[1]) * window.node_s
    for number, panel in enumerate(figure.subplots(count, 1, sharex=True, squeeze=False)[:, 0]):
        for values, name in zip(window.orientation_deg[number].T, ("tilt", "tilt", "heading")):
            panel.plot(t, values, label=name)
        slopes = ", ".join(f"{slope:+.3f}" for slope in window.slopes_dps[number])
        panel.set_title(f"pass {number + 1}: slope {slopes} dps", fontsize=9)
        panel.set_ylabel("deg")
    panel.set_xlabel("s")
    panel.legend(loc="upper right", fontsize=8)
    figure.suptitle(f"window ending at {window.end_s:.1f} s: {window.reason}", fontsize=10)
    with written_beside(Path(path)) as temporary:
        figure.savefig(temporary, format="png", dpi=120)
