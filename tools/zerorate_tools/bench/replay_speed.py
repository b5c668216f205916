"""Samples a second and peak memory of a replay, against the length of the recording."""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from ..errors import ZerorateError
from ..recordings.writing import recording_writer
from ..simulate import simulate

HOURS = (1, 10, 100)
_SCENARIO = "warm-up-b"
_ROWS = 60_000
_REPLAY = """
import resource, sys, time
from zerorate_tools.replay import replay
replay(sys.argv[2], sys.argv[2] + ".out.parquet")
start = time.perf_counter()
samples = replay(sys.argv[1], sys.argv[1] + ".out.parquet").samples
spent = time.perf_counter() - start
print(samples, spent, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024)
"""


def replay_speed(hours=HOURS) -> dict[str, dict[str, float]]:
    """Hours at 100 Hz -> samples_per_s and peak_bytes of a process that replays to a file.

    A short recording goes before, so that loading the compiled kernels is not in the time.
    """
    with tempfile.TemporaryDirectory(prefix="zerorate-bench-") as folder:
        first = Path(folder) / "first.parquet"
        _write(first, 0.01)
        return {str(length): _one(Path(folder) / "long.parquet", first, length) for length in hours}


def _one(path: Path, first: Path, hours: float) -> dict[str, float]:
    _write(path, hours)
    samples, seconds, peak = _measured(path, first)
    return {"samples_per_s": samples / seconds, "peak_bytes": peak}


def _write(path: Path, hours: float) -> None:
    """A simulated warm-up repeated for so long, one row group a minute or ten."""
    recording, _ = simulate(_SCENARIO, session=1, seed=1)
    columns, total = recording.columns, round(hours * 360_000)
    with recording_writer(path, list(columns), recording.scales) as writer:
        for start in range(0, total, _ROWS):
            at = np.arange(start, min(start + _ROWS, total))
            rows = {name: values[at % len(recording)] for name, values in columns.items()}
            rows["t_us"] = at * 10_000
            writer.append(rows)


def _measured(path: Path, first: Path) -> tuple[float, float, float]:
    command = [sys.executable, "-c", _REPLAY, str(path), str(first)]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        raise ZerorateError(f"the replay failed: {done.stderr.strip()[-300:]}")
    samples, seconds, peak = map(float, done.stdout.split())
    return samples, seconds, peak
