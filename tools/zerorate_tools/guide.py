"""`zerorate record --guide`: which turn is still missing, said while a device is in the hand.

The windows and their statement are those of `close`. The latest part of the recording is fitted
again as its windows come. What earlier parts state is kept and added, so that a look costs the same
however long the recording is.
"""

import sys
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from .loop.motion.columns import MATRIX
from .loop.motion.device import SIZES, Shown
from .loop.motion.matrix import Fitted, beside
from .loop.motion.moving import LEAST_DPS, moving_of
from .loop.motion.windows import LEAST_WINDOWS
from .progress import redrawn
from .recordings import Recording, Scales, write_recording
from .recordings.recording import GYRO, TIME, Columns

#: A posterior sigma at which an entry is known: a full turn is then right to a third of a degree.
KNOWN = 0.001
#: Before there are eight windows of 40 s, whose fit would take as long as a window is apart.
_PART_S = 105.0
_RAIL = 32767
#: An axis is asked for at least as long as the shortest window lasts.
_TURN_S = 10.0
_WIDE = np.eye(MATRIX) * SIZES[-1] ** -2
AXES = "xyz"
#: Entries by rows: the axis that reads, the axis turned about.
NAMES = [f"{i} from {j}" if i != j else f"scale of {i}" for i in AXES for j in AXES]
REST_S = 5.0
_LINE_S = 10.0
_BAR = 30
#: A window of 10 s, the shortest, ends this often.
_LOOK_S = 2.5


class KnownSoFar:
    """What a recording that is being made shows.

    matrix: (3, 3) the likeliest entries, axis that reads by axis that is turned; sigma: (3, 3) of
    each, under a prior as wide as data sheets allow; confirmed: the same, without that quarter of
    the latest windows whose loss is worst, as `close` judges on windows that it leaves out.
    next_axis: what to turn about; seconds: recorded so far; lately_dps: (3,) RMS of the last rates;
    clipped: samples at the rail.
    """

    def __init__(self, scales: Scales) -> None:
        self._scales = scales
        self._batches: list[Columns] = []
        self._kept = Shown()
        self._asked_s = 0.0
        self._turned_deg = np.zeros(3)
        self.seconds, self.clipped, self.next_axis = 0.0, 0, 0
        self.lately_dps, self.matrix = np.zeros(3), np.zeros((3, 3))
        self.sigma = self.confirmed = np.full((3, 3), SIZES[-1])

    def look(self, batches: list[Columns]) -> None:
        """Take samples that came since, in their order, and what they show."""
        self._feel(_joined(batches))
        self._batches += batches
        columns = _joined(self._batches)
        fitted = self._fitted(columns)
        if fitted is not None:
            self._know(fitted)
        if columns[TIME][-1] - columns[TIME][0] >= _PART_S * 1e6:
            self._kept += Shown() if fitted is None else fitted.shown(self.matrix)
            self._batches = []
        if self.seconds - self._asked_s >= _TURN_S:
            self._asked_s, self.next_axis = self.seconds, self._least_known()

    def _feel(self, new: Columns) -> None:
        words = np.column_stack([new[n] for n in GYRO])
        self.clipped += int((np.abs(words) >= _RAIL).any(axis=1).sum())
        self.lately_dps = (words / self._scales.gyro_lsb_per_dps).std(axis=0)
        before, self.seconds = self.seconds, int(new[TIME][-1]) * 1e-6
        self._turned_deg += self.lately_dps * (self.seconds - before)

    def _fitted(self, columns: Columns) -> Fitted | None:
        with TemporaryDirectory() as folder:
            path = Path(folder) / "part.parquet"
            write_recording(Recording(columns, self._scales), path)
            moving = moving_of(path)
        fitted = None if moving is None else beside(moving, self.matrix)
        return fitted if fitted is not None and len(fitted.rows.errors) >= LEAST_WINDOWS else None

    def _know(self, fitted: Fitted) -> None:
        whole = self._kept + fitted.shown(self.matrix)
        less = [self._kept + fitted.without(self.matrix, k) for k in sorted(set(fitted.folds))]
        self.sigma = _sigma(whole)
        self.confirmed = np.max([_sigma(s) for s in less], axis=0)
        self.matrix = np.linalg.solve(whole.normal + _WIDE, whole.right).reshape(3, 3)

    @property
    def all_known(self) -> bool:
        """Whether every entry is, whichever quarter is left out."""
        return bool((self.confirmed <= KNOWN).all() and (self.sigma <= KNOWN).all())

    def _least_known(self) -> int:
        """The axis of whose turns something is known worst; of equals the one turned least."""
        sigma = self.confirmed if (self.sigma <= KNOWN).all() else self.sigma
        return int(np.lexsort((self._turned_deg, -sigma.max(axis=0)))[0])


def _joined(batches: list[Columns]) -> Columns:
    return {name: np.concatenate([b[name] for b in batches]) for name in batches[0]}


def _sigma(shown: Shown) -> np.ndarray:
    return np.sqrt(np.diag(np.linalg.inv(shown.normal + _WIDE))).reshape(3, 3)


@contextmanager
def screen() -> Iterator["Lines | Bars"]:
    """Bars on a terminal; lines on standard output where there is none."""
    if not sys.stdout.isatty():
        yield Lines()
        return
    with redrawn() as area:
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

    def __init__(self, area: Any) -> None:
        self._area = area

    def show(self, known: KnownSoFar) -> None:
        """Draw it."""
        from rich.console import Group
        from rich.text import Text

        parts = [Text(asked(known), style="bold"), _table(known.sigma)]
        parts += [Text(note) for note in notes(known)]
        parts.append(Text("Ctrl-C ends.", style="dim"))
        self._area.update(Group(*parts), refresh=True)


def _table(sigma: np.ndarray) -> Any:
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

    def __init__(self, shown: Lines | Bars, waits: bool = False) -> None:
        self.known: KnownSoFar | None = None
        self._shown, self._waits = shown, waits
        self._waiting: list[Columns] = []
        self._pool = ThreadPoolExecutor(1)
        self._look: Future[None] | None = None

    def __enter__(self) -> "Guide":
        return self

    def __exit__(self, *error: object) -> None:
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
            self._look = self._pool.submit(self.known.look, self._waiting[:])
            self._waiting.clear()
        if self._look is None or not (self._waits or self._look.done()):
            return False
        self._look.result()
        self._look = None
        self._shown.show(self.known)
        return self.known.all_known

    def _has_come_s(self) -> float:
        if not self._waiting:
            return 0.0
        return float(self._waiting[-1][TIME][-1] - self._waiting[0][TIME][0]) * 1e-6
