"""One simulated recording alone, or two: what is deployed, and whether it makes anything worse.

The truth is known, so the error is that of the bias itself, white noise left out, each stretch
between two steps about its own mean at rest: what was left out, at rest; the same device in the
hand; and a further power-on that nobody has seen.
"""

import tempfile
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.parquet as pq
from numpy.typing import NDArray
from scipy.stats import chi2, ncx2
from zerorate_tools.closing import load
from zerorate_tools.demo.broad import rms_mdps
from zerorate_tools.loop.fit.regression import Regression
from zerorate_tools.loop.read.sessions import Session
from zerorate_tools.loop.report.report import report
from zerorate_tools.loop.search.steps_first import bend_of
from zerorate_tools.loop.verify.firmware import Firmware
from zerorate_tools.loop.verify.run_kernels import run_and_prune
from zerorate_tools.model import Model
from zerorate_tools.recordings import Recording, open_recording, write_recording
from zerorate_tools.replay.samples import frames_in_batches
from zerorate_tools.simulate import simulate_sessions
from zerorate_tools.simulate.device import Truth

from ..tables import machine_line, outcomes
from .devices import KINDS, describe
from .figures import Figure, share
from .trials import figure_table

_WORSE, _MADE_WORSE = 1.02, "deployed and worse by more than 2 %"
#: Seconds on either side of a step in which one listed is that step.
_NEAR_S = 90.0
#: Share of recordings in which a step may be invented.
_INVENTED = 0.01
#: Seconds of a further power-on in which its turn-on offset is learned.
_LEARNED_S = 180

_Made = tuple[Recording, Truth]


@dataclass
class Single:
    """What became of one device. errors: (before, after) in mdps by where it was judged; kept:
    effects deployed; steps: true ones, listed: of those; invented: steps that are none; tellable:
    the chance that who knows the noise lists the first step, None where there is none."""

    kind: str
    seed: int
    recordings: int
    errors: dict[str, tuple[float, float]]
    kept: list[str]
    steps: int
    listed: int
    invented: int
    tellable: float | None = None

    def worse(self, where: str) -> bool:
        """Whether what was deployed makes the error larger by more than 2 % there."""
        before, after = self.errors.get(where, (1.0, 1.0))
        return bool(self.kept) and after > _WORSE * before


def look_at_single(seed: int) -> Single:
    """Simulate a device, close its recordings, and judge by the truth."""
    described, kind, recordings = describe(seed)
    *made, further = list(simulate_sessions(described, seed=seed))
    with tempfile.TemporaryDirectory() as folder:
        logs = [Path(folder) / f"power-on-{i + 1}.parquet" for i in range(recordings)]
        for log, (recording, _) in zip(logs, made):
            write_recording(recording, log)
        corrected = Path(folder) / "corrected.parquet"
        analysis, model = run_and_prune(load([*logs]), logs, corrected)
        said = report(analysis)
        errors = _held_out(corrected, logs, made, described)
        errors["a further power-on"] = _further(model, logs, further)
    true = [e for e in described["effect"] if e["kind"] == "step" and _took_place(e, made)]
    near = [_is_near(event, true, logs, made) for event in said["events"]]
    kept = [step["effect"] for step in said["steps"]]
    listed, invented = min(len(true), sum(near)), len(near) - sum(near)
    chance = tellable(analysis.sessions[true[0]["session"] - 1], true[0]) if true else None
    return Single(kind, seed, recordings, errors, kept, len(true), listed, invented, chance)


def tellable(session: Session, step: dict[str, Any]) -> float:
    """The chance that a step of the bias is listed by who knows level and colour of the noise
    beside it, where one in a hundred recordings may have one invented: all its places are tried."""
    session = replace(session, steps=())  # else the very step that was listed is beside it
    regression, bend = Regression([session]), bend_of(session)
    regression.settle(bend)
    base, [whitener] = regression.fit(bend).base, regression.whiteners
    after = np.arange(session.blocks) >= step["at_s"] / session.block_s
    column = whitener.prepare(after.astype(float)[:, None])
    beside, cross, alone = whitener.products(regression.stack(bend)[0], column, 1)
    size = 0.0  # in its standard deviations, squared
    for axis, colour in enumerate(base.best):
        left = cross[colour, 0] @ np.linalg.pinv(beside[colour]) @ cross[colour, 0]
        size += step["dps"][axis] ** 2 * (alone[colour, 0, 0, 0] - left) / base.variance[axis]
    return float(ncx2.sf(chi2.isf(_INVENTED / session.blocks, 3), 3, size))


def _is_near(
    event: dict[str, Any], true: list[dict[str, Any]], logs: list[Path], made: list[_Made]
) -> bool:
    at = [log.stem for log in logs].index(event["recording"].split(".")[0])
    seconds = (event["t_us"] - made[at][1].t_us[0]) / 1e6
    return any(e["session"] == at + 1 and abs(e["at_s"] - seconds) < _NEAR_S for e in true)


def _took_place(step: dict[str, Any], made: list[_Made]) -> bool:
    """Whether the recording went on until the step: how long a power-on is, is drawn, too."""
    truth = made[step["session"] - 1][1]
    return bool(step["at_s"] < (truth.t_us[-1] - truth.t_us[0]) / 1e6)


