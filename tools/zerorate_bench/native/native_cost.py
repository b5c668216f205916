"""What a sample costs as machine code on emulated processors, beside C -O2 of the same kernels."""

from __future__ import annotations

import ast
import struct
from array import array
from collections.abc import Sequence
from functools import cache
from pathlib import Path
from statistics import mean, median
from typing import Any

import numpy as np
from numpy.typing import NDArray
from zerorate import Corrector
from zerorate.effects.model_file import LOADED
from zerorate.gravity.gravity_settings import gravity_settings, gravity_state
from zerorate.model import EffectModel
from zerorate.motion.motion_settings import motion_settings, motion_state
from zerorate_tools.errors import MissingRuntime, ZerorateError
from zerorate_tools.kernels.reading import Kernels, firmware_package
from zerorate_tools.model import Slot, build_model, encoded
from zerorate_tools.model.files import sensor_for
from zerorate_tools.model.term import Term
from zerorate_tools.recordings import Scales
from zerorate_tools.simulate import simulate

from zerorate_bench.native.parts import BURST, PARTS

from ..workload import CYCLE, Workload
from .machine_code import PROCESSORS, instructions, machine_code
from .native_files import ENTERED

_CODE, _END, _STACK, _DATA = 0x10000, 0x30000, 0x80000, 0x100000
_SIZE = 0x10000
_MOST = 20_000_000


class Emulated:
    """Calls of `code` with arrays of 32-bit words and ints, each array copied in and back.

    processor: thumb or rv32; code may stand at any even address: at is one. instructions and cycles
    (of a Cortex-M0+, thumb only) are those of the latest call, if counted. Raises MissingRuntime.
    """

    def __init__(self, processor: str, code: bytes, at: int = _CODE, counted: bool = True) -> None:
        try:
            import unicorn as u
        except ImportError:
            raise MissingRuntime("machine code is run by unicorn: pip install unicorn") from None
        self._processor, self._thumb = processor, processor == "thumb"
        self._at, self._code = at, code
        if self._thumb:
            from unicorn import arm_const as r

            self._cpu = u.Uc(u.UC_ARCH_ARM, u.UC_MODE_THUMB | u.UC_MODE_MCLASS)
            self._cpu.ctl_set_cpu_model(r.UC_CPU_ARM_CORTEX_M0)
            first, *others = r.UC_ARM_REG_R0, r.UC_ARM_REG_LR, r.UC_ARM_REG_SP, r.UC_ARM_REG_PC
        else:
            from unicorn import riscv_const as v

            self._cpu = u.Uc(u.UC_ARCH_RISCV, u.UC_MODE_RISCV32)
            first, *others = (
                *(v.UC_RISCV_REG_A0, v.UC_RISCV_REG_RA, v.UC_RISCV_REG_SP, v.UC_RISCV_REG_PC),
            )
        self._arguments, (self._back, self._stack, self._counter) = range(first, first + 4), others
        for start, size in ((_CODE, 0x20000), (_END, 0x1000), (_STACK - _SIZE, _SIZE)):
            self._cpu.mem_map(start, size)
        self._cpu.mem_map(_DATA, 16 * _SIZE)
        self._cpu.mem_write(at, code)
        if counted:  # which takes ten times as long
            self._cpu.hook_add(u.UC_HOOK_BLOCK, self._block, begin=at, end=at + len(code))
        self._failed = u.UcError
        self._blocks: dict[tuple[int, int], tuple[int, int, int]] = {}
        self.instructions = self.cycles = 0

    def __call__(self, *arguments: array[int] | int) -> int:
        """Its result, a signed int; arrays hold what it left. Raises ZerorateError for a crash."""
        passed = [self._given(i, argument) for i, argument in enumerate(arguments)]
        for register, value in zip(self._arguments, passed):
            self._cpu.reg_write(register, value & 0xFFFFFFFF)
        self._cpu.reg_write(self._stack, _STACK - 64)
        self._cpu.reg_write(self._back, _END | self._thumb)
        self.instructions = self.cycles = self._expected = self._jump = 0
        try:
            self._cpu.emu_start(self._at | self._thumb, _END, count=_MOST)
        except self._failed as error:
            raise ZerorateError(f"machine code stopped: {error}") from error
        if self._cpu.reg_read(self._counter) != _END:
            raise ZerorateError(f"machine code did not end within {_MOST} instructions")
        for i, argument in enumerate(arguments):
            if isinstance(argument, array):
                argument[:] = array("i", self._cpu.mem_read(passed[i], 4 * len(argument)))
        value = self._cpu.reg_read(self._arguments[0])
        return value - (value >> 31 << 32)

    def _given(self, i: int, argument: array[int] | int) -> int:
        if isinstance(argument, int):
            return argument
        self._cpu.mem_write(self.address(i), argument.tobytes())
        return self.address(i)

    def address(self, i: int) -> int:
        """Where argument i lies where it is an array, of this call and of the latest one."""
        return _DATA + _SIZE * i

    def _block(self, cpu: Any, at: int, size: int, _: Any) -> None:
        key = at, size
        if key not in self._blocks:
            code = self._code[at - self._at : at - self._at + size]
            self._blocks[key] = _cycles_of(code, self._processor)
        if self._expected and at != self._expected:
            self.cycles += self._jump
        count, cycles, self._jump = self._blocks[key]
        self.instructions += count
        self.cycles += cycles
        self._expected = at + size


