"""Fleets of several sizes on one worker and on two, each over a folder of its own."""

import os
import tempfile
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from ...fleet import Fleet, devices_of, fleet
from ...fleet.cluster import MOST_BYTES, MOST_DEVICES, MOST_WAITING, cluster, run_all
from ...recordings import write_recording
from ...simulate import simulate

SIZES = (100, 500, 2000)
WORKERS = (1, 2)
_PER_TASK = 50

#: The fleet on paper.
DEVICES = 1_000_000
HOURS_A_DEVICE = 1.0
CORES = 64
#: Dask's own measure of what its scheduler spends on a task, and keeps of one: about 1 ms (up to
#: 0.2 ms at best) and some kilobytes (distributed documentation, "Scheduling overhead").
SCHEDULER_S_A_TASK = 1e-3
#: Typical of an MPU-6050: devices differ in level by far more than in how they follow temperature.
LEVEL_DPS, LEVEL_DEVIATION_DPS = (0.4, -0.9, 0.2), 1.0
SLOPE_DPS_PER_DEGC, SLOPE_DEVIATION = (0.025, -0.018, 0.012), 0.006
BEND_DPS_PER_DEGC2, BEND_DEVIATION = (3e-4, -2e-4, 1e-4), 5e-5
MINUTES = 3.0
ODR_HZ = 25.0


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
            size = sum(path.stat().st_size for path in out.rglob("*") if path.is_file())
            rows.append(_row(number, count, largest, size))
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


def on_paper(row: dict[str, float], minutes: float, odr_hz: float, size_bytes: float) -> dict:
    """Cores, hours, storage and tasks for a million devices with an hour each at this rate.

    row: of the largest run measured. A device's cost is taken to grow with its samples, which
    overstates it, for opening files does not.
    """
    times = HOURS_A_DEVICE * 60 / minutes
    cpu_s = row["cpu_s"] / row["devices"] * times
    recording_bytes = size_bytes * times
    per_task = max(1, min(MOST_DEVICES, int(MOST_BYTES // recording_bytes)))
    tasks = -(-DEVICES // per_task)
    hours = DEVICES * cpu_s / CORES / 3600
    return {
        "devices": DEVICES,
        "hours_a_device": HOURS_A_DEVICE,
        "odr_hz": odr_hz,
        "cores": CORES,
        "cpu_s_a_device": cpu_s,
        "hours": hours,
        "recordings_bytes": DEVICES * recording_bytes,
        "results_bytes": DEVICES * row["out_bytes"] / row["devices"],
        "devices_per_task": per_task,
        "tasks": tasks,
        "seconds_a_task": per_task * cpu_s,
        "tasks_per_s": tasks / (hours * 3600),
        "scheduler_share": tasks * SCHEDULER_S_A_TASK / (hours * 3600),
        "most_waiting": MOST_WAITING,
    }


def write_devices(folder: Path, minutes: float, numbers: Iterable[int]) -> None:
    """Write `device=NUMBER/session-1.parquet` for each: a warm-up by 12 degC, at rest."""
    for number in numbers:
        home = folder / f"device={number:05d}"
        home.mkdir(parents=True)
        recording, _ = simulate(description(number, minutes))
        write_recording(recording, home / "session-1.parquet")


def description(number: int, minutes: float = MINUTES) -> dict[str, Any]:
    """Device `number` of the part, as `zerorate simulate` takes it."""
    rng = np.random.default_rng(number)

    def own(mean: tuple[float, ...], deviation: float) -> list[float]:
        return (np.array(mean) + deviation * rng.standard_normal(3)).tolist()

    start = float(rng.uniform(20, 26))
    return {
        "name": "session-1",
        "seed": number,
        "sensor": {"odr_hz": ODR_HZ, "gyro_noise_dps": 0.05, "gyro_noise_at_hz": 100.0},
        "bias": {
            "b0": own(LEVEL_DPS, LEVEL_DEVIATION_DPS),
            "b1": own(SLOPE_DPS_PER_DEGC, SLOPE_DEVIATION),
            "b2": own(BEND_DPS_PER_DEGC2, BEND_DEVIATION),
        },
        "noise": {"bias_instability_dps": 0.002},
        "every_session": {
            "start_degc": start,
            "temperature": [{"to": start + 12.0, "tau_s": 60.0, "minutes": minutes}],
        },
    }
