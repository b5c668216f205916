"""What the cost benchmarks run: one motion-and-rest cycle in the middle of a simulated warm-up."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from zerorate_tools.replay.engines import engine
from zerorate_tools.replay.replaying import corrector_for
from zerorate_tools.replay.samples import frames_in_batches
from zerorate_tools.simulate import simulate

SCENARIO = "warm-up-b"
#: Options of the rest path alone, as a board has it that was sent nothing else.
REST: dict[str, object] = {"motion": False, "gravity": False}
CYCLE = 6000
_BEFORE = 120_000


@dataclass(frozen=True)
class Workload:
    """Frames (n, 8) int32 of dt_us and seven words, the settings, and the state they start from."""

    rows: NDArray[np.int32]
    settings: NDArray[np.int32]
    state: NDArray[np.int32]


def workload(samples: int = 2 * CYCLE) -> Workload:
    """`samples` frames after twenty minutes of warming, when every estimator is in use."""
    recording, _ = simulate(SCENARIO, session=1, seed=1)
    corrector = corrector_for(recording, REST)
    batches = list(frames_in_batches(recording, rows=_BEFORE))
    for _ in engine("native").run(corrector, batches[:1]):
        pass
    rows = np.c_[batches[1].dt_us, batches[1].frames].astype(np.int32)
    words = (np.array(of, np.int32) for of in (corrector.settings, corrector.state))
    return Workload(rows[:samples], *words)