def _cycles_of(code: bytes, processor: str) -> tuple[int, int, int]:
    """(instructions, cycles, further cycles when the last one's condition holds) of a block.

    Cycles of straight Thumb code on a Cortex-M0+ without wait states (ARM DDI 0484C, table 3-1).
    """
    words = [word for _, word in instructions(code, processor)]
    if processor != "thumb":
        return len(words), 0, 0
    return len(words), sum(map(_cycles, words)), int(words[-1] >> 12 == 0b1101)


def _cycles(word: int) -> int:
    registers = (word & 0xFF).bit_count()
    if word >> 12 in (5, 6, 7, 8, 9) or word >> 11 == 9:  # a load or a store
        return 2
    if word >> 9 == 0b1011010:  # push
        return 1 + registers + (word >> 8 & 1)
    if word >> 9 == 0b1011110:  # pop; with pc it jumps
        return 1 + registers + 3 * (word >> 8 & 1)
    if word >> 12 == 0b1100:  # several loads or stores
        return 1 + registers
    if word >> 11 == 0b11110:  # bl
        return 3
    if word >> 11 == 0b11100 or word >> 8 == 0x47:  # b, bx
        return 2
    return 1


def code_in(path: Path) -> bytes:
    """The machine code of a generated file, without the instructions that enter it."""
    words: list[int] = []
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "data":
            words += [ast.literal_eval(word) for word in node.args[1:]]
    code = struct.pack(f"<{len(words)}H", *words)
    return code[len(ENTERED[path.name.partition("_")[0]](0)) :]


def emulated(package: Path, part: str, processor: str) -> Emulated:
    """The part as it stands in the firmware, entered at its code."""
    return Emulated(processor, code_in(package / "native" / f"{processor}_{part}.py"))


# frames of 14 bytes in the 1024 bytes of an MPU-6050's FIFO, of which it loses none at this
AT_ONCE = 64
# by the last of these samples windows in motion are at their longest
_FROM, _TO = 4000, 7200
_EFFECTS_TO = 1000


def native_cost(work: Workload) -> dict[str, dict[str, Any]]:
    """Processor -> figures of one sample alone and in bursts. Raises MissingRuntime.

    Each figure: instructions (mean), instructions_c (mean, C -O2), median and worst, and for the
    Cortex-M0+ cycles, cycles_worst. Raises ZerorateError if the states of both differ.
    """
    ways = {"alone": 1, "bursts": AT_ONCE}
    return {p: {how: _against_c(work, p, n) for how, n in ways.items()} for p in PROCESSORS}


@cache
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
    frames = recording.between(0, _TO).samples().astype(np.int32)
    motion, gravity = motion_settings(), gravity_settings()
    states = {
        "motion": (motion_state(motion), motion),
        "gravity": (gravity_state(gravity), gravity),
    }
    code = {part: emulated(firmware_package(), part, "thumb") for part in states}
    return {part: _cost(code[part], *arrays, frames, _FROM) for part, arrays in states.items()}


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


def _of_slots(scales: Scales, terms: Sequence[Term], frames: NDArray[np.int32]) -> dict[str, float]:
    code = emulated(firmware_package(), "effects", "thumb")
    corrector, effects = Corrector(sensor_for(scales)), EffectModel()
    model = build_model([Slot(t, (0.01 / 25**t.power,) * 3, "") for t in terms], scales)
    if effects.load(encoded(model), corrector.sensor) != LOADED:
        raise ZerorateError("the firmware refuses the model whose cost is asked for")
    for i in range(len(effects.channels)):
        effects.channel(i, 5010)
    return _cost(code, corrector.state, effects.e, frames)


def _cost(
    code: Emulated, a: array[int], b: array[int], frames: NDArray[np.int32], first: int = 0
) -> dict[str, float]:
    """Of calls with each frame, counted from the first of them on."""
    counts = []
    for row in frames:
        code(a, b, array("i", row.tobytes()), 10000)
        counts.append((code.instructions, code.cycles))
    instructions, cycles = zip(*counts[first:])
    return {"instructions": mean(instructions), "cycles": mean(cycles), "cycles_worst": max(cycles)}


def _against_c(work: Workload, processor: str, at_once: int) -> dict[str, Any]:
    package = firmware_package()
    yardstick = machine_code(Kernels(package), "rest", processor, fast=True)
    state, counts, cycles = _run(emulated(package, "rest", processor), work, at_once)
    state_c, counts_c, _ = _run(Emulated(processor, yardstick), work, at_once)
    if state != state_c:
        raise ZerorateError(f"two compilations of rest differ on {processor}: nothing compared")
    found: dict[str, Any] = {"instructions": mean(counts), "instructions_c": mean(counts_c)}
    found |= {"median": median(counts), "worst": max(counts)}
    if processor == "thumb":
        found |= {"cycles": median(cycles), "cycles_worst": max(cycles)}
    return found


def _run(code: Emulated, work: Workload, at_once: int) -> tuple[bytes, list[float], list[float]]:
    """Final state, and instructions and cycles of a sample of each call."""
    state, settings = (array("i", words.tobytes()) for words in (work.state, work.settings))
    counts, cycles = [], []
    for first in range(0, CYCLE, at_once):
        rows = work.rows[first : min(first + at_once, CYCLE)]
        if at_once == 1:
            code(state, settings, array("i", rows[0, 1:].tobytes()), int(rows[0, 0]))
        else:
            code(state, settings, array("i", rows.tobytes()), BURST + len(rows))
        counts.append(code.instructions / len(rows))
        cycles.append(code.cycles / len(rows))
    return state.tobytes(), counts, cycles
