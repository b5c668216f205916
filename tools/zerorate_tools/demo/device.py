"""The demo's device: recordings of its power-ons on disk, and the truth behind them."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..recordings import write_recording
from ..simulate import load_description, simulate_sessions
from ..simulate.schema import Description

DESCRIPTION = Path(__file__).with_name("five-power-ons.toml")


@dataclass(frozen=True)
class Device:
    """logs: a recording a power-on; truth_dps: the true bias in each, (n, 3); hidden: what the
    firmware's frozen model, an offset and a straight line over temperature, is not told."""

    name: str
    logs: list[Path]
    truth_dps: list[NDArray[np.float64]]
    hidden: list[str]


def make_device(folder: Path, description: Path | dict = DESCRIPTION) -> Device:
    """Simulate a device and write its recordings as power-on-N.parquet. Raises ZerorateError."""
    described = load_description(description)
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
