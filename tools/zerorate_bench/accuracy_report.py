"""`zerorate bench accuracy`: the tables and their figures."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from zerorate_tools.demo.broad import rms_mdps
from zerorate_tools.importers import read_foreign
from zerorate_tools.loop.read.still import runs
from zerorate_tools.peers import Given, Peer, given
from zerorate_tools.peers.online import first_seconds
from zerorate_tools.recordings import Recording

from .accuracy import DAY, FIRST_S, SCENARIOS, SEEDS, day, honesty, second_power_on
from .limits import ACCURACY, SESSION_2, limits_table, verdicts
from .peers import HOW, OURS, PEERS
from .public_data import data_folder, recordings, told_of
from .tables import machine, machine_line, number, table

_MADE = """\
Made by `zerorate bench accuracy` in one run, with the same samples for everyone. Real recordings
are read from `ZERORATE_DATA`, or from `shared/data` beside the checkout. Others may report
another figure for the same filter and scenario; `zerorate bench peers` shows what it depends on.
"""
_SESSION_2 = """\
Session 1 warms from 20 to 45 degC in 40 minutes. Then the power is cut. Session 2 warms from 17
to 44 degC in 20 minutes. `zerorate` has default settings and no effect model, for A, B and C
alike. It loads what it learned in session 1 from the store, so its first {first:.0f} s are from
the store.
"""
_DAY = """\
All begin with nothing learned. Waiting a second for the first rest raises the daily RMS. The last
two rows are floors, not estimators. The first is a Kalman filter that knows the true rests, the
true curve over temperature and the best walk for this day. The second is a Wiener smoother that
knows the curve and the spectra of bias and noise, sees a device that rests all day, and looks
ahead. It leaves flicker noise that the white noise hides. Nothing gets below it on this part.
"""
_HONESTY = """\
The share of the last power-on in which the truth lies within two `quality_lsb`, with all sources
on. 95 % would be exact. The firmware learns one sigma from the part itself: from its flicker
noise, its walk, and how well its power-ons repeat
([learning.md](learning.md#what-it-says-of-itself)).
"""
_REAL = """\
RMS over axes and over means of 20 s. The true rate is zero, but for Earth's 4 mdps. Blocks in
which the sensor was handled are left out. The first figure is of the whole recording, the second
without its first 20 s (8 readings).
"""


def steps(seeds: Sequence[int] = SEEDS) -> int:
    """How often `accuracy` advances."""
    folder = data_folder()
    logs = len(recordings(folder)) if folder else 0
    return len(DAY) + len(SCENARIOS) * len(seeds) * len(PEERS) + logs


def accuracy(
    advance: Callable[[float], None] = lambda n: None, seeds: Sequence[int] = SEEDS
) -> dict[str, Any]:
    """All figures, mdps: day_rms_mdps, session_2_rms_mdps, real_rms_mdps (None without data)."""
    folder = data_folder()
    found: dict[str, Any] = {
        "machine": machine(),
        "seeds": list(seeds),
        "day_rms_mdps": day(advance=advance),
        "session_2_rms_mdps": {
            name: second_power_on(name, seeds=seeds, advance=advance) for name in SCENARIOS
        },
        "within_two_sigma": {
            **{name: honesty(name, seeds) for name in SCENARIOS},
            "day": honesty("day", seeds[:1]),
        },
        "session_2_limits_mdps": SESSION_2,
        "session_2_how": HOW,
        "real_rms_mdps": real(folder, advance) if folder else None,
    }
    found["limits"] = [verdict.to_json() for verdict in verdicts(found, ACCURACY)]
    return found


def in_markdown(found: Mapping[str, Any]) -> str:
    limits = limits_table(verdicts(found, ACCURACY))
    return "\n".join(
        ["# Accuracy\n", _MADE, machine_line(found["machine"]), limits, *sections(found)]
    )


def sections(found: Mapping[str, Any]) -> Iterator[str]:
    """The tables of the day, of session 2 and of the real recordings, one below the other."""
    yield from _second_power_on(found["session_2_rms_mdps"], len(found["seeds"]))
    yield from _day(found["day_rms_mdps"])
    if found.get("within_two_sigma"):
        yield from _honesty(found["within_two_sigma"])
    yield from _real(found["real_rms_mdps"])


def _day(figures: Mapping[str, Mapping]) -> Iterator[str]:
    rows = [[peer, number(f["all"]), number(f["later"])] for peer, f in figures.items()]
    yield "## A simulated day: half of it moving, 25 degC of change\n"
    yield _DAY
    yield table(["RMS bias error, mdps", "all day", "after the first minute"], rows)


def _honesty(figures: Mapping[str, Mapping]) -> Iterator[str]:
    rows = [
        [name, *(f"{100 * shares[part]:.0f} %" for part in ("all", "first"))]
        for name, shares in figures.items()
    ]
    yield "## Is one sigma one sigma?\n"
    yield _HONESTY
    yield table(["truth within two sigma", "all", f"first {FIRST_S:.0f} s"], rows)


def _second_power_on(figures: Mapping[str, Mapping], seeds: int) -> Iterator[str]:
    header = ["RMS bias error, mdps", "how"]
    header += [f"{name[-1].upper()} {part}" for part in ("all", "first 15 s") for name in figures]
    rows: list[list[object]] = []
    for peer in PEERS:
        parts = [figures[name][peer][part] for part in ("all", "first") for name in figures]
        rows.append([peer, HOW[peer], *map(number, parts)])
    bounds = [f"{bound:g}" for part in SESSION_2.values() for bound in part.values()]
    rows.append(["zerorate must be at most", "", *bounds])
    yield f"## Session 2, after a warm-up and a power cut; all, and the first {FIRST_S:.0f} s\n"
    yield _SESSION_2.format(first=FIRST_S)
    yield "One seed.\n" if seeds == 1 else f"Median of {seeds} seeds.\n"
    yield table(header, rows)


def _real(figures: Mapping | None) -> Iterator[str]:
    yield "## Real recordings at rest\n"
    if figures is None:
        yield "Left out: no real recordings here; ZERORATE_DATA names their folder.\n"
        return
    rows = [
        [name, *(f"{number(f['all'])} / {number(f['later'])}" for f in columns.values())]
        for name, columns in figures.items()
    ]
    yield _REAL
    yield table(["mdps", *COLUMNS], rows)


BLOCK_S = 20.0
_START_READINGS = 8
_HANDLED = 3.0


def nothing(sessions) -> list[NDArray[np.float64]]:
    """No correction."""
    return [np.zeros_like(one.rate_dps) for one in sessions]


COLUMNS: dict[str, Peer] = {"uncorrected": nothing, "mean of the first 10 s": first_seconds, **OURS}


def rest_errors(recording: Recording, peer: Peer) -> dict[str, float]:
    """RMS over axes and blocks of rest, mdps: "all", and "later" without the start."""
    still = recording.columns.get("moving")
    one = given(recording, None if still is None else still == 0)
    residual = one.rate_dps - peer([one])[0]
    start = max(BLOCK_S * one.odr_hz, _START_READINGS)
    blocks = [(first, residual[first:end]) for first, end in _rests(one)]
    later = [block.mean(axis=0) for first, block in blocks if first >= start]
    every = [block.mean(axis=0) for _, block in blocks]
    return {"all": rms_mdps(np.array(every)), "later": rms_mdps(np.array(later))}


def _rests(one: Given) -> Iterator[tuple[int, int]]:
    """First and end of each block at rest; those with far more noise than most are handled ones."""
    size = max(1, round(BLOCK_S * one.odr_hz))
    blocks = []
    for start, end in runs(one.still):
        cuts = np.linspace(start, end, max(1, (end - start) // size) + 1).astype(int)
        blocks += list(zip(cuts[:-1], cuts[1:]))
    spreads = np.array([one.rate_dps[first:end].std(axis=0).max() for first, end in blocks])
    for block, spread in zip(blocks, spreads):
        if spread <= _HANDLED * np.median(spreads):
            yield block


def real(
    folder: Path, advance: Callable[[float], None] = lambda n: None
) -> dict[str, dict[str, dict[str, float]]]:
    """Each recording of the data folder: name -> column -> `rest_errors`."""
    found = {}
    for path in recordings(folder):
        name = f"{path.parent.name}/{path.name.split('.')[0]}"
        recording, _ = read_foreign(path, **told_of(path))
        found[name] = {column: rest_errors(recording, peer) for column, peer in COLUMNS.items()}
        advance(1)
    return found
