"""Figures of small whole computations, committed in known.json: what numeric code is held to.

A figure is the mean and the root mean square of a column. `python -m host_tests.golden` renews it.
"""

import json
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from zerorate import Corrector, Sensor
from zerorate_tools.compare import compare
from zerorate_tools.compare.judge import matrix_of
from zerorate_tools.compare.show import table
from zerorate_tools.loop.analyse import sessions_of
from zerorate_tools.loop.read.blocks import dequantise, step_lsb
from zerorate_tools.loop.read.lines import beside_neighbours, find, spectrum
from zerorate_tools.loop.read.still import _is_near, deviation_of, still_ticks
from zerorate_tools.loop.read.ticks import read_ticks, tick_seconds
from zerorate_tools.recordings import Recording, turning, write_recording
from zerorate_tools.simulate import reference, simulate_sessions

from . import fleets, moved, reported, resting, served, watched
from .import_texts import TEXTS
from .kernels import KERNELS, arithmetic

FILE = Path(__file__).with_name("known.json")

_MOTION = [
    *({"kind": kind, "s": 2} for kind in ("rest", "swing", "wave", "stride", "hand", "tremble")),
    {"kind": "tilt", "s": [2, 3], "hz": 0.5},
    {"kind": "vibration", "s": 2, "g": 0.2, "dps": 1.0},
    {"kind": "turn", "s": 2, "deg": 40, "axis": "random"},
    {"kind": "turn", "s": 2, "dps": 20, "axis": "level"},
    {"kind": "turn", "s": 2, "axis": [1, 2, 2]},
    {"kind": "car", "s": 40},
    {"kind": "pose", "s": 2, "face": "-y"},
]
_CHANNELS = {
    "vdd_mv": {"kind": "wander", "mean": 3310, "std": 20, "tau_s": 5, "noise": 2, "lsb": 0.5},
    "load": {"kind": "levels", "low": 10, "high": 250, "mean_s": 6},
    "fan": {"kind": "square", "low": 1, "high": 3, "period_s": 7, "share": 0.3},
    "ramp": {"kind": "path", "start": 5, "path": [{"to": 9, "s": 20}, {"to": 2, "s": 3}]},
    "set": {"kind": "constant", "value": 4, "recorded": False},
    "again": {"kind": "copy", "of": "load", "lsb": 2},
}
_EFFECTS = [
    {"kind": "hysteresis", "width_degc": 2, "dps": 0.1},
    {"kind": "prandtl-ishlinskii", "lopsided": 0.02, "kept_off_degc": [1, -2], "dps": 0.1},
    {"kind": "thermal-rate", "lag_s": 2, "dps": 0.001},
    {"kind": "sensor-lag", "tau_s": 3, "dps": 0.1},
    {"kind": "power-on", "tau_s": 9, "rms_dps": 0.1},
    {"kind": "drift", "rms_dps": [0.1, 0.2, 0.3]},
    {"kind": "kink", "knee_degc": 30, "rms_dps": 0.1, "beyond_temperature": True},
    {"kind": "peak-temperature", "dps": 0.1},
    {"kind": "linear-g", "matrix": [[1, 0.1, 0], [0, 1, 0.2], [0.3, 0, 1]], "dps": 0.1},
    {"kind": "squared-g", "rms_dps": 0.1},
    {"kind": "vibration", "dps": 0.5},
    {"kind": "supply", "dps": 3},
    {"kind": "supply-temperature", "at_mv": 3280, "dps": 0.2},
    {"kind": "scale", "matrix": [[1, 0.1, 0], [0, 1, 0.2], [0.3, 0, 1]], "dps": 0.01},
    {"kind": "periodic", "hz": 0.3, "phase_deg": 40, "dps": 0.1},
    {"kind": "step", "at_s": 11.0, "dps": 0.3},
    {"kind": "step", "at_degc": 26.0, "dps": 0.2},
    {"kind": "channel", "source": "load", "centre": 90, "span": 50, "delay_s": 2, "lag_s": 1,
     "power": 2, "times": "temp", "times_centre": 24, "dps": 0.01},
    {"kind": "channel", "source": "ramp", "rate": True, "knee": 5, "power": 3, "dps": 1e-6},
    {"kind": "channel", "source": "gx", "times": "time_s", "dps": 1e-4},
    {"kind": "timing", "delay_ms": 3, "clock_ppm": 200, "jitter_us": 90},
]  # fmt: skip
EVERYTHING = {
    "seed": 7, "latitude_deg": 48.0, "name": "everything",
    "sensor": {
        "odr_hz": 50.0, "temp_lag_s": 2.0, "temp_step_lsb": 16.0, "accel_bias_g": [0.1, 0, -0.1],
        "gyro_noise_at_hz": 200.0, "temp_noise_degc": 0.1,
    },
    "bias": {"b0": [1, 2, 3], "b1": 0.1, "b2": 0.01, "b3": [0, 0.001, 0], "turn_on_dps": 0.2},
    "noise": {
        "bias_instability_dps": 0.01, "random_walk_dps": 0.02, "telegraph_dps": [0.1, 0, 0.2],
        "telegraph_mean_s": 3.0, "coloured_dps": 0.05, "outlier_dps": 5.0,
        "outlier_per_hour": 900.0,
    },
    "every_session": {
        "face": "+x", "tilt_deg": 3.0, "heading_deg": 30.0, "start_degc": 21.0, "vary_degc": 0.5,
        "vary_time": 0.1, "motion": _MOTION, "noise_scale": 1.5,
        "temperature": [
            {"to": 30, "s": 14}, {"to": 22, "degc_per_min": 60},
            {"cycle": 3, "period_minutes": 0.1, "s": 10}, {"to": 36, "tau_s": 4, "s": 20},
            {"minutes": 0.1}, {"hours": 0.002},
        ],
    },
    "session": [{}, {"face": "-z", "noise_scale": 1.0}],
    "channels": _CHANNELS, "effect": _EFFECTS,
}  # fmt: skip


