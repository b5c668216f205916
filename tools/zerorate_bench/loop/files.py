"""Devices that are simulated sample by sample, written to files and closed as a user would.

What follows no block at rest (motion, lines, Earth's rotation) is shown here alone; a few of the
rest are run as well, so that the quick devices of the other rows are known to stand for real files.
"""

import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from zerorate_tools.closing import load
from zerorate_tools.demo.broad import rms_mdps
from zerorate_tools.loop.report.report import report
from zerorate_tools.loop.verify.analysis import Analysis, model_of
from zerorate_tools.loop.verify.firmware import Firmware
from zerorate_tools.recordings import open_recording, write_recording
from zerorate_tools.recordings.recording import ATTITUDE
from zerorate_tools.replay.samples import frames_in_batches
from zerorate_tools.simulate import simulate_sessions
from zerorate_tools.simulate.device import Truth

from .devices import Device
from .run_trial import Outcome

_FACES = ("+x", "-y", "-z", "-x", "+y", "+z")
_PATH = [
    {"to": 42.0, "minutes": 8},
    {"minutes": 5},
    {"to": 26.0, "minutes": 14},
    {"minutes": 4},
    {"to": 46.0, "minutes": 16},
    {"minutes": 3},
]
_POSE = {"kind": "pose", "s": 3}


def _rest(*seconds: float) -> dict[str, Any]:
    return {"kind": "rest", "s": [*seconds]}


def _on_each_face(*bouts: dict[str, Any]) -> list[dict[str, Any]]:
    """The bouts once for each face, to which a pose among them turns."""
    return [b | {"face": face} if b is _POSE else b for face in _FACES for b in bouts]


_TURNED = _on_each_face(
    _rest(40, 90),
    _POSE,
    {"kind": "rest", "s": 15},
    {"kind": "turn", "axis": "random", "deg": 100, "s": 3},
)
_POSED = _on_each_face(_rest(120, 240), _POSE)
_HANDLED = [_rest(60, 90), {"kind": "hand", "s": [30, 60]}]
_IN_THE_HAND = _on_each_face(_rest(40, 70), {"kind": "hand", "s": [20, 30]}, _POSE)
_OF_ACCELERATION = [[1.0, 0.3, 0.0], [0.0, 1.0, -0.3], [0.3, 0.0, 1.0]]
_BY_ACCELERATION = {"kind": "linear-g", "dps": 0.08, "matrix": _OF_ACCELERATION}
#: Seconds of a power-on before its error in motion counts: the turn-on offset is learned first.
_LEARNED_S = 600
_FLOOR_DPS = 0.002
_CROSS = [[0.0, 0.01, -0.005], [0.005, 0.0, 0.01], [-0.01, 0.005, 0.0]]
#: What a line that no block shows is to the tables.
_INTERFERENCE: dict[str, Any] = {
    **{"effect": "periodic-interference", "confidence": "tentative"},
    **{"sources": [], "confounded_with": []},
}
HELD_IN_A_HAND = "files, acceleration 80 mdps, a third of it in the hand"


class Row(NamedTuple):
    """What of a description differs, the effect that must be named ("" for none), and whether the
    attitude is recorded beside it."""

    named: str = ""
    motion: Sequence[dict[str, Any]] = ()
    effect: dict[str, Any] | None = None
    attitude: bool = False
    latitude_deg: float | None = None


def _line(hz: float) -> dict[str, Any]:
    return {"kind": "periodic", "hz": hz, "rms_dps": 2 * _FLOOR_DPS}


def _scale(dps: object, **more: object) -> dict[str, Any]:
    return {"kind": "scale", "dps": dps, **more}


