"""Guest instructions that a sample costs in each source that needs no rest, as viper on x86."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ..replay.jit import firmware_package
from ..replay.samples import FRAME
from ..runtimes import find
from ..runtimes.callgrind import instructions
from ..simulate import simulate

_SCRIPT = Path(__file__).with_name("source_on_interpreter.py")
# a minute of motion: by then windows are at their longest, and one is worked on every eight seconds
_FROM, _TO = 4000, 7200


def source_cost() -> dict[str, float]:
    """in_motion, realtime -> instructions a sample. Raises MissingRuntime."""
    recording, _ = simulate("never-rests", session=1, seed=1)
    frames = np.stack([recording.columns[name][:_TO] for name in FRAME], axis=1)
    how = {
        "modules": [firmware_package().parent],
        "files_in": {"frames.bin": frames.astype("<i4").tobytes()},
        "heap": 4 << 20,
    }

    def spent(source: str) -> int:
        runtime = find("x86")
        counts = [instructions(runtime, _SCRIPT, [n, source], **how) for n in (_FROM, _TO)]
        return counts[1] - counts[0]

    loop = spent("nothing")
    return {source: (spent(source) - loop) / (_TO - _FROM) for source in ("in_motion", "realtime")}
