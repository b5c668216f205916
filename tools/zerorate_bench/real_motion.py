"""The bias at the end of a real motion beside other filters', from a first rest and cold.

zerorate bench real-motion --data FOLDER [FOLDER ...]
"""

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from numpy.typing import NDArray
from zerorate_tools.demo.broad import Trial, rms_mdps, trials
from zerorate_tools.loop.motion.by_windows import by_windows
from zerorate_tools.loop.motion.in_motion import InMotion, slots_of
from zerorate_tools.loop.motion.rate_scale import RateScale
from zerorate_tools.model import Model, build_model
from zerorate_tools.model.binding import binding_of
from zerorate_tools.peers import Given, Peer, fusion, given, vqf_default
from zerorate_tools.peers.firmware import Decision

from .heading import GROUPS, moving_in
from .tables import machine_line, number, table

STARTS = FIRST_REST, COLD = "from a first rest", "cold"
OURS, TOLD, NONE = "zerorate", "zerorate, matrix of other trials", "no correction"
#: At either end of the rest that tells the bias: a hand lets go of the part, and takes it.
LEFT_OUT_S = 2.0
#: Worse than no correction is what is so by more than both; less is noise of the truth.
WORSE, WORSE_MDPS = 1.1, 5.0
_WORDS = """\
# Bias at the end of real motion

`zerorate bench real-motion` wrote this page from {n} trials of BROAD (D. Laidig et al., CC BY
4.0), two minutes in the hand each. The error is that of the bias at the last moving sample, RMS
over the axes, in mdps. The truth is the mean rate of the rest after the motion. "From a first
rest" is the trial as it is. "Cold" begins at its first moving sample. All have their default
settings. "Worse than none" is by more than 10 % and 5 mdps. "Matrix of other trials": scale
factors and axes as `zerorate close` finds them in the other trials of the same device.
"""
_EACH = "Each trial, cold:\n"


def _none(sessions: Sequence[Given]) -> list[NDArray[np.float64]]:
    return [np.zeros_like(one.rate_dps) for one in sessions]


def ways() -> dict[str, Peer]:
    """Every way that is told nothing of the device, by its name in the tables."""
    return {OURS: Decision(), "vqf": vqf_default, "imufusion": fusion, NONE: _none}


def run(folders: Sequence[Path], advance: Callable[[float], None] = lambda n: None) -> dict:
    """Start -> way -> trial -> error, mdps. Raises ZerorateError for a folder without a trial."""
    every = {trial.name: trial for folder in folders for trial in trials(folder)}
    found: dict = {start: {way: {} for way in (OURS, TOLD, *ways())} for start in STARTS}
    shown = matrices_of(every)
    for name, trial in sorted(every.items()):
        matrix, told = _deployed(shown[name]), _model(trial, shown[name])
        truth = rest_after(trial)
        for start, part in zip(STARTS, (until_rest(trial), trial.in_motion())):
            one = given(part.recording())
            for way, peer in ways().items():
                found[start][way][name] = round(rms_mdps(peer([one])[0][-1] - truth), 1)
            bias = Decision(told)([one])[0][-1]
            found[start][TOLD][name] = round(rms_mdps(bias - (truth - matrix @ truth)), 1)
        advance(1)
    return found


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
    fields = ("rate_dps", "accel_g", "attitude", "moving")
    return replace(trial, **{name: getattr(trial, name)[: _end(trial)] for name in fields})


def _end(trial: Trial) -> int:
    return int(np.flatnonzero(trial.moving)[-1]) + 1


def in_markdown(found: Mapping) -> str:
    """The page: median, mean and worst of each way, then each trial."""
    heads = [f"{start}: {what}" for start in STARTS for what in ("median", "mean", "worst")]
    cold = found[COLD]
    of_each = [[name, *(number(row[name]) for row in cold.values())] for name in cold[OURS]]
    parts = [
        _WORDS.format(n=len(cold[OURS])),
        table(["error, mdps", *heads, "cold: worse than none"], list(_rows(found))),
        _EACH + "\n" + table(["error, mdps", *cold], of_each),
        machine_line(),
    ]
    return "\n".join(parts)


def _rows(found: Mapping) -> Iterator[list[str]]:
    none = np.array([*found[COLD][NONE].values()])
    for way in found[FIRST_REST]:
        errors = [np.array([*found[start][way].values()]) for start in STARTS]
        told = [number(of(one)) for one in errors for of in (np.median, np.mean, np.max)]
        worse = np.sum((errors[1] > WORSE * none) & (errors[1] > none + WORSE_MDPS))
        yield [way, *told, f"{worse} of {len(none)}"]
