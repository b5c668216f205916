"""What a person sees who turns a device in the hand: what to do next, and nine bars."""

import sys
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from types import TracebackType
from typing import Protocol

import numpy as np

from ..loop.motion.device import SIZES
from ..loop.motion.moving import LEAST_DPS
from ..recordings import Scales
from ..recordings.recording import TIME, Columns
from .known import KNOWN, KnownSoFar

AXES = "xyz"
#: Entries by rows: the axis that reads, the axis turned about.
NAMES = [f"{i} from {j}" if i != j else f"scale of {i}" for i in AXES for j in AXES]
REST_S = 5.0
_LINE_S = 10.0
_BAR = 30
#: A window of 10 s, the shortest, ends this often.
_LOOK_S = 2.5


class Shown(Protocol):
    """Takes what is known, as often as one likes."""

    def show(self, known: KnownSoFar) -> None:
        """Show it."""


@contextmanager
def screen() -> Iterator[Shown]:
    """Bars on a terminal; lines on standard output where there is none."""
    if not sys.stdout.isatty():
        yield Lines()
        return
    from rich.live import Live

    with Live(auto_refresh=False) as area:
        yield Bars(area)


def asked(known: KnownSoFar) -> str:
    """What to do next."""
    if known.all_known:
        return "All nine are known. Put it down."
    if known.seconds < REST_S:
        return "Leave it untouched for five seconds."
    axis = AXES[known.next_axis]
    again = "Once more, turn" if (known.sigma <= KNOWN).all() else "Turn"
    return f"{again} it about {axis}: hold {axis} level, half a turn and back, again and again."


def notes(known: KnownSoFar) -> list[str]:
    """What it does now, and what spoils it."""
    axis = int(known.lately_dps.argmax())
    turning = known.lately_dps[axis] > LEAST_DPS
    now = f"turning about {AXES[axis]}" if turning else "not turning"
    said = [f"{known.seconds:.0f} s; {now}"]
    if known.clipped:
        said.append(f"{known.clipped} samples are clipped: turn more slowly, or widen the range")
    return said


def left(known: KnownSoFar) -> str:
    """How many are known, and which is known worst."""
    count = int((known.sigma <= KNOWN).sum())
    sigma = (known.confirmed if count == len(NAMES) else known.sigma).ravel()
    worst = int(sigma.argmax())
    least = f"{NAMES[worst]} ±{100 * sigma[worst]:.2f} %"
    words = "worst without a quarter of it" if count == len(NAMES) else "worst"
    return f"{count} of 9 known to {100 * KNOWN:g} %, {words}: {least}"


def unknown(known: KnownSoFar) -> list[str]:
    """Names of the entries that are not known."""
    return [name for name, sigma in zip(NAMES, known.sigma.ravel()) if sigma > KNOWN]


class Lines:
    """A line when another axis is asked for, and every ten seconds: for a pipe, a log or a test."""

    def __init__(self) -> None:
        self._asked, self._at_s = "", 0.0

    def show(self, known: KnownSoFar) -> None:
        """Print what is known and what to do."""
        text = asked(known)
        if text != self._asked or known.seconds - self._at_s >= _LINE_S:
            self._asked, self._at_s = text, known.seconds
            print(f"{'; '.join(notes(known))}; {left(known)}\n  {text}", flush=True)


class Bars:
    """A part of the terminal that is drawn anew."""

    def __init__(self, area) -> None:
        self._area = area

    def show(self, known: KnownSoFar) -> None:
        """Draw it."""
        from rich.console import Group
        from rich.text import Text

        parts = [Text(asked(known), style="bold"), _table(known.sigma)]
        parts += [Text(note) for note in notes(known)]
        parts.append(Text("Ctrl-C ends.", style="dim"))
        self._area.update(Group(*parts), refresh=True)


def _table(sigma: np.ndarray):
    from rich.progress_bar import ProgressBar
    from rich.table import Table

    table = Table(box=None)
    for name in ("error", "how well it is known", "one sigma, %"):
        table.add_column(name, justify="right" if "%" in name else "left")
    for name, value, share in zip(NAMES, sigma.ravel(), shares(sigma).ravel()):
        table.add_row(name, ProgressBar(1.0, float(share), _BAR), f"{100 * value:.2f}")
    return table


def shares(sigma: np.ndarray) -> np.ndarray:
    """Of the way from what a data sheet leaves open to what is asked for, in decades."""
    return np.clip(np.log(SIZES[-1] / sigma) / np.log(SIZES[-1] / KNOWN), 0.0, 1.0)


class Guide:
    """For `record`: `heard` takes its samples, `done` shows what they say and ends it.

    waits: whether the recording waits for each look; else looks run beside it, since a chip's FIFO
    holds less than a second.
    """

    def __init__(self, shown: Shown, waits: bool = False) -> None:
        self.known: KnownSoFar | None = None
        self._shown, self._waits = shown, waits
        self._waiting: list[Columns] = []
        self._pool = ThreadPoolExecutor(1)
        self._look: Future[None] | None = None

    def __enter__(self) -> "Guide":
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        at: TracebackType | None,
    ) -> None:
        self._pool.shutdown()

    def heard(self, scales: Scales) -> Callable[[Columns], None]:
        """What each batch of verified samples is given to."""
        self.known = KnownSoFar(scales)
        return self._waiting.append

    def done(self, seconds: float) -> bool:
        """Begin a look where one is due, show what the last one found; whether all is known."""
        if self.known is None:
            return False
        if self._look is None and self._has_come_s() >= _LOOK_S:
            batches = self._waiting[:]
            self._waiting.clear()
            self._look = self._pool.submit(self.known.look, batches)
        if self._look is not None and (self._waits or self._look.done()):
            self._look.result()
            self._look = None
            self._shown.show(self.known)
            return self.known.all_known
        return False

    def _has_come_s(self) -> float:
        if not self._waiting:
            return 0.0
        return float(self._waiting[-1][TIME][-1] - self._waiting[0][TIME][0]) * 1e-6
