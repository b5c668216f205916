"""`zerorate bench fleet`: how it scales, what a prior is worth, and a million devices on paper."""

import os
import tempfile
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from zerorate_tools.fleet import Fleet, devices_of, fleet
from zerorate_tools.fleet.cluster import MOST_BYTES, MOST_DEVICES, MOST_WAITING, cluster, run_all
from zerorate_tools.fleet.first_minutes import LEAST_DEVICES
from zerorate_tools.fleet.fleet_in_words import WAYS, scenario_in_words
from zerorate_tools.recordings import write_recording
from zerorate_tools.simulate import simulate

from .tables import machine_line, table

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


def in_markdown(found: dict[str, Any]) -> str:
    """Scaling, the prior's worth, and a million devices."""
    length = (
        f"Each device has one recording of {found['minutes']:g} minutes at {found['odr_hz']:g} Hz "
        f"({found['bytes_per_recording'] / 1e3:.0f} kB of Parquet), simulated; `seconds` are those "
        "of the replays, without the cluster's start and the report at the end."
    )
    parts = ["# Fleet", machine_line(), "## Scaling", length, _scaling(found["scaling"])]
    prior = found["prior"]
    few = f"Not tried: it takes {LEAST_DEVICES} devices."
    tried = [_about(prior), _prior(prior)] if prior else [few]
    parts += ["## A prior for a new device", *tried]
    parts += ["## A million devices, on paper", _million(found["million"])]
    return "\n\n".join(part.strip() for part in parts) + "\n"


def _scaling(rows: list[dict[str, float]]) -> str:
    header = (
        *("devices", "workers", "tasks", "devices a task", "seconds", "devices/s"),
        *("million samples/s", "CPU ms a device", "idle or overhead", "peak MB a worker"),
        *("start s", "report and prior s"),
    )
    cells = [
        (
            *(f"{r['devices']:g}", f"{r['workers']:g}", f"{r['tasks']:g}"),
            *(f"{r['devices'] / r['tasks']:.1f}", f"{r['seconds']:.1f}"),
            *(f"{r['devices_per_s']:.1f}", f"{r['samples_per_s'] / 1e6:.2f}"),
            *(f"{1e3 * r['cpu_s'] / r['devices']:.1f}", f"{r['overhead_share']:.1%}"),
            *(f"{r['peak_bytes'] / 1e6:.0f}", f"{r['start_s']:.1f}", f"{r['conclude_s']:.1f}"),
        )
        for r in rows
    ]
    return table(header, cells)


def _about(tried: dict[str, Any]) -> str:
    return (
        f"Error of the firmware's bias in the first {tried['minutes']:g} minutes of "
        f"{tried['devices']} devices, each left out of the prior that it starts from "
        f"({tried['folds']} priors, each from the other four fifths of the fleet): RMS over axes "
        "in mdps, median over devices and 95th percentile."
    )


def _prior(tried: dict[str, Any]) -> str:
    rows = []
    for name, found in tried["scenarios"].items():
        for way, words in WAYS.items():
            if way in found:
                median, p95 = found[way]["median_mdps"], found[way]["p95_mdps"]
                rows.append((scenario_in_words(name), words, f"{median:.4g}", f"{p95:.4g}"))
        gain, (low, high) = found["gain"]["median_mdps"], found["gain"]["ci95_mdps"]
        better = f"{gain:.4g} ({low:.4g} to {high:.4g})"
        rows.append(("", "gain by the prior, 95 %", better, f"{found['gain']['share_better']:.0%}"))
    header = ("device", "start", "median", "95th percentile (of gain: share better)")
    return table(header, rows)


def _million(m: dict[str, Any]) -> str:
    return (
        f"{m['devices']:,} devices with {m['hours_a_device']:g} hour each at {m['odr_hz']:g} Hz "
        f"take {m['cpu_s_a_device']:.2f} s of a core each: on {m['cores']} cores {m['hours']:.1f} "
        f"hours. The recordings are {m['recordings_bytes'] / 1e12:.2f} TB of Parquet, the results "
        f"{m['results_bytes'] / 1e9:.1f} GB. A task takes up to {m['devices_per_task']} devices or "
        f"64 MiB, so there are {m['tasks']:,} tasks of {m['seconds_a_task']:.0f} s, "
        f"{m['tasks_per_s']:.2f} a second; Dask's scheduler spends about a millisecond on each, "
        f"{m['scheduler_share']:.2%} of its time, and holds no more than {m['most_waiting']:,} of "
        "them, for the rest waits in the client. One task a device would be "
        f"{m['devices']:,} tasks, {m['devices'] * 1e-3 / m['hours'] / 3600:.1%} of its time."
    )
