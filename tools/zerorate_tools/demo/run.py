"""`demo`: plays a recording through chip, bus, driver and firmware, and says what it gained."""

from __future__ import annotations

import tempfile
from dataclasses import dataclass
from os import PathLike
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..errors import BadRecording, ZerorateError
from ..recordings import Recording, read_recording
from ..replay.engines import staged_packages
from ..replay.run import replay
from ..replay.samples import frames_in_batches
from ..runtimes import find
from .score import Score, score

_FULL_SCALE_DPS = {131.0: 250, 65.5: 500, 32.8: 1000, 16.4: 2000}
_FULL_SCALE_G = {16384.0: 2, 8192.0: 4, 4096.0: 8, 2048.0: 16}
_PARTS = {340.0: "MPU-6050", 333.87: "MPU-6500", 326.8: "ICM-20689"}
_OUT = np.dtype([("verdict", "<i4"), ("bias", "<i4", 3), ("rest", "<i4", 6), ("frame", "<i4", 7)])


@dataclass(frozen=True)
class Demo:
    """What a demo showed.

    said: what the MicroPython printed; same_state: the firmware's final state equals, to the last
    bit, that of a replay on this host; bias_dps, rate_dps, corrected_dps: (n, 3); truth_dps: the
    true bias where the recording was simulated.
    """

    recording: Recording
    runtime: str
    said: str
    same_state: bool
    bias_dps: NDArray[np.float64]
    corrected_dps: NDArray[np.float64]
    truth_dps: NDArray[np.float64] | None
    score: Score


def demo(log: str | PathLike[str] | None = None, runtime: str = "wasm") -> Demo:
    """Play `log`, or a built-in simulated recording, on `runtime` and score it.

    A recording of your own must rest throughout: its true rate is taken for zero. Raises
    ZerorateError (BadRecording, MissingRuntime).
    """
    interpreter = find(runtime)
    recording, truth_dps = _input(log)
    files, said = _played(recording, interpreter)
    rows = np.frombuffer(files["out.bin"], _OUT)
    lsb = recording.scales.gyro_lsb_per_dps
    if len(rows) != len(recording.columns["t_us"]):
        raise ZerorateError(f"{runtime} read {len(rows)} samples of the recording, not all")
    bias_dps = rows["bias"] / 256.0 / lsb
    return Demo(
        recording=recording,
        runtime=interpreter.name,
        said=said,
        same_state=files["state.bin"] == replay(recording).state,
        bias_dps=bias_dps,
        corrected_dps=rows["frame"][:, 4:] / lsb,
        truth_dps=truth_dps,
        score=score(recording, bias_dps, truth_dps),
    )


def _input(log: str | PathLike[str] | None) -> tuple[Recording, NDArray[np.float64] | None]:
    if log is not None:
        return read_recording(log), None
    from ..simulate import simulate

    recording, truth = simulate(Path(__file__).with_name("warm-up.toml"))
    return recording, truth.bias_lsb / recording.scales.gyro_lsb_per_dps


def _played(recording: Recording, interpreter) -> tuple[dict[str, bytes], str]:
    arguments = _chip_settings(recording)
    with tempfile.TemporaryDirectory(prefix="zerorate-demo-") as scratch:
        board = staged_packages(Path(scratch), ("zerorate", "zerorate_i2c", "zerorate_fakes"))
        rows = [np.c_[b.dt_us, b.frames].astype("<i4") for b in frames_in_batches(recording)]
        result = interpreter.run(
            Path(__file__).with_name("on_interpreter.py"),
            arguments,
            modules=[board],
            files_in={"samples.bin": np.concatenate(rows).tobytes()},
            files_out=["out.bin", "state.bin"],
            heap=8 << 20,
            check=True,
        )
    return result.files, result.stdout.strip()


def _chip_settings(recording: Recording) -> tuple[str, int, int, float]:
    """Part, ranges and rate with which the emulated chip gives these very readings."""
    scales = recording.scales
    try:
        return (
            _PARTS[scales.temp_lsb_per_degc or 340.0],
            _FULL_SCALE_DPS[scales.gyro_lsb_per_dps],
            _FULL_SCALE_G[scales.accel_lsb_per_g or 16384.0],
            scales.odr_hz,
        )
    except KeyError as error:
        where = recording.path or recording.name
        problem = f"no chip of the MPU-6050 family has the scale {error}"
        raise BadRecording(where, problem, do="use `zerorate replay`, which takes any") from error
