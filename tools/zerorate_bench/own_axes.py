"""Scale and axes that the firmware's filter in motion finds itself: what applying them would do."""

from __future__ import annotations

from array import array
from collections.abc import Sequence
from itertools import product
from pathlib import Path
from typing import Any
from zlib import crc32

import numpy as np
from numpy.typing import NDArray
from zerorate.arithmetic.real import unpack
from zerorate.motion.least_squares import known
from zerorate_tools.demo.broad import trials
from zerorate_tools.layout import MOTION
from zerorate_tools.peers import given
from zerorate_tools.recordings import Recording

from .heading import heading_error_deg, others_of
from .heading_simulated import Case, heading_lost_deg, recorded
from .peers import Source
from .tables import measured, table

Array = NDArray[np.float64]
WORLDS = ("hand", "headset", "walking", "drone", "robot", "coherent")
ERROR = 0.01
_SECONDS, _RESTING, _RATES_HZ = 600.0, 0.05, (25.0, 50.0, 100.0, 200.0)
#: An entry is wrong where applying it leaves so much more than before, and so many of its sigmas.
_WRONG, _SIGMAS = 0.002, 3.0
_STATES = range(3, 12)


def run(devices: int, data: Sequence[Path]) -> dict[str, Any]:
    """Rows of `devices` in each world, with errors and without, and of each trial of BROAD."""
    found: dict[str, Any] = {"devices": devices, "simulated": {}}
    for world, off in measured([*product(WORLDS, (True, False))]):
        rows = [one_device(Case(world, i, off)) for i in range(devices)]
        found["simulated"][f"{world}, {'1 %' if off else 'no'} errors"] = rows
    return found | {"broad": _on_broad(data)}


def one_device(case: Case) -> dict[str, float]:
    """What is left of a device's nine entries, how honest they are, and the heading, degrees."""
    rng = np.random.default_rng([case.number, crc32(case.kind.encode()), case.off])
    hz = float(rng.choice(_RATES_HZ))
    recording, truth, motion = recorded(
        case, rng, hz, _SECONDS, _RESTING, lambda rng: rng.normal(0, ERROR, (3, 3))
    )
    mean, sigma = entries(recording)
    left = truth - weighted(mean, sigma)
    wrong = np.abs(left) > np.maximum(_SIGMAS * sigma, np.abs(truth) + _WRONG)
    return {
        "left": float(np.sqrt(np.mean(left**2))),
        "within": float(np.mean(np.abs(mean - truth) < 2 * sigma)),
        "wrong": int(wrong.sum()),
        "before": heading_lost_deg(truth, motion),
        "after": heading_lost_deg(left, motion),
    }


def entries(recording: Recording) -> tuple[Array, Array]:
    """Mean and one sigma, (3, 3) each, of `error = matrix rate` at the recording's end."""
    source = Source("in_motion")
    source([given(recording)])
    state = array("i", source.state.tolist())
    push = float(np.ldexp(state[MOTION.PUSH], state[MOTION.PUSH + 1]))
    mean = np.reshape([_number(state, MOTION.MEAN + i) for i in _STATES], (3, 3))
    variances = np.reshape([_number(state, known(i, i)) for i in _STATES], (3, 3))
    return mean / 2.0**24, np.sqrt(push * np.maximum(variances, 0.0)) / 2.0**24


def _number(state: array[int], at: int) -> float:
    unpack(state, MOTION.T, at)
    return float(np.ldexp(state[MOTION.T], state[MOTION.T + 1]))


def weighted(mean: Array, sigma: Array) -> Array:
    """The mean, less where its sigma is not small beside the prior's."""
    return mean * np.clip(1 - (sigma / ERROR) ** 2, 0, 1)


def _on_broad(folders: Sequence[Path]) -> dict[str, list[float]]:
    """Trial -> degrees of heading lost: in its second half before and after what its first half
    shows; in all of it before, and after what each other trial of its device shows."""
    every = {t.name[:2]: t for folder in folders for t in trials(folder)}
    whole = {name: weighted(*entries(t.recording())) for name, t in every.items()}
    found = {}
    for name, trial in sorted(every.items()):
        at = np.flatnonzero(trial.moving)
        first = trial.part(slice(int((at[0] + at[-1]) / 2)))
        half = [np.zeros((3, 3)), weighted(*entries(first.recording()))]
        others = [half[0], *(whole[n] for n in others_of(name, every))]
        found[name] = [heading_error_deg(trial, m, 0.5) for m in half]
        found[name] += [heading_error_deg(trial, m) for m in others]
    return found


def in_markdown(found: dict[str, Any]) -> str:
    """The page."""
    heads = ["ten minutes of", "left, %", "worst, %", "within two sigma", "wrong", "heading, deg"]
    trial = ["trial", "half", "by its first half", "all", "by another trial", "by the worst trial"]
    rows = [_row(world, some) for world, some in found["simulated"].items()]
    on_broad = []
    for name, (before, after, whole, *others) in found["broad"].items():
        by = [np.median(others), max(others)] if others else [np.nan, np.nan]
        on_broad.append([name, *(f"{value:.2f}" for value in (before, after, whole, *by))])
    simulated = table(heads, rows)
    return "\n".join([_WORDS.format(n=found["devices"]), simulated, _BROAD, table(trial, on_broad)])


def _row(world: str, rows: list[dict[str, Any]]) -> list[str]:
    left, within, wrong, before, after = (np.array([r[k] for r in rows]) for k in rows[0])
    return [
        *(world, f"{100 * np.median(left):.2f}", f"{100 * left.max():.2f}"),
        *(f"{100 * within.mean():.0f} %", f"{wrong.sum()} of {9 * len(rows)}"),
        f"{np.median(before):.2f} -> {np.median(after):.2f}",
    ]


_WORDS = """\
# Scale and axes that the board finds in motion

`zerorate bench own-axes` wrote this page: {n} simulated devices a row, and nine trials of BROAD.

The filter in motion also estimates the nine entries of the matrix of scale factors and axes. The
firmware does not subtract them. This page shows what that would do. An entry is the posterior mean
under a prior of 1 %. It is shrunk by the factor 1 - its variance / the prior's variance.

| column | what it is |
| --- | --- |
| left, worst | RMS of the nine entries afterwards: median and worst device |
| within two sigma | share of the entries whose truth lies within two sigma |
| wrong | entries with an error above three sigma and 0.2 % larger than without the estimate |
| heading | degrees RMS that 6,000 samples lose, before -> after: median device |
"""
_BROAD = """\
This is the heading lost on BROAD, in degrees, as in [heading-figures.md](heading-figures.md).
"Half" is the second half of the motion, without the entries and with those of the first half. "All"
is the whole motion, without the entries and with those of another trial of the same group: median
and worst of these trials.
"""
