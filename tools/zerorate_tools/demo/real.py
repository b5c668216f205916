"""`demo --real`: the firmware on a real recording, against the bias that optics tell."""

from collections.abc import Callable
from dataclasses import dataclass
from importlib.util import find_spec
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..peers import first_seconds, given, vqf_default
from ..recordings import Recording
from ..replay import AT_REST_ALONE, replay
from .broad import Trial, TrueBias, rms_mdps, true_bias

WAYS = (
    "uncorrected",
    "mean of the first ten seconds",
    "vqf",
    "zerorate, from rests",
    "zerorate, in motion and by gravity too",
)
WHOLE_FROM_S, MOTION_FROM_S = 10.0, 60.0


@dataclass(frozen=True)
class Real:
    """A real trial: whole_mdps, motion_mdps: way -> RMS error over axes and time, mdps.

    whole: the trial with the rests at its ends, from 10 s on; motion: as if switched on in
    mid-motion, without any rest, from 60 s on. said: the firmware's own words after the whole
    trial, every source on.
    """

    trial: Trial
    truth: TrueBias
    whole_mdps: dict[str, float]
    motion_mdps: dict[str, float]
    said: str


def real(
    trial: Trial, runtime: str = "wasm", advance: Callable[[float], None] = lambda n: None
) -> Real:
    """Run the firmware over `trial` on `runtime` and score it. Raises MissingRuntime.

    advance: called with 1 after each of the four runs. vqf is left out where it is not installed.
    """
    truth = true_bias(trial)
    rows, said = [], ""
    for part, start_s in ((trial, WHOLE_FROM_S), (trial.in_motion(), MOTION_FROM_S)):
        recording = part.recording()
        session = [given(recording)]
        mean = first_seconds(session)[0]
        biases = {WAYS[0]: np.zeros_like(mean), WAYS[1]: mean}
        if find_spec("vqf") is not None:
            biases["vqf"] = vqf_default(session)[0]
        for way, options in zip(WAYS[3:], (AT_REST_ALONE, {})):
            done = replay(recording, runtime=runtime, options=options)
            biases[way] = _biases(done.table, recording)
            advance(1)
        said = said or done.explanation
        first = round(start_s * trial.hz)
        rows.append({way: rms_mdps(bias[first:] - truth.bias_dps) for way, bias in biases.items()})
    return Real(trial, truth, rows[0], rows[1], said)


def _biases(table: Any, recording: Recording) -> NDArray[np.float64]:
    lsb = recording.scales.gyro_lsb_per_dps
    return np.stack([table[f"bias_g{axis}"].to_numpy() for axis in "xyz"], axis=1) / lsb
