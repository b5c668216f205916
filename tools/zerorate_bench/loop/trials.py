"""The whole benchmark of the loop, which can be broken off and taken up again, with its size."""

import os
import tempfile
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
from zerorate_tools.loop.read.still import still_ticks
from zerorate_tools.loop.read.ticks import read_ticks
from zerorate_tools.recordings import Recording, Scales, write_recording
from zerorate_tools.simulate.device import counts

from ..children import close_cost
from ..public_data import data_folder
from ..tables import machine_line, outcomes, table
from .devices import Device, devices
from .figures import Figure, figures
from .files import ROWS, file_devices, look_at_files
from .run_trial import Outcome, run_trial
from .simulated import FOLDER, write_blocks

SESSIONS, HOURS, HZ = 4, 8, 100.0
SIZE = f"{SESSIONS} sessions of {HOURS} h at {HZ:g} Hz"
MOST_S, MOST_GB = 60.0, 2.0
_DEVICE = {
    "sessions": SESSIONS,
    "sensor": {"odr_hz": HZ},
    "bias": {"b0": [1.2, -0.8, 0.4], "b1": [0.02, -0.015, 0.01], "turn_on_dps": 0.02},
    "noise": {"bias_instability_dps": 0.002, "random_walk_dps": 0.00005},
    "every_session": {
        "start_degc": 22.0,
        "temperature": [{"cycle": 12.0, "period_minutes": 95.0, "hours": HOURS}],
        "vary_time": 0.02,
    },
    "effect": [{"kind": "sensor-lag", "tau_s": 120.0, "rms_dps": 0.01}],
}
_WRITE = f"""
from zerorate_tools.simulate import simulate_to_files
simulate_to_files({_DEVICE!r}, folder / "large.parquet")
"""
RATES_HZ = (1 / 15, 1.0, 2.0, 4.0, 5.0, 10.0)
NOISES_DPS = (0.05, 0.35, 1.0)
_LONG_S, _TURN_S, _TURN_DPS = 9000.0, (4000.0, 4300.0), 3.0
#: Around the ends of a turn, seconds: not counted either way.
_ENDS_S, _BESIDE_S = 20.0, 500.0


def resting(
    folder: Path, odr_hz: float, noise_dps: float, accel: bool, turn_dps: float = 0.0
) -> tuple[np.ndarray, np.ndarray]:
    """(m,) what counts as rest, and (m,) seconds, of two and a half hours with white noise.

    turn_dps: about every axis, for five of the minutes.
    """
    rng = np.random.default_rng(7)
    at_s = np.arange(0, _LONG_S, 1 / odr_hz)
    turning = (at_s >= _TURN_S[0]) & (at_s < _TURN_S[1])
    columns = {"t_us": np.rint(at_s * 1e6).astype(np.int64)}
    rate = 1.3 + turn_dps * turning + rng.normal(0, noise_dps, (3, len(at_s)))
    columns |= counts("g", rate.T * 131)
    if accel:
        force = np.array([0.0, 0.0, 1.0]) + rng.normal(0, 0.004, (3, len(at_s))).T
        columns |= counts("a", force * 16384)
    scales = Scales("MPU-6050", odr_hz, 131.0, 16384.0 if accel else None)
    path = folder / "rest.parquet"
    write_recording(Recording(columns, scales, "rest"), path)
    ticks = read_ticks(path)
    return still_ticks(ticks), np.arange(len(ticks.count)) * ticks.tick_s


def share_used(folder: Path, odr_hz: float, noise_dps: float, accel: bool) -> float:
    """Percent of a rest that is used."""
    return 100.0 * float(resting(folder, odr_hz, noise_dps, accel)[0].mean())


def shares_with_turn(folder: Path, odr_hz: float, noise_dps: float) -> tuple[float, float]:
    """Percent of a turn that is taken for rest, and of the rest beside it that is used."""
    still, at_s = resting(folder, odr_hz, noise_dps, False, _TURN_DPS)
    inside = (at_s >= _TURN_S[0] + _ENDS_S) & (at_s < _TURN_S[1] - _ENDS_S)
    beside = (at_s < _TURN_S[0] - _BESIDE_S) | (at_s > _TURN_S[1] + _BESIDE_S)
    return 100.0 * float(still[inside].mean()), 100.0 * float(still[beside].mean())


def rest_figures() -> list[Figure]:
    """The worst of all rates and noises, with and without an accelerometer."""
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        rests = [share_used(folder, *one) for one in product(RATES_HZ, NOISES_DPS, (False, True))]
        turns = [shares_with_turn(folder, *one)[0] for one in product(RATES_HZ, NOISES_DPS)]
    span = f"1/15 to {RATES_HZ[-1]:g} Hz, noise {NOISES_DPS[0]:g} to {NOISES_DPS[-1]:g} dps"
    return [
        Figure(f"rest used, the least ({span})", min(rests), 95.0, False, len(rests)),
        Figure(f"turn of {_TURN_DPS:g} dps taken for rest", max(turns), 0.0, True, len(turns)),
    ]


