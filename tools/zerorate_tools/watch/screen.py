"""What a person sees: a screen that renews itself, or lines where there is no terminal."""

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from shutil import get_terminal_size
from typing import Any, TypeAlias

import numpy as np

from ..errors import MissingLibrary, ZerorateError, printable
from ..numbers import fixed
from ..progress import redrawn

_BARS = "▁▂▃▄▅▆▇█"
_MOST_BARS = 24
#: Columns of a terminal that all takes but the bars, and with two of them.
_WITHOUT_BARS, _LEAST_COLUMNS = 68, 70


#: What is shown: a Live, or the OwnOutput of a board's own program, which has the same names.
#: A quality of NaN is not known.
Shown: TypeAlias = Any
Screen: TypeAlias = "Lines | Area"


@contextmanager
def screen(plain: bool = False) -> Iterator[Screen]:
    """A screen for this terminal; lines where there is none, or a narrow one, or `plain`."""
    if plain or not sys.stdout.isatty() or get_terminal_size().columns < _LEAST_COLUMNS:
        yield Lines()
        return
    with redrawn() as area:
        yield Area(area)


class Lines:
    """A line each time, for a pipe, a log or a test."""

    def show(self, live: Shown, notes: list[str]) -> None:
        """Print time, temperature, and per axis bias, quality and source."""
        axes = zip("xyz", live.bias_dps, live.quality_dps, live.source)
        biases = "  ".join(f"{axis} {_bias(*known)}" for axis, *known in axes)
        warm = "" if live.temp_degc is None else f"  {live.temp_degc:.1f} degC"
        said = "; ".join([live.learning()[0], *notes])
        print(f"{live.duration_s:8.1f} s{warm}  bias dps {biases}  | {said}", flush=True)


def _bias(bias_dps: float, quality_dps: float, source: str) -> str:
    # a bias that nobody knows is not known to +-0
    if source == "none":
        return source
    sigma = "" if np.isnan(quality_dps) else f"±{quality_dps:.3f}"
    return f"{fixed(bias_dps, 3, '+')}{sigma} {source}"


class Area:
    """A part of the terminal that is drawn anew."""

    def __init__(self, area: Any) -> None:
        self._area = area

    def show(self, live: Shown, notes: list[str]) -> None:
        """Draw it."""
        from rich.console import Group
        from rich.text import Text

        # Text, not str: a file's name may hold what rich takes for markup
        parts = [
            Text(printable(live.headline()), style="bold"),
            _table(live, self._area.console.width),
        ]
        parts += [Text(printable(line)) for line in [*live.conditions(), *_learning(live)]]
        parts += [Text(printable(note), style="yellow") for note in notes]
        parts.append(Text("Ctrl-C ends.", style="dim"))
        self._area.update(Group(*parts), refresh=True)


def sparkline(values: np.ndarray, most: int = _MOST_BARS) -> str:
    """Bars of a series, so many at most, from its lowest to its highest value."""
    if not len(values):
        return ""
    at = np.linspace(0, len(values) - 1, min(most, len(values))).astype(int)
    low, high = float(values.min()), float(values.max())
    share = (values[at] - low) / (high - low) if high > low else np.zeros(len(at))
    return "".join(_BARS[int(s * (len(_BARS) - 1) + 0.5)] for s in share)


def _table(live: Shown, columns: int) -> Any:
    from rich import box
    from rich.table import Table
    from rich.text import Text

    table = Table(box=box.SIMPLE_HEAD, collapse_padding=True, pad_edge=False)
    for name in ("", "rate dps", "corrected", "bias dps", "± one sigma"):
        table.add_column(name, justify="right", no_wrap=True)
    table.add_column("from", no_wrap=True)
    bars = min(_MOST_BARS, columns - _WITHOUT_BARS)
    table.add_column("bias of late", no_wrap=True, overflow="crop", width=bars)
    past = np.array(live.history).reshape(-1, 3)
    for i, source in enumerate(live.source):
        signed = [fixed(v[i], 3, "+") for v in (live.rate_dps, live.left_dps, live.bias_dps)]
        unknown = source == "none" or np.isnan(live.quality_dps[i])
        sigma = "" if unknown else f"{live.quality_dps[i]:.3f}"
        named = Text(printable(source))
        table.add_row(f"g{'xyz'[i]}", *signed, sigma, named, sparkline(past[:, i], bars))
    return table


def _learning(live: Shown) -> list[str]:
    """The firmware's words but for what the table has: of an axis only what is behind its bias."""
    said = []
    for line in live.learning():
        axis, behind, what = line.partition("; ")
        if not line.startswith(("gx: bias", "gy: bias", "gz: bias")):
            said.append(line)
        elif behind:
            said.append(f"{axis[:2]}: {what}")
    return said


@dataclass(frozen=True)
class WatchOptions:
    """How to watch.

    seconds: end after so long; once: end with what is there; every_s: between two looks (default
    0.5 on a terminal, 2 in a pipe); settings, model: as of Live; setup: as of
    stream_port; own: show what the board's own program prints, and leave it running.
    """

    seconds: float | None = None
    once: bool = False
    every_s: float | None = None
    plain: bool = False
    settings: dict[str, Any] | None = None
    model: Path | None = None
    setup: str = ""
    own: bool = False

    def seconds_between_looks(self, shown: Screen) -> float:
        """Seconds between two looks on that screen."""
        if self.every_s is not None:
            return self.every_s
        return 2.0 if isinstance(shown, Lines) else 0.5


def check_picture(path: Path) -> None:
    """Raise ZerorateError if `draw` could not write that picture, before anything is watched."""
    try:
        from matplotlib.figure import Figure
    except ImportError as error:
        raise MissingLibrary("matplotlib") from error
    if path.suffix.lower()[1:] not in Figure().canvas.get_supported_filetypes():
        raise ZerorateError(f"{path}: no picture is named so; end it in .png or .svg")
    if not path.parent.is_dir():
        raise ZerorateError(f"{path}: there is no folder {path.parent}; make it first")


def draw(live: Shown, path: Path) -> None:
    """Draw a second's bias after the other into a PNG, SVG or PDF. Raises ZerorateError."""
    from matplotlib.figure import Figure

    if not live.history:
        do = "watch for longer, a program that prints rates as examples/main.py does"
        raise ZerorateError(f"{path}: no bias came to be drawn; {do}")
    figure = Figure(figsize=(8, 4.5), layout="constrained")
    axes = figure.subplots()
    for name, bias_dps in zip("xyz", np.array(live.history).reshape(-1, 3).T):
        axes.plot(bias_dps, label=f"g{name}")
    axes.set(title=live.name, xlabel="s", ylabel="bias, dps")
    axes.legend()
    figure.savefig(path)
