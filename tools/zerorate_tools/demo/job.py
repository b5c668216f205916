"""The whole job on the built-in device, a function a step: learn, close the loop, put it back."""

import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..closing import close
from ..loop.report.result import LoopReport
from ..recordings import write_recording
from ..replay import AT_REST_ALONE, replay
from ..simulate import load_description, simulate_sessions
from ..simulate.schema import Description
from .play_and_score import Demo, demo

DESCRIPTION = Path(__file__).with_name("five-power-ons.toml")


@dataclass(frozen=True)
class Device:
    """logs: a recording a power-on; truth_dps: the true bias in each, (n, 3); hidden: what the
    firmware's frozen model, an offset and a straight line over temperature, is not told."""

    name: str
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
    return Device(described.name, logs, truths, _hidden(described))


def _hidden(described: Description) -> list[str]:
    words = [f"{e['kind']}, {_axes(e['dps'])} mdps" for e in described.effects]
    return [*words, f"curvature, {_axes(described.bias.b2)} mdps per degC squared"]


def _axes(dps: list[float]) -> str:
    return " ".join(f"{1e3 * value:+g}" for value in dps)


def first_power_on(device: Device, runtime: str = "wasm") -> Demo:
    """The first power-on of a device that has learned nothing yet, on MicroPython."""
    return demo(device.logs[0], runtime, device.truth_dps[0])


def closed(device: Device, folder: Path) -> LoopReport:
    """Close the loop over all power-ons, the last held out; what report.json holds."""
    return close(list(device.logs), folder)


def back_on_the_chip(device: Device, model: Path, runtime: str = "wasm") -> tuple[Demo, Demo]:
    """The last power-on without and with `model`, on MicroPython.

    Each goes on from what the firmware had learned, without and with it, in the power-ons before.
    """
    return _last_power_on(device, None, runtime), _last_power_on(device, model, runtime)


def _last_power_on(device: Device, model: Path | None, runtime: str) -> Demo:
    with tempfile.TemporaryDirectory(prefix="zerorate-demo-") as scratch:
        state = Path(scratch) / "learned.bin"
        for log in device.logs[:-1]:
            before = state if state.exists() else None
            replay(log, model=model, from_state=before, state=state, options=AT_REST_ALONE)
        last, truth = device.logs[-1], device.truth_dps[-1]
        return demo(last, runtime, truth, model=model, learned=state)
