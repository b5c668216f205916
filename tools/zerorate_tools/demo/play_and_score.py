"""`demo`: plays a recording through chip, bus, driver and firmware, and says what it gained."""

from dataclasses import dataclass
from os import PathLike
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..recordings import Recording, read_recording
from ..replay import AT_REST_ALONE, replay
from ..runtimes import find
from .play import play
from .score import Score, score


@dataclass(frozen=True)
class Demo:
    """What a demo showed.

    said: what the MicroPython printed; same_state: the firmware's final state equals, to the last
    bit, that of a replay on this host; bias_dps, corrected_dps: (n, 3); truth_dps: the true bias
    where the recording was simulated.
    """

    recording: Recording
    runtime: str
    said: str
    same_state: bool
    bias_dps: NDArray[np.float64]
    corrected_dps: NDArray[np.float64]
    truth_dps: NDArray[np.float64] | None
    score: Score


def demo(
    log: str | PathLike[str] | Recording,
    runtime: str = "wasm",
    *,
    truth_dps: NDArray[np.float64] | None = None,
    model: Path | None = None,
    learned: Path | None = None,
) -> Demo:
    """Play `log` on `runtime` and score it.

    truth_dps: (n, 3) the true bias; without it the device must rest throughout, as its true rate
    is taken for zero. model: an effect model to load; learned: a state to start from, as `replay`
    writes it. Raises ZerorateError (BadRecording, MissingRuntime).
    """
    interpreter = find(runtime)
    recording = log if isinstance(log, Recording) else read_recording(log, keep_gaps=True)
    played = play(recording, interpreter, model=model, learned=learned)
    here = replay(recording, model=model, from_state=learned, options=AT_REST_ALONE)
    return Demo(
        recording=recording,
        runtime=interpreter.name,
        said=played.said,
        same_state=played.state == here.state,
        bias_dps=played.bias_dps,
        corrected_dps=played.corrected_dps,
        truth_dps=truth_dps,
        score=score(recording, played.bias_dps, truth_dps),
    )
