"""Bias without rest: both sources and the decision beside vqf, simulated and on BROAD.

python -m zerorate_tools.bench.motion --data FOLDER/broad --json motion.json
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Mapping, Sequence
from os import PathLike
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..recordings.atomic import written_beside
from ..simulate import simulate
from .broad import Trial, TrueBias, trials, true_bias
from .peers import Given, Peer, firmware, given, vqf_clip_raised, vqf_default
from .peers.sources import Source

SCENARIOS = ("never-rests", "rests-30", "turntable", "car")
SETTLED_S = 120.0
TRIAL_SETTLED_S = 60.0


def peers() -> dict[str, Peer]:
    """Every way that is measured, by its name in the tables."""
    return {
        "vqf": vqf_default,
        "vqf, clip 25 dps": vqf_clip_raised,
        "in motion, the document's own form": Source("in_motion", document=True),
        "in motion": Source("in_motion"),
        "in motion, bias within 0.5 dps as vqf assumes": Source("in_motion", start_dps=0.5),
        "accelerometer, the document's own form": Source(
            "realtime", document=True, coarse_dps=0.05, threshold=0
        ),
        "accelerometer": Source("realtime"),
        "decision": firmware(motion=True),
    }


def simulated(ways: Mapping[str, Peer], seconds: float = 600.0, seed: int = 1) -> dict:
    """Scenario -> way -> RMS error after two minutes, mdps; for a source also what it learned."""
    found: dict = {}
    for name in SCENARIOS:
        recording, truth = simulate(name, session=1, seed=seed)
        count = round(seconds * recording.scales.odr_hz)
        one = _shortened(given(recording), count)
        bias = (truth.bias_lsb / recording.scales.gyro_lsb_per_dps)[:count]
        after = round(SETTLED_S * one.odr_hz)
        found[name] = {}
        for way, peer in ways.items():
            row = _measured(peer, one, bias)
            error = row.pop("error_dps")[after:]
            found[name][way] = {"rms_mdps": _rms_mdps(error), **row}
    return found


def on_broad(ways: Mapping[str, Peer], folder: Path) -> dict:
    """trials: each one's true bias; whole, motion: way -> errors per trial and axis, mdps."""
    found: dict = {"trials": {}, "whole": {w: {} for w in ways}, "motion": {w: {} for w in ways}}
    for trial in trials(folder):
        truth = true_bias(trial)
        found["trials"][trial.name] = _described(truth)
        for part, cut in (("whole", trial), ("motion", trial.in_motion())):
            for way, peer in ways.items():
                found[part][way][trial.name] = _on_trial(peer, cut, truth)
    return found


def _on_trial(peer: Peer, trial: Trial, truth: TrueBias) -> dict:
    one = given(trial.recording())
    row = _measured(peer, one, np.tile(truth.bias_dps, (len(one.rate_dps), 1)))
    error = row.pop("error_dps")[round(TRIAL_SETTLED_S * trial.hz) :]
    return {"rms_mdps": [_rms_mdps(error[:, axis]) for axis in range(3)], **row}


def _measured(peer: Peer, one: Given, bias: NDArray[np.float64]) -> dict:
    if isinstance(peer, Source):
        peer.truth_dps = [bias]
    error = peer([one])[0] - bias
    if not isinstance(peer, Source):
        return {"error_dps": error}
    inside = float(np.mean(peer.within)) if peer.within else None
    return {"error_dps": error, "learned": peer.learned, "within_two_sigma": inside}


def _shortened(one: Given, count: int) -> Given:
    recording = one.recording
    columns = {name: values[:count] for name, values in recording.columns.items()}
    return given(type(recording)(columns, recording.scales, recording.name))


def _described(truth: TrueBias) -> dict:
    return {name: np.round(value, 5).tolist() for name, value in vars(truth).items()}


def _rms_mdps(error_dps: NDArray[np.float64]) -> float:
    return round(float(np.sqrt(np.mean(np.square(error_dps)))) * 1000, 1)


def table(found: Mapping) -> str:
    """Both tables as Markdown."""
    lines = ["Simulated, RMS error after two minutes, mdps (windows learned):", ""]
    lines += _head(["", *found["simulated"]])
    for way in next(iter(found["simulated"].values())):
        cells = [_cell(rows[way]) for rows in found["simulated"].values()]
        lines.append(f"| {way} | " + " | ".join(cells) + " |")
    if "broad" in found:
        lines += ["", *_broad_lines(found["broad"])]
    return "\n".join(lines)


def _cell(row: Mapping) -> str:
    learned = f" ({row['learned']})" if "learned" in row else ""
    return f"{row['rms_mdps']:.0f}{learned}"


def _broad_lines(broad: Mapping) -> list[str]:
    lines = ["BROAD, RMS error after one minute, mdps: median over trials and axes (mean):", ""]
    lines += _head(["", "whole trial", "its motion alone", "motion: truth within 2 sigma"])
    for way in broad["whole"]:
        cells = []
        for part in ("whole", "motion"):
            errors = [x for row in broad[part][way].values() for x in row["rms_mdps"]]
            cells.append(f"{np.median(errors):.0f} ({np.mean(errors):.0f})")
        inside = [row.get("within_two_sigma") for row in broad["motion"][way].values()]
        known = [x for x in inside if x is not None]
        cells.append(f"{100 * np.mean(known):.0f} %" if known else "")
        lines.append(f"| {way} | " + " | ".join(cells) + " |")
    lines += ["", "True bias by the optical attitude, dps:", ""]
    lines += _head(["trial", "bias", "one sigma", "by its motion alone", "one sigma"])
    for name, truth in broad["trials"].items():
        columns = ("bias_dps", "sigma_dps", "motion_dps", "motion_sigma_dps")
        cells = [" ".join(f"{x:.3f}" for x in truth[column]) for column in columns]
        lines.append(f"| {name} | " + " | ".join(cells) + " |")
    return lines


def _head(cells: Sequence[str]) -> list[str]:
    return ["| " + " | ".join(cells) + " |", "|" + "---|" * len(cells)]


def run(
    data: str | PathLike[str] | None = None, json_path: str | PathLike[str] | None = None
) -> dict:
    """Measure and return all figures; with json_path write them too.

    data: the folder of BROAD's .mat files; without it only the simulated table is made.
    """
    ways = peers()
    found: dict = {"simulated": simulated(ways)}
    if data is not None:
        found["broad"] = on_broad(ways, Path(data))
    if json_path is not None:
        with written_beside(Path(json_path)) as temporary:
            temporary.write_text(json.dumps(found, indent=2) + "\n")
    return found


def main() -> None:
    """Read the arguments and run."""
    parser = argparse.ArgumentParser(description="bias without rest, beside vqf")
    parser.add_argument("--data", metavar="FOLDER", help="BROAD's .mat files")
    parser.add_argument("--json", metavar="FILE")
    arguments = parser.parse_args()
    print(table(run(arguments.data, arguments.json)))


if __name__ == "__main__":
    main()
