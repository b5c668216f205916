"""Samples a second and peak memory of a replay of rests alone, against the recording's length."""

import tempfile
from collections.abc import Sequence
from functools import cache
from pathlib import Path

import numpy as np
from zerorate_tools.recordings import Recording
from zerorate_tools.recordings.writing import recording_writer
from zerorate_tools.simulate import simulate

from .children import in_child

HOURS = (1.0, 10.0, 100.0)
_SCENARIO = "warm-up-b"
_ROWS = 60_000
RUNS = 3
# a short recording goes before, so that loading the compiled kernels is not in the time
_REPLAY = """
from zerorate_tools.replay import replay
first, long = sys.argv[1:]
options = {"motion": False, "gravity": False}
replay(first, first + ".out.parquet", options=options)
start = time.process_time()
samples = replay(long, long + ".out.parquet", options=options).samples
print(json.dumps([samples, time.process_time() - start, spent()[1]]))
"""
_KERNELS = """
from zerorate_tools.recordings import open_recording
from zerorate_tools.replay.engines import engine
from zerorate_tools.replay.replaying import corrector_for
from zerorate_tools.replay.samples import frames_in_batches
first, long = map(open_recording, sys.argv[1:])
rests = {"motion": False, "gravity": False}
corrector, native = corrector_for(first, rests), engine("native")
list(native.run(corrector, frames_in_batches(first)))
batches, samples, took = frames_in_batches(long), 0, 0.0
for batch in batches:
    start = time.process_time()
    list(native.run(corrector, [batch]))
    took += time.process_time() - start
    samples += len(batch)
print(json.dumps([samples, took, 0]))
"""


def replay_speed(
    hours: Sequence[float] = HOURS, suffix: str = ".parquet", runs: int = RUNS
) -> dict[str, dict[str, float]]:
    """Hours at 100 Hz -> samples_per_s, kernel_samples_per_s and peak_bytes of a whole process.

    samples_per_s: recording in, Parquet out; kernel_samples_per_s: the kernels alone, frames in
    memory. Seconds are those of the processor, all threads together, the fewest of `runs`: what
    other programs take on the same machine does not count. suffix: the recording's format.
    """
    with tempfile.TemporaryDirectory(prefix="zerorate-bench-") as folder:
        first = Path(folder) / f"first{suffix}"
        write_long(first, 0.01)
        return {f"{h:g}": _one(Path(folder) / f"long{suffix}", first, h, runs) for h in hours}


def write_long(path: Path, hours: float) -> None:
    """Write a simulated warm-up repeated for so long at 100 Hz, ten minutes a batch."""
    recording = _warm_up()
    columns, total = recording.columns, round(hours * 360_000)
    with recording_writer(path, list(columns), recording.scales) as writer:
        for start in range(0, total, _ROWS):
            at = np.arange(start, min(start + _ROWS, total))
            rows = {name: values[at % len(recording)] for name, values in columns.items()}
            rows["t_us"] = at * 10_000
            writer.append(rows)


@cache
def _warm_up() -> Recording:
    return simulate(_SCENARIO, session=1, seed=1)[0]


def _one(path: Path, first: Path, hours: float, count: int) -> dict[str, float]:
    write_long(path, hours)
    runs = [in_child(_REPLAY, first, path, one_thread=True) for _ in range(count)]
    kernels = (
        [in_child(_KERNELS, first, path, one_thread=True) for _ in range(count)]
        if hours <= 1
        else []
    )
    found = {
        "samples_per_s": max(samples / seconds for samples, seconds, _ in runs),
        "peak_bytes": max(peak for _, _, peak in runs),
    }
    if kernels:
        found["kernel_samples_per_s"] = max(n / seconds for n, seconds, _ in kernels)
    return found
