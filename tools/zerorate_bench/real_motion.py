"""The bias at the end of a real motion beside other filters', from a first rest and cold."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from zerorate_tools.demo.broad import Trial, bias_in_motion, rms_mdps, trials
from zerorate_tools.loop.motion.by_windows import RateScale, by_windows
from zerorate_tools.loop.motion.scales_and_timing import InMotion, slots_of
from zerorate_tools.model import build_model
from zerorate_tools.model.model import binding_of
from zerorate_tools.peers import Peer, fusion, given, vqf_default

from .heading import moving_in, others_of
from .peers import Decision, uncorrected
from .tables import machine_line, measured, number, table

STARTS = FIRST_REST, COLD = "from a first rest", "cold"
OURS, TOLD, NONE = "zerorate", "zerorate, matrix of other trials", "no correction"
#: At either end of the rest that tells the bias: a hand lets go of the part, and takes it.
LEFT_OUT_S = 2.0
#: Shares of the motion after which a cold recording begins: where it is cut is a matter of luck.
CUT = np.arange(10) / 40
OPTICS = "optics"
#: Worse than no correction is what is so by more than both; less is noise of the truth.
WORSE, WORSE_MDPS = 1.1, 5.0
_WORDS = """\
# Bias at the end of real motion

`zerorate bench real-motion` wrote this page from {n} trials of BROAD (D. Laidig et al., CC BY
4.0), two minutes in the hand each. The error is that of the bias at the last moving sample, RMS
over the axes, in mdps. The truth is the mean rate of the rest after the motion. "From a first
rest" is the trial as it is. "Cold" begins in motion, at {starts} places of its first quarter. All
have their default settings. "Worse than none" is by more than 10 % and 5 mdps. "Matrix of other
trials": scale factors and axes as `zerorate close` finds them in the other trials of the same
device.
"""
_EACH = """\
Each trial, cold: median and worst of its {starts} starts. The last column is the bias that the
optical attitude shows over the same motion, less that of the rest after it, and its one sigma. The
part itself has another bias in motion than at rest, so no filter can be expected below that.
"""


#: Every way that is told nothing of the device, by its name in the tables.
WAYS: dict[str, Peer] = {
    OURS: Decision(),
    "vqf": vqf_default,
    "imufusion": fusion,
    NONE: uncorrected,
}


def run(data: Sequence[Path]) -> dict[str, Any]:
    """Start -> way -> trial -> errors, mdps, one for each place where it begins; under "optics"
    trial -> how far the bias in motion is from the one at rest by the optics, and its one sigma.
    Raises ZerorateError for a folder without a trial."""
    every = {trial.name: trial for folder in data for trial in trials(folder)}
    found: dict[str, Any] = {start: {way: {} for way in (OURS, TOLD, *WAYS)} for start in STARTS}
    found[OPTICS] = {}
    shown = matrices_of(every)
    for name, trial in measured(sorted(every.items())):
        end, moving, left_out = _end(trial), trial.in_motion(), round(LEFT_OUT_S * trial.hz)
        truth = trial.rate_dps[end + left_out : -left_out].mean(axis=0)
        cold = [moving.part(slice(round(s * len(moving.rate_dps)), None)) for s in CUT]
        for start, parts in zip(STARTS, ([trial.part(slice(end))], cold)):
            for way, errors in _errors(parts, truth, shown[name]).items():
                found[start][way][name] = errors
        bias, sigma = bias_in_motion(trial)
        found[OPTICS][name] = [_rounded(bias - truth), _rounded(sigma)]
    return found


def _errors(
    parts: Sequence[Trial], truth: NDArray[np.float64], shown: RateScale | None
) -> dict[str, list[float]]:
    """Way -> the error at the end of each part."""
    peers: dict[str, Peer] = {**WAYS, TOLD: Decision()}
    truths = {}
    if shown is not None:
        scales = parts[0].recording().scales
        model = build_model(slots_of(InMotion(shown)), scales, binding=binding_of(scales))
        peers[TOLD], truths[TOLD] = Decision(model), truth - shown.deployed @ truth
    return {
        way: [
            _rounded(peer([given(part.recording())])[0][-1] - truths.get(way, truth))
            for part in parts
        ]
        for way, peer in peers.items()
    }


def _rounded(error_dps: NDArray[np.float64]) -> float:
    return round(rms_mdps(error_dps), 1)


def matrices_of(every: Mapping[str, Trial]) -> dict[str, RateScale | None]:
    """Trial -> what the other trials of its device show of its matrix; None where they do not."""
    moving, shown = moving_in(every), {}
    for name in every:
        others = [moving[n] for n in others_of(name, every)]
        found = by_windows(others, []) if others else None
        shown[name] = found if found is not None and found.found else None
    return shown


def _end(trial: Trial) -> int:
    return int(np.flatnonzero(trial.moving)[-1]) + 1


def in_markdown(found: Mapping[str, Any]) -> str:
    """The page: median, mean and worst of each way, then each trial."""
    heads = [f"{start}: {what}" for start in STARTS for what in ("median", "mean", "worst")]
    cold, starts = found[COLD], len(next(iter(found[COLD][OURS].values())))
    none, rows = np.concatenate([*cold[NONE].values()]), []
    for way in found[FIRST_REST]:
        errors = [np.concatenate([*found[start][way].values()]) for start in STARTS]
        cells = [number(of(one)) for one in errors for of in (np.median, np.mean, np.max)]
        worse = np.sum((errors[1] > WORSE * none) & (errors[1] > none + WORSE_MDPS))
        rows.append([way, *cells, f"{worse} of {len(none)}"])
    each = []
    for name, (apart, sigma) in found[OPTICS].items():
        own = [row[name] for row in cold.values()]
        cells = [f"{number(np.median(row))} ({number(max(row))})" for row in own]
        each.append([name, *cells, f"{number(apart)} +-{number(sigma)}"])
    parts = [
        _WORDS.format(n=len(cold[OURS]), starts=starts),
        table(["error, mdps", *heads, "cold: worse than none"], rows),
        _EACH.format(starts=starts),
        table(["error, mdps", *cold, "in motion by the optics"], each),
        machine_line(),
    ]
    return "\n".join(parts)
