"""The whole job on the built-in device, a function a step, and what each step gained."""

import tempfile
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from os import PathLike
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..errors import ZerorateError
from ..recordings import Recording, read_recording, write_recording
from ..replay import AT_REST_ALONE, replay
from ..replay.engines import staged_packages
from ..replay.samples import frames_in_batches
from ..runtimes import Result, Runtime, find
from ..simulate import load_description, simulate_sessions

SETTLE_S = 10.0
#: Part, dps and g of the emulated chip, whose scales the simulated device has.
_CHIP = ("MPU-6050", 250, 2)
_OUT = np.dtype([("bias", "<i4", 3), ("rates", "<i4", 3)])
Array = NDArray[np.float64]


@dataclass(frozen=True)
class Score:
    """Root mean square errors over three axes in mdps, and the angle lost by the end in degrees.

    All are counted from SETTLE_S on, which the ten-second mean needs.
    """

    uncorrected_mdps: float
    first_ten_s_mdps: float
    firmware_mdps: float
    uncorrected_deg: float
    first_ten_s_deg: float
    firmware_deg: float


@dataclass(frozen=True)
class Demo:
    """What a demo showed.

    said: what the MicroPython printed; same_state: the firmware's final state equals, to the last
    bit, that of a replay on this host; bias_dps, corrected_dps, truth_dps: (n, 3), the last being
    the true bias.
    """

    recording: Recording
    runtime: str
    said: str
    same_state: bool
    bias_dps: Array
    corrected_dps: Array
    truth_dps: Array
    score: Score


def demo(
    log: str | PathLike[str],
    runtime: str,
    truth_dps: Array,
    *,
    model: Path | None = None,
    learned: Path | None = None,
) -> Demo:
    """Play `log`, a simulated device's, on `runtime` and score it by the (n, 3) true bias.

    model: an effect model to load; learned: a state to start from, as `replay` writes it. Raises
    ZerorateError (BadRecording, MissingRuntime).
    """
    interpreter, recording = find(runtime), read_recording(log)
    played = _play(recording, interpreter, {"model.bin": model, "learned.bin": learned})
    here = replay(recording, model=model, from_state=learned, options=AT_REST_ALONE)
    out, lsb = np.frombuffer(played.files["out.bin"], _OUT), recording.scales.gyro_lsb_per_dps
    if len(out) != len(recording):
        raise ZerorateError(f"{interpreter.name} read {len(out)} samples of the recording, not all")
    bias_dps = out["bias"] / 256.0 / lsb
    return Demo(
        recording=recording,
        runtime=interpreter.name,
        said=played.stdout.strip(),
        same_state=played.files["state.bin"] == here.state,
        bias_dps=bias_dps,
        corrected_dps=out["rates"] / lsb,
        truth_dps=truth_dps,
        score=_score(recording, bias_dps, truth_dps),
    )


def _play(recording: Recording, interpreter: Runtime, given: dict[str, Path | None]) -> Result:
    """Play every sample on `interpreter`, beside files of those names. Raises ZerorateError."""
    with tempfile.TemporaryDirectory(prefix="zerorate-demo-") as scratch:
        board = staged_packages(Path(scratch), ("zerorate", "zerorate_i2c", "zerorate_fakes"))
        rows = [np.c_[b.dt_us, b.frames].astype("<i4") for b in frames_in_batches(recording)]
        return interpreter.run(
            Path(__file__).with_name("on_interpreter.py"),
            [*_CHIP, recording.scales.odr_hz],
            modules=[board],
            files_in={
                "samples.bin": np.concatenate(rows).tobytes(),
                **{name: path for name, path in given.items() if path is not None},
            },
            files_out=["out.bin", "state.bin"],
            heap=8_388_608,
            check=True,
        )


def _score(recording: Recording, bias_dps: Array, truth_dps: Array) -> Score:
    t_s = seconds(recording)
    later = t_s >= SETTLE_S
    first = recording.gyro_dps()[~later].mean(axis=0)
    errors = [each[later] for each in (truth_dps, truth_dps - first, truth_dps - bias_dps)]
    steps = np.diff(t_s[later], append=t_s[-1])
    mdps = [1e3 * float(np.sqrt(np.mean(np.square(error)))) for error in errors]
    lost = [float(np.abs((error * steps[:, None]).sum(axis=0)).max()) for error in errors]
    return Score(*mdps, *lost)


def seconds(recording: Recording) -> Array:
    """Seconds since the first sample, (n,)."""
    t_us = recording.columns["t_us"]
    return (t_us - t_us[0]) * 1e-6


DESCRIPTION = Path(__file__).with_name("five-power-ons.toml")


@dataclass(frozen=True)
class Device:
    """logs: a recording a power-on; truth_dps: the true bias in each, (n, 3); hidden: what the
    firmware's frozen model, an offset and a straight line over temperature, is not told."""

    logs: list[Path]
    truth_dps: list[NDArray[np.float64]]
    hidden: list[str]


def make_device(folder: Path) -> Device:
    """Simulate a device and write its recordings as power-on-N.parquet. Raises ZerorateError."""
    described = load_description(DESCRIPTION)
    folder.mkdir(parents=True, exist_ok=True)
    logs, truths = [], []
    for number, (recording, truth) in enumerate(simulate_sessions(described), start=1):
        logs.append(folder / f"power-on-{number}.parquet")
        write_recording(recording, logs[-1])
        truths.append(truth.bias_lsb / recording.scales.gyro_lsb_per_dps)

    def per_axis(dps: list[float]) -> str:
        return " ".join(f"{1e3 * value:+g}" for value in dps)

    hidden = [f"{e['kind']}, {per_axis(e['dps'])} mdps" for e in described.effects]
    hidden.append(f"curvature, {per_axis(described.bias.b2)} mdps per degC squared")
    return Device(logs, truths, hidden)


def first_power_on(device: Device, runtime: str = "wasm") -> Demo:
    """The first power-on of a device that has learned nothing yet, on MicroPython."""
    return demo(device.logs[0], runtime, device.truth_dps[0])


def back_on_the_chip(device: Device, model: Path, runtime: str = "wasm") -> tuple[Demo, Demo]:
    """The last power-on without and with `model`, on MicroPython.

    Each goes on from what the firmware had learned, without and with it, in the power-ons before.
    """
    with ThreadPoolExecutor() as at_once:  # each waits for an interpreter of its own
        without = at_once.submit(_last_power_on, device, None, runtime)
        beside = _last_power_on(device, model, runtime)
        return without.result(), beside


def _last_power_on(device: Device, model: Path | None, runtime: str) -> Demo:
    with tempfile.TemporaryDirectory(prefix="zerorate-demo-") as scratch:
        state = Path(scratch) / "learned.bin"
        for log in device.logs[:-1]:
            before = state if state.exists() else None
            replay(log, model=model, from_state=before, state=state, options=AT_REST_ALONE)
        last, truth = device.logs[-1], device.truth_dps[-1]
        return demo(last, runtime, truth, model=model, learned=state)
