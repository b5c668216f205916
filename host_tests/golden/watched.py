"""What is shown of a sensor while it is watched or guided: figures and words."""

import io
from contextlib import redirect_stdout
from dataclasses import dataclass, field, replace
from types import SimpleNamespace
from unittest import mock

import numpy as np
from rich.console import Console
from zerorate_tools import guide
from zerorate_tools.boards.recorder import COLUMNS
from zerorate_tools.loop.motion.device import Shown
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
    shown(SimpleNamespace(update=lambda group, refresh: console.print(group))).show(what, *more)
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


def _watched():
    """A recording in pieces through the firmware, in lines and on a screen."""
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


class _Fitted:
    """Windows that show more of an axis the more of it was turned; of four folds."""

    def __init__(self, information):
        self.information, self.folds = np.tile(information, 3), np.arange(4)
        self.rows = SimpleNamespace(errors=np.zeros(guide.LEAST_WINDOWS))

    def shown(self, matrix, fold=None):
        return Shown(np.diag(self.information), self.information * np.linspace(-1e-2, 2e-2, 9))

    def without(self, matrix, fold):
        return Shown(
            self.shown(matrix).normal * np.tile([1, 1 - fold / 9, 1 - fold / 4], 3),
            (1 - fold / 8) * self.shown(matrix).right,
        )


def _guided():
    """What is known, asked and noted while one axis after the other is turned."""
    scales, rng = SimpleNamespace(gyro_lsb_per_dps=100.0), np.random.default_rng(5)
    known, lines = guide.KnownSoFar(scales), guide.Lines()
    shows = [
        None,
        [1e2, 1e4, 1e5],
        [1e6, 1e5, 3e6],
        [1.1e6, 3e6, 1.1e6],
        [4e6, 5e6, 9e6],
        [9e7] * 3,
    ]
    for number, information in enumerate(shows):
        fitted = information and _Fitted(np.array(information))
        t_us = np.arange(0, 3_300_000 if number < 3 else 110_000_000, 100_000) + number * 3_300_000
        rates = (
            rng.normal(0, 500, (len(t_us), 3))
            * np.roll([4.0, 1.0, 0.1], number)
            / (1 + 999 * (number == 1))
        )
        rates[: 2 * (number > 3), 0] = -32768
        new = {"t_us": t_us, **dict(zip(guide.GYRO, rates.astype(np.int64).T))}
        with mock.patch.object(guide.KnownSoFar, "_fitted", lambda *of, fitted=fitted: fitted):
            known.look([{n: c[:9] for n, c in new.items()}, {n: c[9:] for n, c in new.items()}])
        numbers = [known.matrix, known.sigma, known.confirmed, guide.shares(known.sigma)]
        yield [
            *np.concatenate(numbers).tolist(), known.lately_dps.tolist(), known.seconds,
            known.next_axis, known.clipped, known.all_known, guide.asked(known), guide.notes(known),
            guide.left(known), guide.unknown(known), _printed(lambda: lines.show(known)),
            _drawn(guide.Bars, known) if number % 2 else [],
        ]  # fmt: skip


def watched():
    """All that is watched and guided."""
    return {**dict(_watched()), "guided": [*_guided()]}