def run(
    nulls: int,
    seeds: int,
    processes: int,
    data: Path | None,
    resume: Path | None,
    rows: str | None,
) -> dict[str, Any]:
    """Run it and return the figures and tables as plain values; `in_markdown` makes them readable.

    nulls: devices of each kind of nothing; seeds: devices an effect; data: folder of the real
    recordings, else ZERORATE_DATA, else none; resume: a file of outcomes, one a line, that a run
    broken off goes on from; rows: only devices whose key holds this text, and
    the time and memory where their row does.
    """
    folder = data or data_folder()
    with tempfile.TemporaryDirectory() as scratch:
        quiet = write_blocks(folder, Path(scratch)) if folder and folder.is_dir() else []
        os.environ[FOLDER] = scratch
        every = [*devices(nulls, seeds, quiet), *file_devices(-(-seeds // 2))]
        every = [d for d in every if not rows or rows in d.key]
        seen = [*map(_outcome, outcomes(_look, every, processes, resume))]
    found = figures(seen, whole=not rows)
    if not rows:
        found += rest_figures()
    if not rows or rows in SIZE:
        cost = close_cost(_WRITE)
        found += [
            Figure(f"{SIZE}: seconds by the clock", cost["seconds"], MOST_S, True, 1, unit="s"),
            Figure(f"{SIZE}: seconds of processor", cost["cpu_s"], None, True, 1, unit="s"),
            Figure(f"{SIZE}: memory", cost["gb"], MOST_GB, True, 1, unit="GB"),
        ]
    return {
        "devices": len(seen),
        "figures": [f.to_dict() for f in found],
    }


def _outcome(row: dict[str, Any]) -> Outcome:
    """An outcome of its plain values."""
    device = row["device"]
    effects = tuple((name, size) for name, size in device["effects"])
    return Outcome(**row | {"device": Device(**device | {"effects": effects})})


def _look(device: Device) -> Outcome:
    return look_at_files(device) if device.row in ROWS else run_trial(device)


def in_markdown(result: dict[str, Any]) -> str:
    """The figures as Markdown, the missed ones first."""
    missed = [f["name"] for f in result["figures"] if f["met"] is False]
    limits = sum(f["met"] is not None for f in result["figures"])
    head = f"{len(missed)} of {limits} figures missed: {'; '.join(missed)}."
    parts = [f"# What closing the loop finds, on {result['devices']} devices", ""]
    parts += ["`zerorate bench loop` wrote this page. " + machine_line()]
    parts += [head if missed else "Every figure is reached.", ""]
    return "\n".join([*parts, figure_table(result["figures"])])


def renewed(page: str, figures: list[dict[str, Any]]) -> str:
    """A page of `in_markdown` with these figures in the place of its own of the same name, or after
    the last where it has none, and its head told anew."""
    lines = [*page.splitlines(), ""]
    for line in figure_table(figures).strip().splitlines()[2:]:
        name = _name(line)
        at = next((i for i, old in enumerate(lines) if _name(old) == name), None)
        if at is None:
            at = lines.index("", lines.index(next(x for x in lines if x.startswith("| ---"))))
            lines.insert(at, line)
        lines[at] = line
    missed = [_name(line) for line in lines if " | NO | " in line]
    head = next(i for i, line in enumerate(lines) if line and i > 2)
    lines[head] = f"Missed: {'; '.join(missed)}." if missed else "Every figure is reached."
    return "\n".join(lines).rstrip("\n") + "\n"


def _name(line: str) -> str:
    return line.split(" | ")[0].removeprefix("| ")


def figure_table(figures: list[dict[str, Any]]) -> str:
    """A row a figure, as `Figure.to_dict` has it."""
    header = ("figure", "measured", "limit", "reached", "95 % interval", "devices")
    rows = []
    for f in figures:
        value, unit, limit, low = f["value"], f["unit"], f["limit"], f["low"]
        measured = f"{value:.1f}" if unit == "%" else f"{value:.3f} {unit}"
        bound = "" if limit is None else f"at {'most' if f['at_most'] else 'least'} {limit:g}"
        span = "" if low is None else f"{low:.1f}-{f['high']:.1f}"
        met = {None: "", True: "yes", False: "NO"}[f["met"]]
        rows.append([f["name"], measured, bound, met, span, f["devices"]])
    return table(header, rows)
