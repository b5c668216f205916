"""The orientation that each pass of the source in motion saw, window by window, and its picture."""

from collections.abc import Iterator
from dataclasses import dataclass
from os import PathLike
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from zerorate_tools.layout import JOB, MOTION
from zerorate_tools.layout import MOTION_SETTINGS as SET

from ..errors import InFile, ZerorateError
from ..numbers import fixed
from ..recordings import Recording
from ..recordings.atomic import written_beside
from ..recordings.reading import OpenRecording
from .samples import frames_in_batches, sensor_of

REASONS = ("nothing yet", "growing", "learned", "still", "turned", "too fast", "lost", "gap")
_MOST_PICTURES = 12


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


def windows(recording: OpenRecording | Recording, **options: object) -> Iterator[Window]:
    """Every window that the source works on, in order; options: keywords of motion_settings.

    The kernels are those of the firmware, on plain CPython, the work of a window being done at
    once: ten minutes at 100 Hz take some seconds.
    """
    from zerorate.motion.in_motion import update, work
    from zerorate.motion.motion_settings import motion_settings, motion_state

    sensor = sensor_of(recording.scales)
    scales = (sensor.odr_hz, sensor.gyro_lsb_per_dps, sensor.accel_lsb_per_g)
    try:
        settings = motion_settings(*scales, temp_lsb_per_degc=sensor.temp_lsb_per_degc, **options)
    except ValueError as error:
        raise ZerorateError(f"{recording.name}: {error}") from error
    state = motion_state(settings)
    # no node is visited by update itself: each is seen one by one below
    settings[SET.VISITS] = 0
    noted, elapsed_us = MOTION.NOTED_SLOPES_Q8, 0
    for batch in frames_in_batches(recording):
        for row, dt_us in zip(batch.frames.tolist(), batch.dt_us.tolist()):
            elapsed_us += dt_us
            update(state, settings, row, dt_us)
            if state[MOTION.JOB] != JOB.IDLE:
                settings[SET.VISITS] = 1
                passes = _passes(state, settings, work)
                settings[SET.VISITS] = 0
                slopes = np.array(state[noted : noted + 9]).reshape(3, 3)
                # the last pass has the last row, however many there were
                slopes = slopes[[*range(len(passes) - 1), settings[SET.PASSES] - 1]]
                yield Window(
                    elapsed_us / 1e6,
                    settings[SET.NODE_US] / 1e6,
                    REASONS[state[MOTION.MOTION_REASON]],
                    passes,
                    slopes / (256 * sensor.gyro_lsb_per_dps),
                )


def _passes(state, settings, work) -> NDArray[np.float64]:
    seen: dict[int, list] = {}
    while state[MOTION.JOB] != JOB.IDLE:
        number, traversing = state[MOTION.PASS], state[MOTION.JOB] == JOB.TRAVERSE
        work(state, settings)
        if traversing and number > 0:
            seen.setdefault(number, []).append(list(state[MOTION.Y : MOTION.Y + 3]))
    return np.degrees(np.array([seen[number] for number in sorted(seen)]) / (1 << 12))


def windows_to_plot(
    recording: OpenRecording | Recording, path: Path, **options: object
) -> list[Window]:
    """The windows that taught a bias; nothing is written yet, but could be: all else is refused.

    path: as of `plot_windows`; options: as of `windows`. Raises ZerorateError where no window
    taught one, or where the picture's folder is not there; ModuleNotFoundError without Matplotlib.
    """
    import matplotlib.figure  # noqa: F401

    if path.suffix == ".png" and not path.parent.is_dir():
        raise InFile(path, "its folder is not there", do="name a folder that exists and is yours")
    found = list(windows(recording, **options))
    taught = [window for window in found if window.reason == "learned"]
    if not taught:
        seen = sorted({window.reason for window in found}) or ["no full window"]
        raise ZerorateError(f"{recording.name}: no window in motion to plot: {', '.join(seen)}")
    return taught


def plot_windows(taught: list[Window], path: Path) -> list[Path]:
    """Draw windows and return the pictures' paths.

    path: a .png for the latest of them, else a folder for up to twelve, evenly spaced.
    """
    if path.suffix == ".png":
        plot(taught[-1], path)
        return [path]
    path.mkdir(parents=True, exist_ok=True)
    every = -(-len(taught) // _MOST_PICTURES)
    pictures = {path / f"window-{w.end_s:07.1f}s.png": w for w in taught[::every]}
    for picture, window in pictures.items():
        plot(window, picture)
    return list(pictures)


def plot(window: Window, path: str | PathLike[str]) -> None:
    """Write a picture of the window: one row a pass, both tilts and the heading against time."""
    from matplotlib.figure import Figure

    count = len(window.orientation_deg)
    figure = Figure(figsize=(8, 2.2 * count), layout="constrained")
    t = np.arange(window.orientation_deg.shape[1]) * window.node_s
    panels = figure.subplots(count, 1, sharex=True, squeeze=False)[:, 0]
    for number, panel in enumerate(panels):
        for values, name in zip(window.orientation_deg[number].T, ("x", "y", "z (heading)")):
            line = np.polynomial.Polynomial.fit(t, values, 1)
            (drawn,) = panel.plot(t, values, label=name)
            panel.plot(t, line(t), "--", color=drawn.get_color(), linewidth=0.8)
        slopes = ", ".join(fixed(slope, 3, "+") for slope in window.slopes_dps[number])
        when = "before" if number == 0 else f"after pass {number}"
        panel.set_title(f"{when}; pass {number + 1} finds a slope of {slopes} dps", fontsize=9)
        panel.set_ylabel("deg")
    panels[-1].set_xlabel("s")
    figure.legend(*panels[0].get_legend_handles_labels(), loc="outside right upper", fontsize=8)
    figure.suptitle(f"window ending at {window.end_s:.1f} s: {window.reason}", fontsize=10)
    with written_beside(Path(path)) as temporary:
        figure.savefig(temporary, format="png", dpi=120)
