"""The worst single sample against the median one, on the x86 interpreter with viper."""

from __future__ import annotations

from statistics import median

import numpy as np

from ..runtimes import find
from ..runtimes.callgrind import callgrind_command
from .instructions import HARNESS, HEAP, firmware_package, instructions_of_samples
from .workload import CYCLE, Workload

_REPEATS = 2
_LOOKED_AT = 5


def worst_against_median(work: Workload) -> dict[str, float]:
    """worst and median, instructions of `Corrector.update`, and their ratio.

    The samples that take the longest and those about the median are found by time, under callgrind,
    whose slowness makes time nearly count instructions; those of each are then the difference
    between a run up to it and one up to the next sample, reading the frame included.
    """
    times = _times(work)
    order = np.argsort(times, kind="stable")
    middle = len(order) // 2
    worst = [_instructions(work, int(i)) for i in order[-_LOOKED_AT:]]
    usual = [_instructions(work, int(i)) for i in order[middle : middle + _LOOKED_AT]]
    found = {"worst": float(max(worst)), "median": float(median(usual))}
    return {**found, "ratio": found["worst"] / found["median"]}


def _instructions(work: Workload, sample: int) -> int:
    return instructions_of_samples(work, sample + 1) - instructions_of_samples(work, sample)


def _times(work: Workload) -> np.ndarray:
    result = find("x86").run(
        HARNESS,
        [CYCLE, 1, 1, "viper", _REPEATS],
        modules=[firmware_package().parent],
        files_in=work.files(),
        files_out=["times.bin"],
        heap=HEAP,
        check=True,
        prefix=callgrind_command(),
    )
    return np.frombuffer(result.files["times.bin"], "<i4")
