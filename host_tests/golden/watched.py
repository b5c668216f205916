"""What is shown of a sensor while it is watched: figures and words."""

import io
from contextlib import redirect_stdout
from dataclasses import dataclass, field, replace
from types import SimpleNamespace
from unittest import mock

import numpy as np
from rich.console import Console
from zerorate_tools.boards.recorder import COLUMNS
from zerorate_tools.simulate import simulate
from zerorate_tools.watch import watching
from zerorate_tools.watch.live import Live
from zerorate_tools.watch.screen import Area, Lines, WatchOptions, sparkline

_WARM = {
    "name": "run", "seed": 4, "sensor": {"odr_hz": 12.5}, "bias": {"b0": [1.5, -2.0, 0.5]},
    "every_session": {"temperature": [{"to": 30.0, "s": 40}], "motion": [
        {"kind": "rest", "s": 30}, {"kind": "hand", "s": 10},
    ]},
}  # fmt: skip


class _Clock:
    """Seconds that pass as they are told to."""

    def __init__(self):
        self.now = 100.0

    def __call__(self):
        return self.now


@dataclass
class _Tail:
    """What a growing file gives: batches in turn, None between them."""

    batches: list
    scales: object
    name: str = "run.csv"
    column_names: list = field(default_factory=lambda: [*COLUMNS])
    bad_rows: int = 3
    restarts: int = 0

    def read(self):
        return self.batches.pop(0) if self.batches else None


def _drawn(shown, what, *more):
    """Lines of what a part of a terminal 100 letters wide shows."""
    console = Console(width=100, file=io.StringIO())
    area = SimpleNamespace(update=lambda group, refresh: console.print(group), console=console)
    shown(area).show(what, *more)
    return [line.rstrip() for line in console.file.getvalue().splitlines()]


def _printed(run):
    said = io.StringIO()
    with redirect_stdout(said):
        run()
    return said.getvalue().splitlines()


def _of(live):
    numbers = [*live.rate_dps, *live.left_dps, *live.bias_dps, *live.quality_dps, live.duration_s]
    rows = np.array(live.history).reshape(-1, 3)
    return {"numbers": np.nan_to_num(numbers).tolist(), "history": rows.tolist(), "said": [
        live.headline(), *live.conditions(), *live.learning(), *live.source, live.samples,
        *map(sparkline, rows.T),
    ]}  # fmt: skip


def watched():
    """Yield (name, what is watched) of a recording in pieces, in lines and on a screen."""
    recording, _ = simulate(_WARM)
    parts = np.array_split(np.arange(len(recording)), [0, 7, 120, 250])
    pieces = [{n: c[at].astype(np.int64) for n, c in recording.columns.items()} for at in parts]
    live = Live("run", recording.scales, [*COLUMNS])
    yield "before", _of(live)
    for number, piece in enumerate(pieces):
        live.feed(piece)
        yield f"piece {number}", _of(live)
    yield "lines", _printed(lambda: Lines().show(live, ["a note"]))
    yield "screen", _drawn(Area, live, ["a note"])
    yield "followed", _followed(recording.scales, [pieces[1], None, pieces[2], None, pieces[3]])
    yield "slow", _followed(replace(recording.scales, odr_hz=2.0), [pieces[1], None, pieces[2]])


def _followed(scales, batches):
    """When a growing file is looked at, and what is noted of it."""
    looked, clock = [], _Clock()
    shown = SimpleNamespace(
        show=lambda live, notes: looked.append([clock.now, live.samples, notes])
    )

    def sleep(seconds):
        clock.now += 9.7 * seconds
        looked.append("slept")

    tail, first = _Tail(batches, scales), batches[0]
    with mock.patch.object(watching, "time", SimpleNamespace(monotonic=clock, sleep=sleep)):
        following = watching.Following(tail, WatchOptions(seconds=16.0, every_s=0.9), shown)
        following.run()
        tail.restarts, clock.now = 1, clock.now + 2.0
        following.look()
        options = WatchOptions(once=True)
        once = watching.Following(_Tail([first], scales), options, shown)
        clock.now += 60.0
        once.run()
        once.look()
    return looked