def _held_out(
    path: Path, logs: list[Path], made: list[_Made], described: dict[str, Any]
) -> dict[str, tuple[float, float]]:
    """(before, after) mdps at rest and in motion, over the samples that were left out."""
    table = pq.read_table(path)
    names, split = (np.array(table[c].to_pylist()) for c in ("recording", "split"))
    parts: dict[str, list[list[NDArray[np.float64]]]] = {"at rest": [], "in motion": []}
    for i, (log, (_, truth)) in enumerate(zip(logs, made)):
        own = names == log.name
        rows = np.searchsorted(truth.t_us, np.array(table["t_us"])[own])
        held, still = split[own] == "test", truth.still[rows]
        edges = [e["at_s"] for e in described["effect"] if e.get("session") == i + 1]
        stretch = np.searchsorted(edges, (truth.t_us[rows] - truth.t_us[0]) / 1e6)
        both = []
        for way in ("before", "after"):
            said = np.column_stack([np.array(table[f"bias_{way}_g{a}"])[own] for a in "xyz"])
            both.append((said - truth.bias_lsb[rows]) / 131.0)
        for where, there in (("at rest", held & still), ("in motion", held & ~still)):
            if there.any():
                parts[where].append(_about(both, stretch, still & held, there))
    return {
        where: (rms_mdps(np.vstack(before)), rms_mdps(np.vstack(after)))
        for where, some in parts.items()
        if some
        for before, after in [zip(*some)]
    }


def _about(
    both: list[np.ndarray], stretch: np.ndarray, rest: np.ndarray, scored: np.ndarray
) -> list[NDArray[np.float64]]:
    """Errors before and after, each stretch about its own mean at rest."""
    level = np.zeros_like(both)
    for s in np.unique(stretch[rest]):
        level[:, stretch == s] = np.mean([e[rest & (stretch == s)] for e in both], 1, keepdims=True)
    return [*(both - level)[:, scored]]


def _further(model: Model, logs: list[Path], further: _Made) -> tuple[float, float]:
    """(before, after) mdps over a power-on that nobody saw, by a firmware that has lived through
    the recordings and learns no more than the first minutes of this one."""
    recording, truth = further
    errors: list[float] = []
    for own in (None, model if model.slots else None):
        device = Firmware(recording.scales, own)
        for log in logs:
            device.power_on()
            for frames in frames_in_batches(open_recording(log)):
                device.run(frames)
        device.power_on()
        last_us = recording.columns["t_us"][0] + 1e6 * _LEARNED_S
        parts = [device.run(f, f.t_us < last_us) for f in frames_in_batches(recording)]
        bias = np.vstack(parts) / 256.0
        error = (bias - truth.bias_lsb) / recording.scales.gyro_lsb_per_dps
        error = error[truth.t_us - truth.t_us[0] > 1e6 * _LEARNED_S]
        errors.append(rms_mdps(error))
    return errors[0], errors[1]


def single_figures(singles: list[Single]) -> list[Figure]:
    """Shares made worse, and of steps listed and invented."""
    rows = [
        share(f"{_MADE_WORSE}, {where}", singles, partial(Single.worse, where=where), 1.0, True)
        for where in ("at rest", "in motion", "a further power-on")
    ]
    for kind, what, limit in (("step", "RMS", 95.0), ("small step", "jump", None)):
        own = [s for s in singles if s.kind == kind and s.steps]
        rows.append(share(f"steps of 3 floors {what} listed", own, lambda s: bool(s.listed), limit))
        chances = [s.tellable for s in own if s.tellable is not None]
        most = 100.0 * float(np.mean(chances)) if chances else float("nan")
        name = f"steps of 3 floors {what}: who knows the noise lists"
        rows.append(Figure(name, most, None, True, len(chances)))
    rows.append(share("a step invented", singles, lambda s: s.invented > 0, 1.0, True))
    for kind in KINDS:
        own = [s for s in singles if s.kind == kind]
        rows.append(share(f"{kind}: deployed anything", own, lambda s: bool(s.kept), None))
        for where in ("at rest", "a further power-on") if own else ():
            ratio = [np.divide(*s.errors[where][::-1]) for s in own]
            name = f"{kind}: error after over before, {where}, mean"
            rows.append(Figure(name, float(np.mean(ratio)), None, True, len(own), unit="x"))
    return rows


def run(devices: int, processes: int, resume: Path | None) -> dict[str, Any]:
    """So many devices, of every kind alike: their figures, and what became of each, as plain
    values. resume: as of `outcomes`."""
    each = list(outcomes(look_at_single, range(devices), processes, resume))
    singles = [Single(**row) for row in each]
    figures = [f.to_dict() for f in single_figures(singles)]
    return {"devices": devices, "figures": figures, "each": each}


def in_markdown(result: dict[str, Any]) -> str:
    """The figures as Markdown."""
    lines = [f"# One recording or two, of {result['devices']} simulated devices", ""]
    lines += ["`zerorate bench singles` wrote this page. " + machine_line(), ""]
    return "\n".join([*lines, figure_table(result["figures"])])