def figures(columns):
    """{name: [mean, root mean square]} of {name: numbers}."""
    found = {name: np.asarray(values, float).ravel() for name, values in columns.items()}
    return {n: [float(v.mean()), float(np.sqrt((v**2).mean()))] for n, v in found.items()}


def simulated():
    """Of a device with everything that can be described: columns, truth; and every default."""
    found = {"entries": reference().splitlines()}
    for number, (recording, truth) in enumerate(simulate_sessions(EVERYTHING), 1):
        told = {"temp_degc": truth.temp_degc, "still": truth.still}
        for name in ("bias_lsb", "rate_dps", "attitude"):
            told |= {f"{name} {i}": of for i, of in enumerate(getattr(truth, name).T)}
        told |= {f"effect {i}": of for i, of in enumerate(truth.effects_dps)}
        every = figures({**recording.columns, **told})
        found |= {f"{number} {name}": figure for name, figure in every.items()}
    return found


_DEVICE = {
    "seed": 3, "latitude_deg": 48.0,
    "sensor": {"odr_hz": 20.0, "temp_step_lsb": 32.0, "temp_noise_degc": 0.01},
    "bias": {"b0": [1, 2, 3], "b1": 0.02, "turn_on_dps": 0.05},
    "noise": {"bias_instability_dps": 0.002},
    "every_session": {
        "start_degc": 21.0, "tilt_deg": 10.0,
        "temperature": [{"to": 30, "s": 200}, {"to": 24, "s": 160}],
        "motion": [
            {"kind": "rest", "s": 50}, {"kind": "hand", "s": 12}, {"kind": "rest", "s": 30},
            {"kind": "vibration", "s": 9, "g": 0.1}, {"kind": "turn", "s": 5, "dps": 40},
        ],
    },
    "session": [{}, {}, {"motion": [], "minutes": 8}],
    "channels": {**_CHANNELS, "temp_2": {"kind": "constant", "value": 5}},
    "effect": [{"kind": "periodic", "hz": 0.11, "dps": 0.02}],
}  # fmt: skip


def _logs(folder):
    """Power-ons as files, the second with an attitude; two have gaps, rails and an outlier."""
    for number, (recording, truth) in enumerate(simulate_sessions(_DEVICE), 1):
        columns = {name: column.copy() for name, column in recording.columns.items()}
        if number == 2:
            parts = np.rint(truth.attitude * 10000).astype(np.int32).T
            columns |= dict(zip(("ref_qw", "ref_qx", "ref_qy", "ref_qz"), parts))
        columns["t_us"] += 3_700_000 * number
        kept = np.arange(len(truth.still))
        if number < 3:
            columns["gx"][500:503] = 32767
            columns["gy"][900:960] = columns["gy"][900]
            columns["gz"][700] += 9000
            columns["t_us"][4000:] += 7_300_000
            kept = np.r_[0:3000, 3090 : len(truth.still)]
        one = Recording(
            {name: c[kept] for name, c in columns.items()}, recording.scales, recording.name
        )
        write_recording(one, folder / f"{one.name}.parquet")
        yield folder / f"{one.name}.parquet"


