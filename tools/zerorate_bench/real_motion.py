"""The bias at the end of a real motion beside other filters', from a first rest and cold.

zerorate bench real-motion --data FOLDER [FOLDER ...]
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from numpy.typing import NDArray
from zerorate_tools.demo.broad import Trial, bias_in_motion, rms_mdps, trials
from zerorate_tools.loop.motion.by_windows import RateScale, by_windows
from zerorate_tools.loop.motion.scales_and_timing import InMotion, slots_of
from zerorate_tools.model import Model, build_model
from zerorate_tools.model.model import binding_of
from zerorate_tools.peers import Peer, fusion, given, vqf_default

from .heading import GROUPS, moving_in
from .peers import Decision, uncorrected
from .tables import machine_line, number, table

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


def ways() -> dict[str, Peer]:
    """Every way that is told nothing of the device, by its name in the tables."""
    return {OURS: Decision(), "vqf": vqf_default, "imufusion": fusion, NONE: uncorrected}


def run(data: Sequence[Path], advance: Callable[[float], None] = lambda n: None) -> dict[str, Any]:
    """Start -> way -> trial -> errors, mdps, one for each place where it begins; under "optics"
    trial -> how far the bias in motion is from the one at rest by the optics, and its one sigma.
    Raises ZerorateError for a folder without a trial."""
    every = {trial.name: trial for folder in data for trial in trials(folder)}
    found: dict[str, Any] = {start: {way: {} for way in (OURS, TOLD, *ways())} for start in STARTS}
    found[OPTICS] = {}
    shown = matrices_of(every)
    for name, trial in sorted(every.items()):
        begun = [until_rest(trial)], [_begun(trial.in_motion(), share) for share in CUT]
        for start, parts in zip(STARTS, begun):
            for way, errors in _errors(parts, rest_after(trial), shown[name]).items():
                found[start][way][name] = errors
        bias, sigma = bias_in_motion(trial)
        found[OPTICS][name] = [_rounded(bias - rest_after(trial)), _rounded(sigma)]
        advance(1)
    return found


def _begun(trial: Trial, share: float) -> Trial:
    return trial.part(slice(round(share * len(trial.rate_dps)), None))


def _errors(
    parts: Sequence[Trial], truth: NDArray[np.float64], shown: RateScale | None
) -> dict[str, list[float]]:
    """Way -> the error at the end of each part."""
    matrix, with_matrix = _deployed(shown), _model(parts[0], shown)
    peers: dict[str, Peer] = {**ways(), TOLD: Decision(with_matrix)}
    truths = {TOLD: truth - matrix @ truth}
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
    with TemporaryDirectory() as scratch:
        moving = {n: moving_in(t, Path(scratch) / f"{n}.parquet") for n, t in every.items()}
    shown = {}
    for name in every:
        group = next((g for g in GROUPS if name[:2] in g), ())
        others = [moving[n] for n in every if n != name and n[:2] in group]
        found = by_windows(others, []) if others else None
        shown[name] = found if found is not None and found.found else None
    return shown


def _deployed(shown: RateScale | None) -> NDArray[np.float64]:
    return np.zeros((3, 3)) if shown is None else shown.deployed


def _model(trial: Trial, shown: RateScale | None) -> Model | None:
    if shown is None:
        return None
    scales = trial.recording().scales
    return build_model(slots_of(InMotion(shown)), scales, binding=binding_of(scales))


def rest_after(trial: Trial) -> NDArray[np.float64]:
    """Mean rate (3,) of the rest after the motion, dps."""
    left_out = round(LEFT_OUT_S * trial.hz)
    return trial.rate_dps[_end(trial) + left_out : -left_out].mean(axis=0)


def until_rest(trial: Trial) -> Trial:
    """The trial from its first sample to the last moving one."""
    return trial.part(slice(_end(trial)))


def _end(trial: Trial) -> int:
    return int(np.flatnonzero(trial.moving)[-1]) + 1


def in_markdown(found: Mapping[str, Any]) -> str:
    """The page: median, mean and worst of each way, then each trial."""
    heads = [f"{start}: {what}" for start in STARTS for what in ("median", "mean", "worst")]
    starts = len(next(iter(found[COLD][OURS].values())))
    parts = [
        _WORDS.format(n=len(found[COLD][OURS]), starts=starts),
        table(["error, mdps", *heads, "cold: worse than none"], list(_rows(found))),
        _EACH.format(starts=starts),
        table(["error, mdps", *found[COLD], "in motion by the optics"], list(_each(found))),
        machine_line(),
    ]
    return "\n".join(parts)


def _each(found: Mapping[str, Any]) -> Iterator[list[str]]:
    for name, (apart, sigma) in found[OPTICS].items():
        rows = [row[name] for row in found[COLD].values()]
        cells = [f"{number(np.median(row))} ({number(max(row))})" for row in rows]
        yield [name, *cells, f"{number(apart)} +-{number(sigma)}"]


def _rows(found: Mapping[str, Any]) -> Iterator[list[str]]:
    none = np.concatenate([*found[COLD][NONE].values()])
    for way in found[FIRST_REST]:
        errors = [np.concatenate([*found[start][way].values()]) for start in STARTS]
        cells = [number(of(one)) for one in errors for of in (np.median, np.mean, np.max)]
        worse = np.sum((errors[1] > WORSE * none) & (errors[1] > none + WORSE_MDPS))
        yield [way, *cells, f"{worse} of {len(none)}"]
