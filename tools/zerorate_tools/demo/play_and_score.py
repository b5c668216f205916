"""`demo`: plays a recording through chip, bus, driver and firmware, and says what it gained."""

import tempfile
from dataclasses import dataclass
from os import PathLike
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..errors import BadRecording, ZerorateError
from ..recordings import Recording, read_recording
from ..replay import AT_REST_ALONE, replay
from ..replay.engines import staged_packages
from ..replay.samples import frames_in_batches
from ..runtimes import Runtime, find
from .score import Score, score

_FULL_SCALE_DPS = {131.0: 250, 65.5: 500, 32.8: 1000, 16.4: 2000}
_FULL_SCALE_G = {16384.0: 2, 8192.0: 4, 4096.0: 8, 2048.0: 16}
_PARTS = {340.0: "MPU-6050", 333.87: "MPU-6500", 326.8: "ICM-20689"}
_OUT = np.dtype([("bias", "<i4", 3), ("rates", "<i4", 3)])


@dataclass(frozen=True)
class Demo:
    """What a demo showed.

    said: what the MicroPython printed; same_state: the firmware's final state equals, to the last
    bit, that of a replay on this host; bias_dps, corrected_dps: (n, 3); truth_dps: the true bias
    where the recording was simulated.
    """

    recording: Recording
    runtime: str
    said: str
    same_state: bool
    bias_dps: NDArray[np.float64]
    corrected_dps: NDArray[np.float64]
    truth_dps: NDArray[np.float64] | None
    score: Score


def demo(
    log: str | PathLike[str] | Recording,
    runtime: str = "wasm",
    *,
    truth_dps: NDArray[np.float64] | None = None,
    model: Path | None = None,
    learned: Path | None = None,
) -> Demo:
    """Play `log` on `runtime` and score it.

    truth_dps: (n, 3) the true bias; without it the device must rest throughout, as its true rate
    is taken for zero. model: an effect model to load; learned: a state to start from, as `replay`
    writes it. Raises ZerorateError (BadRecording, MissingRuntime).
    """
    interpreter = find(runtime)
    recording = log if isinstance(log, Recording) else read_recording(log, keep_gaps=True)
    played = play(recording, interpreter, model=model, learned=learned)
    here = replay(recording, model=model, from_state=learned, options=AT_REST_ALONE)
    return Demo(
        recording=recording,
        runtime=interpreter.name,
        said=played.said,
        same_state=played.state == here.state,
        bias_dps=played.bias_dps,
        corrected_dps=played.corrected_dps,
        truth_dps=truth_dps,
        score=score(recording, played.bias_dps, truth_dps),
    )


@dataclass(frozen=True)
class Played:
    """What came back: bias_dps, corrected_dps (n, 3); said, what was printed; state, its bytes."""

    bias_dps: NDArray[np.float64]
    corrected_dps: NDArray[np.float64]
    said: str
    state: bytes


def play(
    recording: Recording,
    interpreter: Runtime,
    *,
    model: Path | None = None,
    learned: Path | None = None,
) -> Played:
    """Play every sample on `interpreter`.

    model: an effect model (model.bin) for the firmware to load; learned: the state to start from,
    as `replay` writes it. Raises BadRecording for scales that no chip of the family has,
    ZerorateError when the script fails.
    """
    given = {"model.bin": model, "learned.bin": learned}
    with tempfile.TemporaryDirectory(prefix="zerorate-demo-") as scratch:
        board = staged_packages(Path(scratch), ("zerorate", "zerorate_i2c", "zerorate_fakes"))
        rows = [np.c_[b.dt_us, b.frames].astype("<i4") for b in frames_in_batches(recording)]
        result = interpreter.run(
            Path(__file__).with_name("on_interpreter.py"),
            _chip_settings(recording),
            modules=[board],
            files_in={
                "samples.bin": np.concatenate(rows).tobytes(),
                **{name: path for name, path in given.items() if path is not None},
            },
            files_out=["out.bin", "state.bin"],
            heap=8 << 20,
            check=True,
        )
    out = np.frombuffer(result.files["out.bin"], _OUT)
    if len(out) != len(recording):
        raise ZerorateError(f"{interpreter.name} read {len(out)} samples of the recording, not all")
    lsb = recording.scales.gyro_lsb_per_dps
    return Played(
        bias_dps=out["bias"] / 256.0 / lsb,
        corrected_dps=out["rates"] / lsb,
        said=result.stdout.strip(),
        state=result.files["state.bin"],
    )


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