_HISTORY = {"kind": "hysteresis", "beyond_temperature": True, "rms_dps": 2 * _FLOOR_DPS}
ROWS = {
    "files, nothing": Row(),
    "files, nothing, turned over with Earth in it": Row(motion=_POSED, latitude_deg=50.0),
    "files, nothing, handled with attitude": Row(motion=_HANDLED, attitude=True),
    "files, hysteresis at 2x": Row("thermal-hysteresis", effect=_HISTORY),
    "files, a line of 40 s at 2x": Row("periodic-interference", effect=_line(0.025)),
    "files, mains folded to 1.7 Hz at 2x": Row("periodic-interference", effect=_line(51.7)),
    "files, scale 1 % beside gravity": Row("scale-factor", _TURNED, _scale([0.01, -0.01, 0.01])),
    "files, cross-axis 1 % beside gravity": Row("cross-axis", _TURNED, _scale(1.0, matrix=_CROSS)),
    "files, scale 0.1 % beside attitude": Row(
        "scale-factor", _HANDLED, _scale([0.001, -0.001, 0.001]), attitude=True
    ),
    HELD_IN_A_HAND: Row("linear-acceleration", _IN_THE_HAND, _BY_ACCELERATION),
    "files, readings 2 ms late": Row(
        "sample-timing", _HANDLED, {"kind": "timing", "delay_ms": 2.0}, attitude=True
    ),
}


def file_devices(seeds: int) -> list[Device]:
    """So many of each row."""
    return [Device(row, 900_000 + i) for row in ROWS for i in range(seeds)]


def description(row: str) -> dict[str, Any]:
    """Of a row's device: four sessions of fifty minutes at 10 Hz, an MPU-6050."""
    of = ROWS[row]
    more: dict[str, Any] = {} if of.effect is None else {"effect": [of.effect]}
    if of.latitude_deg is not None:
        more["latitude_deg"] = of.latitude_deg
    return {
        "sessions": 4,
        "sensor": {"odr_hz": 10.0, "gyro_noise_at_hz": 100.0, "accel_bias_g": [0.03, -0.02, 0.04]},
        "bias": {"b0": [1.2, -0.8, 0.4], "b1": [0.02, -0.015, 0.01], "turn_on_dps": 0.02},
        "noise": {"bias_instability_dps": _FLOOR_DPS, "random_walk_dps": 0.00005},
        "every_session": {
            "start_degc": 22.0,
            "vary_degc": 2.0,
            "vary_time": 0.15,
            "temperature": _PATH,
            "motion": [*of.motion],
        },
        "channels": {"load": {"kind": "levels", "low": 0.0, "high": 100.0, "mean_s": 300.0}},
        **more,
    }


def look_at_files(device: Device) -> Outcome:
    """Simulate a device into files, close them, and take the report's word for what was found."""
    with tempfile.TemporaryDirectory() as folder:
        made = list(_written(device, Path(folder)))
        analysis = load([path for path, _ in made])
        said, held = report(analysis), device.row == HELD_IN_A_HAND
        in_motion = _in_motion_mdps(analysis, *made[-1]) if held else None
    judgement = analysis.judgement
    effects = said["effects"] + [_INTERFERENCE] * len(said["interference"])
    floor = float(np.sqrt(np.mean(analysis.floor_dps**2)))
    return Outcome(
        device,
        [effect["effect"] for effect in effects],
        [effect["sources"] for effect in effects],
        [effect["confounded_with"] for effect in effects],
        [effect["confidence"] for effect in effects],
        events=len(said["events"]),
        excess=bool(judgement.residual_test.left),
        before=judgement.before_rms / floor,
        after=judgement.after_rms / floor,
        in_motion_mdps=in_motion,
    )


def _in_motion_mdps(analysis: Analysis, path: Path, truth: Truth) -> float:
    """RMS over the moving samples and the axes of the firmware's error, learning as it goes."""
    recording = open_recording(path)
    scales = recording.scales
    device = Firmware(scales, model_of(analysis, scales))
    device.power_on()
    bias = np.vstack([device.run(frames) for frames in frames_in_batches(recording)]) / 256
    error = (bias - truth.bias_lsb) / scales.gyro_lsb_per_dps
    counts = ~truth.still & (truth.t_us - truth.t_us[0] > 1e6 * _LEARNED_S)
    return rms_mdps(error[counts])


def _written(device: Device, folder: Path) -> Iterator[tuple[Path, Truth]]:
    """(file, truth) of every session."""
    made = simulate_sessions(description(device.row), seed=device.seed)
    for i, (recording, truth) in enumerate(made):
        columns = dict(recording.columns)
        if ROWS[device.row].attitude:
            for name, q in zip(ATTITUDE, truth.attitude.T):
                columns[name] = np.rint(q * 2**29).astype(np.int32)
        path = folder / f"session-{i + 1}.parquet"
        write_recording(replace(recording, columns=columns), path)
        yield path, truth
