"""The worst single sample against the median one, on the x86 interpreter with viper."""

from __future__ import annotations

import numpy as np

from ..runtimes import find
from ..runtimes.callgrind import callgrind_command
from .instructions import HARNESS, HEAP, firmware_package
from .workload import CYCLE, Workload

_REPEATS = 3


def worst_against_median(work: Workload) -> dict[str, float]:
    """worst_us, median_us and their ratio; each sample's time is its fewest of some runs.

    It runs under callgrind, whose slowness makes time count instructions and the clock fine enough.
    What one run adds to one sample (another process, a collection) so does not count.
    """
    args = [CYCLE, 1, "viper", _REPEATS]
    result = find("x86").run(
        HARNESS,
        args,
        modules=[firmware_package().parent],
        files_in=work.files(),
        files_out=["times.bin"],
        heap=HEAP,
        check=True,
        prefix=callgrind_command(),
    )
    times = np.frombuffer(result.files["times.bin"], "<i4")
    worst, median = float(times.max()), float(np.median(times))
    return {"worst_us": worst, "median_us": median, "ratio": worst / median}
