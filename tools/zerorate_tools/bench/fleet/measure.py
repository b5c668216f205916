"""Fleets of several sizes on one worker and on two, each over a folder of its own."""

import os
import tempfile
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

from ...fleet import Fleet, devices_of, fleet
from ...fleet.cluster import cluster, run_all
from .million import on_paper
from .simulated_devices import MINUTES, ODR_HZ, write_devices

SIZES = (100, 500, 2000)
WORKERS = (1, 2)
_PER_TASK = 50


def run(
    sizes: Sequence[int] = SIZES,
    workers: Sequence[int] = WORKERS,
    minutes: float = MINUTES,
    advance: Callable[[float], None] = lambda n: None,
) -> dict[str, Any]:
    """Simulate the largest fleet once, run each size on each number of workers, and reckon on.

    advance: called with devices done, of `steps(sizes, workers)` in all.
    """
    with tempfile.TemporaryDirectory(prefix="zerorate-bench-") as folder:
        data = Path(folder) / "data"
        _simulate(max(sizes), data, minutes, advance)
        size_bytes = sum(path.stat().st_size for path in data.rglob("*.parquet")) / max(sizes)
        # the first run of all compiles the kernels, which is no part of the figures
        fleet(devices_of([data])[:2], Path(folder) / "warm", workers=max(workers))
        rows, largest = [], Fleet()
        for number, count in [(n, w) for n in sizes for w in workers]:
            out = Path(folder) / f"out-{number}-{count}"
            tried = minutes if (number, count) == (sizes[-1], workers[-1]) else None
            devices = devices_of([data])[:number]
            largest = fleet(devices, out, workers=count, minutes=tried, advance=advance)
            rows.append(_row(number, count, largest, _bytes_of(out)))
    return {
        "minutes": minutes,
        "odr_hz": ODR_HZ,
        "bytes_per_recording": size_bytes,
        "scaling": rows,
        "effects": largest.report["effects"],
        "prior": largest.report["prior"]["benefit"],
        "million": on_paper(rows[-1], minutes, ODR_HZ, size_bytes),
    }


def steps(sizes: Sequence[int], workers: Sequence[int]) -> int:
    """Devices simulated and run in all."""
    return max(sizes) + len(workers) * sum(sizes)


def _simulate(number: int, data: Path, minutes: float, advance: Callable[[float], None]) -> None:
    batches = [list(range(i, min(i + _PER_TASK, number))) for i in range(0, number, _PER_TASK)]
    write = partial(write_devices, data, minutes)
    with cluster(workers=os.cpu_count()) as client:
        for batch, failure in run_all(client, write, batches):
            if failure is not None:
                raise failure
            advance(len(batch))


def _row(number: int, workers: int, done: Fleet, out_bytes: int) -> dict[str, float]:
    report = done.report
    return {
        "devices": number,
        "workers": workers,
        "tasks": done.tasks,
        "seconds": done.work_s,
        "start_s": done.start_s,
        "conclude_s": done.conclude_s,
        "busy_s": done.busy_s,
        "cpu_s": done.cpu_s,
        "overhead_share": max(0.0, 1 - done.busy_s / (workers * done.work_s)),
        "devices_per_s": number / done.work_s,
        "samples_per_s": report["samples"] / done.work_s,
        "peak_bytes": done.peak_bytes,
        "out_bytes": out_bytes,
    }


def _bytes_of(out: Path) -> int:
    return sum(path.stat().st_size for path in out.rglob("*") if path.is_file())
