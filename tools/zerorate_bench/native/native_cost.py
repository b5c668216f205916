"""What a sample costs as machine code on emulated processors, beside C -O2 of the same kernels."""

from array import array
from collections.abc import Iterator
from statistics import mean, median
from typing import Any

import numpy as np
from numpy.typing import NDArray
from zerorate import Corrector
from zerorate.effects.model_file import LOADED
from zerorate.gravity.gravity_settings import gravity_settings, gravity_state
from zerorate.model import EffectModel
from zerorate.motion.motion_settings import motion_settings, motion_state
from zerorate_tools.errors import ZerorateError
from zerorate_tools.kernels.parts import BURST, PARTS
from zerorate_tools.kernels.reading import Kernels, firmware_package
from zerorate_tools.model import Slot, build_model, encoded
from zerorate_tools.model.check import sensor_for
from zerorate_tools.model.term import Term
from zerorate_tools.simulate import simulate

from ..workload import CYCLE, Workload
from .emulated import Emulated, code_in, emulated
from .machine_code import PROCESSORS, machine_code

# frames of 14 bytes in the 1024 bytes of an MPU-6050's FIFO, of which it loses none at this
AT_ONCE = 64
_UPDATES = ("motion", "gravity")
# by the last of these samples windows in motion are at their longest
_FROM, _TO = 4000, 7200
_EFFECTS_TO = 1000


def native_cost(work: Workload) -> dict[str, dict[str, Any]]:
    """Processor -> figures of one sample alone and in bursts. Raises MissingRuntime.

    Each figure: instructions (mean), instructions_c (mean, C -O2), median and worst, and for the
    Cortex-M0+ cycles, cycles_worst. Raises ZerorateError if the states of both differ.
    """
    return {
        processor: {
            "alone": _against_c(work, processor, "rest", 1),
            "bursts": _against_c(work, processor, "rest", AT_ONCE),
        }
        for processor in PROCESSORS
    }


def code_bytes() -> dict[str, dict[str, int]]:
    """Processor -> part -> bytes of machine code."""
    folder = firmware_package() / "native"
    return {
        processor: {part: len(code_in(folder / f"{processor}_{part}.py")) for part in PARTS}
        for processor in PROCESSORS
    }


def source_cost() -> dict[str, dict[str, float]]:
    """motion, gravity -> instructions and cycles a sample, mean and worst, on a Cortex-M0+."""
    recording, _ = simulate("never-rests", session=1, seed=1)
    frames = recording.between(0, _TO).samples()
    motion, gravity = motion_settings(), gravity_settings()
    states = {
        "motion": (motion_state(motion), motion),
        "gravity": (gravity_state(gravity), gravity),
    }
    return {part: _source(part, *states[part], frames.astype(np.int32)) for part in _UPDATES}


def effects_cost() -> dict[str, dict[str, float]]:
    """Slots of a model -> instructions and cycles a sample of them, mean and worst, on a Cortex-M0+
    at 100 Hz, of which temperature ticks once a second; acceleration and channels never wait."""
    recording, _ = simulate("never-rests", session=1, seed=1)
    frames = recording.between(0, _EFFECTS_TO).samples().astype(np.int32)
    warm = [Term("temp", lo=0.0, hi=50.0, centre=25.0, power=k) for k in (1, 2, 3)]
    lying = [Term(f"acc_{a}", lo=-1.0, hi=1.0) for a in "xyz"]
    models = {"three of temperature": warm, "one of acceleration": lying[:1]}
    models |= {"three of acceleration": lying, "three of each": [*warm, *lying]}
    models |= {"one of a channel": [Term("vdd_mv", lo=4930.0, hi=5050.0, centre=5000.0)]}
    return {name: _of_slots(recording.scales, terms, frames) for name, terms in models.items()}


def _of_slots(scales, terms, frames: NDArray) -> dict[str, float]:
    code = emulated(firmware_package(), "effects", "thumb")
    corrector, effects = Corrector(sensor_for(scales)), EffectModel()
    model = build_model([Slot(t, (0.01 / 25**t.power,) * 3, "") for t in terms], scales)
    if effects.load(encoded(model), corrector.sensor) != LOADED:
        raise ZerorateError("the firmware refuses the model whose cost is asked for")
    for i in range(len(effects.channels)):
        effects.channel(i, 5010)
    counts, cycles = [], []
    for row in frames:
        code(corrector.state, effects.e, array("i", row.tobytes()), 10000)
        counts.append(code.instructions)
        cycles.append(code.cycles)
    return {"instructions": mean(counts), "cycles": mean(cycles), "cycles_worst": max(cycles)}


def _source(part: str, state: array, settings: array, frames: NDArray) -> dict[str, float]:
    code, counts, cycles = emulated(firmware_package(), part, "thumb"), [], []
    for i, row in enumerate(frames):
        code(state, settings, array("i", row.tobytes()), 10000)
        if i >= _FROM:
            counts.append(code.instructions)
            cycles.append(code.cycles)
    return {"instructions": mean(counts), "cycles": mean(cycles), "cycles_worst": max(cycles)}


def _against_c(work: Workload, processor: str, part: str, at_once: int) -> dict[str, Any]:
    package = firmware_package()
    ours = _run(emulated(package, part, processor), work, at_once)
    yardstick = machine_code(Kernels(package), part, processor, fast=True)
    theirs = _run(Emulated(processor, yardstick), work, at_once)
    if ours[0] != theirs[0]:
        raise ZerorateError(f"two compilations of {part} differ on {processor}: nothing compared")
    counts, cycles = ours[1]
    found: dict[str, Any] = {"instructions": mean(counts), "instructions_c": mean(theirs[1][0])}
    found |= {"median": median(counts), "worst": max(counts)}
    if processor == "thumb":
        found |= {"cycles": median(cycles), "cycles_worst": max(cycles)}
    return found


def _run(code: Emulated, work: Workload, at_once: int) -> tuple[bytes, tuple[list, list]]:
    """(final state, (instructions of a sample of each call, cycles of a sample of each call))."""
    state, settings = (array("i", words.tobytes()) for words in (work.state, work.settings))
    counts, cycles = [], []
    for count in _calls(code, work, at_once, state, settings):
        counts.append(code.instructions / count)
        cycles.append(code.cycles / count)
    return state.tobytes(), (counts, cycles)


def _calls(code: Emulated, work: Workload, at_once: int, s: array, c: array) -> Iterator[int]:
    """Make each call and yield how many samples it took."""
    for first in range(0, CYCLE, at_once):
        rows = work.rows[first : min(first + at_once, CYCLE)]
        if at_once == 1:
            code(s, c, array("i", rows[0, 1:].tobytes()), int(rows[0, 0]))
        else:
            code(s, c, array("i", rows.tobytes()), BURST + len(rows))
        yield len(rows)
