"""`zerorate bench fleet`: how it scales, and what a prior is worth."""

import os
import tempfile
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from zerorate_tools.fleet import Fleet, devices_of, fleet
from zerorate_tools.fleet.cluster import cluster, run_all
from zerorate_tools.fleet.fleet_in_words import scenario_in_words
from zerorate_tools.fleet.prior import LEAST_DEVICES, WAYS
from zerorate_tools.recordings import write_recording
from zerorate_tools.simulate import simulate

from .tables import machine_line, table

WORKERS = (1, 2)
_PER_TASK = 50

#: Typical of an MPU-6050: devices differ in level by far more than in how they follow temperature.
LEVEL_DPS, LEVEL_DEVIATION_DPS = (0.4, -0.9, 0.2), 1.0
SLOPE_DPS_PER_DEGC, SLOPE_DEVIATION = (0.025, -0.018, 0.012), 0.006
BEND_DPS_PER_DEGC2, BEND_DEVIATION = (3e-4, -2e-4, 1e-4), 5e-5
MINUTES = 3.0
ODR_HZ = 25.0


def run(devices: Sequence[int], advance: Callable[[float], None]) -> dict[str, Any]:
    """Simulate the largest fleet once, run each size on each number of workers, and reckon on.

    advance: called with devices done, of `steps(devices)` in all.
    """
    sizes = sorted(devices)
    with tempfile.TemporaryDirectory(prefix="zerorate-bench-") as folder:
        data = Path(folder) / "data"
        _simulate(max(sizes), data, advance)
        size_bytes = sum(path.stat().st_size for path in data.rglob("*.parquet")) / max(sizes)
        # the first run of all compiles the kernels, which is no part of the figures
        fleet(devices_of([data])[:2], Path(folder) / "warm", workers=max(WORKERS))
        rows, largest = [], Fleet()
        for number, count in [(n, w) for n in sizes for w in WORKERS]:
            out = Path(folder) / f"out-{number}-{count}"
            tried = MINUTES if (number, count) == (sizes[-1], WORKERS[-1]) else None
            every = devices_of([data])[:number]
            largest = fleet(every, out, workers=count, minutes=tried, advance=advance)
            rows.append(_row(number, count, largest))
    return {
        "minutes": MINUTES,
        "odr_hz": ODR_HZ,
        "bytes_per_recording": size_bytes,
        "scaling": rows,
        "effects": largest.report["effects"],
        "prior": largest.report["prior"]["benefit"],
    }


def steps(devices: Sequence[int]) -> int:
    """Devices simulated and run in all."""
    return max(devices) + len(WORKERS) * sum(devices)


def _simulate(number: int, data: Path, advance: Callable[[float], None]) -> None:
    batches = [list(range(i, min(i + _PER_TASK, number))) for i in range(0, number, _PER_TASK)]
    write = partial(write_devices, data, MINUTES)
    with cluster(workers=os.cpu_count()) as client:
        for batch, failure in run_all(client, write, batches):
            if failure is not None:
                raise failure
            advance(len(batch))


def _row(number: int, workers: int, done: Fleet) -> dict[str, float]:
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
    """Scaling, and the prior's worth."""
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
