"""The whole job on the built-in device, a function a step: learn, close the loop, put it back."""

import tempfile
from pathlib import Path

from ..closing import close
from ..replay import AT_REST_ALONE, replay
from .device import Device
from .play_and_score import Demo, demo


def first_power_on(device: Device, runtime: str = "wasm") -> Demo:
    """The first power-on of a device that has learned nothing yet, on MicroPython."""
    return demo(device.logs[0], runtime, truth_dps=device.truth_dps[0])


def closed(device: Device, folder: Path) -> dict:
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
        return demo(last, runtime, truth_dps=truth, model=model, learned=state)
