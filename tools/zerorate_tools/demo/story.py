"""What a demo showed, told a chapter at a time: lines of text for a terminal."""

import os
import shutil
import sys
import textwrap
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ..compare import Compared
from ..installed import beside
from ..numbers import fixed
from ..report.sentences import meaning
from .broad import CREDIT, MOTION_FROM_S, WAYS, WHOLE_FROM_S, Real
from .job import Demo, Device, seconds

_IN = " " * 10
_NEXT = """\
What next
  board with MicroPython   {zerorate} flash /dev/ttyACM0 --dry-run     (then without --dry-run)
  Linux board, I2C bus     {zerorate} record /dev/i2c-1 --out run.parquet --seconds 600
  your own test suite      {python} -m pydoc zerorate_fakes
  recordings you have      {zerorate} import FILE --out run.parquet
                           {zerorate} compare RUN...                (would zerorate have helped?)
                           {zerorate} close RUN... --out closed     (each RUN is one power-on)"""


def opening(device: Device, folder: Path) -> str:
    return (
        f"A simulated MPU-6050, switched on {len(device.logs)} times, carried about and put down.\n"
        f"Its recordings are {folder / 'power-on-1.parquet'} to {device.logs[-1].name}."
    )


def chapter_one(shown: Demo) -> str:
    return "\n".join(["", "1. The firmware learns", *played(shown), *scored(shown)])


def played(shown: Demo) -> list[str]:
    """What was played on what, the firmware's own words, and whether its state is the host's."""
    minutes, interpreter = seconds(shown.recording)[-1] / 60, _interpreter(shown)
    equal = "equal to the last bit" if shown.same_state else "DIFFERENT, which is a defect"
    name, count = shown.recording.name, len(shown.recording)
    return [
        f"   {name}: {count} samples, {minutes:.0f} minutes, through",
        f"   an emulated chip on an emulated I2C bus into driver and firmware on {interpreter}",
        f"   ({shown.runtime}). It says:",
        *(f"     {line}" for line in shown.said.splitlines()),
        f"   Its final state and that of the same firmware on this computer: {equal}.",
    ]


def scored(shown: Demo) -> list[str]:
    """The error without anything, with the usual remedy, and with the firmware."""
    s = shown.score
    rows = (
        ("uncorrected", s.uncorrected_mdps, s.uncorrected_deg),
        ("mean of the first ten seconds", s.first_ten_s_mdps, s.first_ten_s_deg),
        ("zerorate", s.firmware_mdps, s.firmware_deg),
    )
    head = "   Error after ten seconds, against the simulated bias:"
    return [head] + [
        f"     {name:30}{mdps:9,.1f} mdps rms {deg:10,.1f} deg lost by the end"
        for name, mdps, deg in rows
    ]


def chapter_two(device: Device, result: Mapping[str, Any]) -> str:
    """What closing the loop found, and how much better that makes the held-out power-on."""
    first, last = device.logs[0].stem, device.logs[-2].stem
    holdout = ", ".join(result["split"]["test"])
    lines = [
        "",
        "2. `close` finds the causes of the error that remains",
        f"   Fitted to {first} to {last}; judged on {holdout}, which was held out.",
        *_found(result["effects"]),
        *(f"   simulated, unknown to the firmware: {words}" for words in device.hidden),
        f"   Error in {holdout}; the device learns in its first still minute only:",
        "                    gx        gy        gz",
    ]
    for name in ("before", "after", "floor"):
        values = "".join(f"{v:10.1f}" for v in result[f"{name}_mdps"])
        lines.append(f"     {name:8}{values} mdps")
    return "\n".join(lines)


def _found(effects: list[dict[str, Any]]) -> list[str]:
    lines = []
    for effect in effects:
        lines.append(f"   found: {effect['effect']} ({effect['confidence']})")
        lines += textwrap.wrap(
            meaning(effect["effect"]), 84, initial_indent=_IN, subsequent_indent=_IN
        )
    return lines or ["   found: nothing"]


def chapter_three(before: Demo, after: Demo, model: Path) -> str:
    ratio = before.score.firmware_mdps / after.score.firmware_mdps
    same = before.same_state and after.same_state
    interpreter = _interpreter(after).removeprefix("a real ")
    return "\n".join(
        [
            "",
            f"3. Back on the chip: {interpreter} loads {model.name}, {model.stat().st_size} bytes",
            f"   {before.recording.name} again, after the others, learning at every rest:",
            "                    gx        gy        gz",
            f"     without {_axes(before)} mdps rms",
            f"     with it {_axes(after)} mdps rms: {ratio:.1f} times better",
            "   Final states equal to those of this computer: " + ("yes." if same else "NO."),
        ]
    )


def _interpreter(shown: Demo) -> str:
    return "this Python" if shown.runtime == "cpython" else "a real MicroPython"


def _axes(shown: Demo) -> str:
    late = seconds(shown.recording) >= 10
    error = (shown.bias_dps - shown.truth_dps)[late]
    return "".join(f"{1e3 * v:10.1f}" for v in np.sqrt(np.mean(error**2, axis=0)))


def compared(found: Compared) -> str:
    """What the recordings alone say of the average at boot, as a user would ask."""
    return "\n" + textwrap.fill(f"By the recordings alone: {found.headline()}", 79)


def ending(files: list[tuple[Path, str]]) -> str:
    width = max(len(str(path)) for path, _ in files)
    looks = [f"  {str(path):{width}}   {what}" for path, what in files]
    following = _NEXT.format(zerorate=_as_typed("zerorate"), python=_as_typed("python"))
    return "\n".join(["", "Look at", *looks, "", following])


def _as_typed(program: str) -> str:
    """A program of this environment by name, or by its path where the shell would not find it."""
    own = Path(sys.executable).with_name(program)
    on_path = shutil.which(program)
    # pipx and uv put a link to the program on the path
    if (on_path and own in (Path(on_path), Path(on_path).resolve())) or not own.exists():
        return program
    relative = os.path.relpath(own)
    return str(own) if relative.startswith("..") else relative


def real_trial(shown: Real, runtime: str) -> str:
    """What the firmware made of a real recording, beside others."""
    trial, truth = shown.trial, shown.truth
    minutes, sigma_mdps = len(trial.rate_dps) / trial.hz / 60, 1e3 * truth.sigma_dps.max()
    optical = " ".join(fixed(v, 3, "+") for v in truth.bias_dps)
    lines = [
        f"{trial.name}: a real gyroscope, {minutes:.1f} minutes at {trial.hz:.0f} Hz,",
        "in a hand, at rest at both ends, its attitude seen by cameras",
        f"({CREDIT})",
        f"true bias by the cameras: {optical} dps, one sigma {sigma_mdps:.0f} mdps",
        "",
        f"RMS error of the bias, mdps (firmware on {runtime}):",
        f"{'':42}{'whole trial':>14}{'its motion alone':>20}",
        f"{'':42}{f'from {WHOLE_FROM_S:.0f} s on':>14}{f'from {MOTION_FROM_S:.0f} s on':>20}",
    ]
    for way in WAYS:
        if way not in shown.whole_mdps:
            lines.append(f"  {way:40}not installed: {beside(way)}")
            continue
        whole, motion = shown.whole_mdps[way], shown.motion_mdps[way]
        lines.append(f"  {way:40}{whole:14,.1f}{motion:20,.1f}")
    lines += ["", "What the firmware says at the end of the whole trial:"]
    return "\n".join([*lines, *(f"  {line}" for line in shown.said.splitlines())])