def _fields(of, names):
    return {name: getattr(of, name) for name in names.split() if getattr(of, name) is not None}


def read():
    """Of a device's power-ons as the loop reads them: ticks, blocks, spectra, rests, Earth."""
    with TemporaryDirectory() as folder:
        logs = list(_logs(Path(folder)))
        ticks = [read_ticks(log, max(map(tick_seconds, logs))) for log in logs]
        deviations = [deviation_of(log) for log in logs]
    sessions, gate = sessions_of(ticks)
    found = {"dropped": sorted(map(": ".join, gate.dropped.items())), "notes": gate.notes}
    for number, (tick, session) in enumerate(zip(ticks, sessions), 1):
        columns = _fields(
            tick, "count rate rate_var accel accel_var vib temp reference attitude delay"
        )
        columns |= _fields(session, "rate_dps weight tick_weight available first_still moved")
        columns |= {f"source {name}": source for name, source in session.sources.items()}
        columns |= {"segments": tick.segments.power, "ends": tick.segments.ticks}
        columns |= {"cluster": deviations[number - 1][0], "adev": deviations[number - 1][1]}
        columns |= {"still": still_ticks(tick), "earth": session.earth.rate_dps}
        columns |= {f"fault {name}": count for name, count in tick.faults.items()}
        columns["scalars"] = [session.block_s, session.temp_step_degc, session.moving_s]
        every = figures({n: np.nan_to_num(np.asarray(c, float)) for n, c in columns.items()})
        found |= {f"{number} {name}": figure for name, figure in every.items()}
        found[f"{number} said"] = [session.earth.said]
    spectra = [spectrum(s.ticks_dps, s.tick_s, 1024) for s in sessions]
    for number, line in enumerate(find(spectra[1:], spectra[:1], 3.0, 0.02)):
        nats = np.log(line.p_value + 1e-300)
        found[f"line {number}"] = [line.hz, *line.amplitude_dps, nats, line.in_holdout]
    return found | figures({"welch": sessions[2].welch.power})


def parts_of_reading():
    """Courses in steps, spectra beside their neighbours, what noise hides of a turn, and rests."""
    rng, at = np.random.default_rng(5), np.arange(1200)
    found = {}
    for number, (height, noise) in enumerate(
        [(9, 0.05), (9, 0.3), (2.2, 0.0), (40, 0.1), (3, 0.2)]
    ):
        path = height * np.sin(at / 190 + number) + height * np.maximum(at - 900, 0) / 300
        samples = np.round(path[:, None] + noise * rng.normal(size=(len(at), 20)))
        means = (1 + (number == 3)) * samples.mean(axis=1)
        found |= figures({f"course {number}": dequantise(means), f"ends {number}": means[[0, -1]]})
        found |= {f"step {number}": [step_lsb(means)], f"steps {number}": [step_lsb(means[600:])]}
    walk = np.cumsum(rng.normal(0, 0.01, (6000, 3)), axis=0) + rng.normal(size=(6000, 3))
    seen = spectrum(walk + np.sin(0.3 * np.arange(6000))[:, None], 0.5, 1024)
    found |= figures({"power": seen.power, "ratio": beside_neighbours(seen, 3.0)[1:]})
    off = rng.normal(0, 1.5, (1200, 3)) + 2.0 * (np.abs(at - 700) < 90)[:, None]
    there, quiet = at % 50 > 1, (at % 70 > 5) & (np.abs(at - 300) > 40)
    numbers, words = resting.rests()
    return found | figures(numbers) | words | {"near": resting.edges(_is_near(off, there, quiet))}


def flat(value, path=""):
    """{path: leaves} of what JSON holds; of numbers in lists their figures."""
    if isinstance(value, dict):
        parts = [flat(part, f"{path} {name}".strip()) for name, part in value.items()]
        return {name: leaves for part in parts for name, leaves in part.items()}
    leaves = value if isinstance(value, list) else [value]
    if leaves and all(isinstance(one, dict) for one in leaves):
        return flat({str(number): one for number, one in enumerate(leaves)}, path)
    is_text = any(isinstance(one, str) or one is None for one in leaves)
    return {path: leaves} if is_text or not leaves else figures({path: leaves})


def compared():
    """Of power-ons: what each way to the bias would have left, and what motion shows."""
    with TemporaryDirectory() as folder:
        logs = list(_logs(Path(folder)))
        found, won = compare(logs), matrix_of(logs)
    figures_of = {**found.figures(), "table": table(found).splitlines(), "won": vars(won)}
    return flat(figures_of)


_MADE_FOR = (
    ((), {}),
    ((1000, 16.4, 2048, 333.87), {"window_s": 0.2, "segment_s": 1.0}),
    ((4, 8000, 32768, 2000), {"bins": 9, "share": 0.5}),
    ((0.1, 32.8, 0, 0), {"every": True, "bins": 5, "short": 1, "long": 2}),
    ((8000, 65.5, 4096, 326.8), {"document": True, "bins": 19, "short": 6, "long": 12}),
    ((50, 131, 16384, 340), {"document": True, "motion": True, "gravity": True}),
)


def settings():
    """Every word of the settings that the firmware makes of sensors and rules."""
    made = [Corrector(Sensor(*map(float, scales)), **rules) for scales, rules in _MADE_FOR]
    parts = ("settings", "motion_settings", "gravity_settings")
    words = {f"{n} {p}": getattr(one, p) or () for n, one in enumerate(made) for p in parts}
    return {name: [" ".join(map(str, of))] for name, of in words.items()}


def turned():
    """How gravity turns with the rates of a hand: spans, and what each size and order leaves."""
    device = {"seed": 3, "sensor": {"odr_hz": 100.0}, "session": [{}]}
    device["every_session"] = {"minutes": 6, "motion": [{"kind": "hand", "s": 360}]}
    recording, truth = next(iter(simulate_sessions(device)))
    t_s = recording.columns["t_us"] * 1e-6
    force = np.array([recording.columns[name] for name in ("ax", "ay", "az")]) / 16384
    t_s[700:] += 40.0
    turns, forces = turning._spans(truth.rate_dps.T, force, t_s)
    taken = {"sizes": turning._sized(turning._SIZES_DPS), "orders": turning._AXES}
    left = {name: list(turning._lacking(turns, forces, of)) for name, of in taken.items()}
    told = turning.dps_of_one(truth.rate_dps.T / 4, force, t_s).dps
    return figures({"turns": turns, "forces": forces, "told": told}) | left


def moved_figures(found):
    """Of what motion shows: its words, and the figures of its numbers."""
    return {n: [of] if isinstance(of, str) else figures({n: of})[n] for n, of in found.items()}


def moved_together():
    """Of what recordings in motion show together, and what they are closed with."""
    found, written = moved.moved_together()
    return moved_figures(found) | figures(written.pop("rows")) | flat(written)


KNOWN = {
    "settings": settings,
    "arithmetic": arithmetic,
    **KERNELS,
    "reported": reported.reported,
    "simulated": simulated,
    "read": read,
    "parts of reading": parts_of_reading,
    "moved": lambda: moved_figures(moved.moved()),
    "moved together": moved_together,
    "turned": turned,
    "compared": compared,
    "parts of a fleet": lambda: reported.gathered_plain(fleets.parts_of_a_fleet()),
    "steps found": reported.steps_found,
    "searched two": reported.searched_two,
    "searched one": reported.searched_one,
    **TEXTS,
    "served": served.served,
    "watched": lambda: reported.gathered(dict(watched.watched())),
}


def committed():
    """{name: {figure: [mean, root mean square]}} as they stand in the file."""
    return json.loads(FILE.read_text(encoding="utf-8"))


def renew():
    """Write the file anew, a figure a line."""
    parts = []
    for name, compute in KNOWN.items():
        lines = [f"{json.dumps(key)}: {json.dumps(figure)}" for key, figure in compute().items()]
        parts.append(f"{json.dumps(name)}: {{\n" + ",\n".join(lines) + "\n}")
    FILE.write_text("{\n" + ",\n".join(parts) + "\n}\n", encoding="utf-8")
