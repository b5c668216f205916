"""What the firmware takes on the emulated board: time, stack, heap and flash."""

import ast
import tempfile
import time
from bisect import bisect_left
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np
import serial
from zerorate_tools.boards.connection import connected, output_of
from zerorate_tools.boards.flashing import flash
from zerorate_tools.errors import MissingRuntime
from zerorate_tools.kernels.reading import firmware_package
from zerorate_tools.model import Slot, build_model, encoded
from zerorate_tools.model.term import Term
from zerorate_tools.recordings import Scales

from ..limits import Limit, limits_table, verdicts
from ..tables import measured, number, table
from ..workload import CYCLE, Workload, workload
from .pico import CORE_HZ, EmulatedPico, Play, Played, find_pico, on_host, on_pico

_MEASURED = """
import gc, time
aside = bytearray({aside})
gc.collect()
before = gc.mem_alloc()
begun = time.ticks_us()
from zerorate import Corrector, Sensor
from zerorate_i2c.mpu6050 import MPU6050
took_us = time.ticks_diff(time.ticks_us(), begun)
kept = [Corrector({options})]
{more}
gc.collect()
print(repr((gc.mem_alloc() - before, took_us)))
"""
_EVERYTHING = """
from zerorate.bursts import Bursts
from zerorate.checked import CheckedCorrector
from zerorate.storage.learned_store import LearnedStore
from zerorate.model import EffectModel
from zerorate.storage.save_schedule import SaveSchedule
from zerorate.storage.places import FileStorage
from zerorate_i2c.board import setup
from zerorate_i2c.data_ready import DataReady
from zerorate_i2c.fifo import Fifo
from zerorate_i2c.self_test import self_test
model = EffectModel()
kept[0].use_model(model)
model.refine()
kept[0].explain()
store = LearnedStore(FileStorage("learned.bin"), bytes(4), kept[0])
kept += [model, Bursts(kept[0]), CheckedCorrector(kept[0]), store, SaveSchedule(store, 3, 13)]
"""
#: What is measured -> options of the Corrector, and what else there is.
CONFIGURATIONS = {
    "rest": ("motion=False, gravity=False", ""),
    "all": ("", ""),
    "everything": ("", _EVERYTHING),
    "motion": ("gravity=False", ""),
    "gravity": ("motion=False", ""),
    "effects": (
        "motion=False, gravity=False",
        "from zerorate.model import EffectModel\nkept[0].use_model(EffectModel())",
    ),
}
_BOOT = """
import gc
gc.collect()
hog = bytearray(gc.mem_free() + gc.mem_alloc() - {heap})
"""
_KB = 1024
_ASIDE = (0, 1000, 3000)
_PATIENCE_S = 300


def heap_and_import(pico: EmulatedPico, configuration: str) -> tuple[int, float]:
    """Bytes of heap that a configuration keeps, and seconds of the first import.

    A collector that looks for pointers in machine code, too, keeps up to 3 KB by chance: the least
    of three places in the heap is what is kept for a reason.
    """
    options, more = CONFIGURATIONS[configuration]
    found = []
    for aside in _ASIDE:
        with connected(pico.port) as board:
            said = output_of(board, _MEASURED.format(options=options, more=more, aside=aside))
        found.append(ast.literal_eval(said.splitlines()[-1]))
    return min(kept for kept, _ in found), min(took_us for _, took_us in found) / 1e6


def least_heap(pico: EmulatedPico, program: str, sign: str, low: int, high: int) -> int:
    """The smallest heap in steps of 1 KiB, low < it <= high, in which program prints `sign`.

    program becomes main.py, and a boot.py takes all but so much of the heap. Raises ValueError
    where it does not run in `high`.
    """
    heaps = range((low // _KB + 1) * _KB, high + 1, _KB)
    at = bisect_left(heaps, True, key=lambda heap: runs_in(pico, program, sign, heap))
    if at == len(heaps):
        raise ValueError(f"the program does not run in {high} bytes of heap")
    return heaps[at]


def runs_in(pico: EmulatedPico, program: str, sign: str, heap: int) -> bool:
    """Whether the program prints `sign` before an error, on a board of that heap."""
    with connected(pico.port, go_on=False) as board:
        board.exec("import os\ntry: os.remove('learned.bin')\nexcept OSError: pass")
        board.fs_writefile("main.py", program.encode(), chunk_size=1024)
        board.fs_writefile("boot.py", _BOOT.format(heap=heap).encode(), chunk_size=1024)
    try:
        return _says(pico, sign)
    finally:
        with connected(pico.port) as board:
            board.exec("import os\nos.remove('boot.py'); os.remove('main.py')")


def _says(pico: EmulatedPico, sign: str) -> bool:
    until = time.monotonic() + _PATIENCE_S
    said = b""
    with serial.Serial(pico.port, timeout=0.2) as console:
        pico.ask("power")
        while time.monotonic() < until:
            said += console.read(4096)
            if sign.encode() in said:
                return True
            if b"Error" in said:
                return False
    return False


#: Samples of each mode that is compared; the workload's own cycle is the first.
_COMPARED = 1200
_BURST = 64
_FROZEN_ROWS = 400
_ODR_HZ = 1000
_PROGRAM = Path("examples/keep.py")
_SIGN = "kept"
#: An image with this firmware frozen into it, where the boards' folder has one.
_FROZEN = "FROZEN-*.bin"
_HEAPS = (24 * _KB, 88 * _KB)

LIMITS = (
    Limit("heap of import, driver, object", 28 * _KB, "bytes", lambda f: f["heap_bytes"]["rest"]),
    Limit("heap with motion and gravity", 45 * _KB, "bytes", lambda f: f["heap_bytes"]["all"]),
    Limit("heap with everything", 80 * _KB, "bytes", lambda f: f["heap_bytes"]["everything"]),
    Limit("least heap of the second program", 48 * _KB, "bytes", lambda f: f["least_heap_bytes"]),
    Limit("median sample", 1600, "cycles", lambda f: f["cycles"]["median"]),
    Limit("worst sample", 14000, "cycles", lambda f: f["cycles"]["worst"]),
    Limit("a sample in bursts of 64", 500, "cycles", lambda f: f["cycles"]["burst"]),
    Limit("share of 125 MHz at 1 kHz", 1.3, "%", lambda f: f["share_percent"]),
    Limit("import of what flash sends", 0.15, "s", lambda f: f["import_s"]),
    Limit("sent by flash", 42 * _KB, "bytes", lambda f: f["flash_bytes"]),
)


def run() -> dict[str, Any]:
    """The figures, from an emulated Pico. Raises MissingRuntime where none can be had."""
    parts = find_pico()
    found: dict[str, Any] = {"firmware": parts.firmware.name}
    with tempfile.TemporaryDirectory(prefix="zerorate-pico-") as folder:
        with EmulatedPico(parts, link=Path(folder) / "tty") as pico:
            flashed = flash(pico.port, say=lambda line: None)
            found["board"], found["flash_bytes"] = str(flashed.facts), flashed.sent_bytes
            rest, found["import_s"] = heap_and_import(pico, "rest")
            program = (firmware_package().parents[1] / _PROGRAM).read_text(encoding="utf-8")
            found["least_heap_bytes"] = least_heap(pico, program, _SIGN, *_HEAPS)
            flash(pico.port, say=lambda line: None, parts=["all"])
            others = measured([name for name in CONFIGURATIONS if name != "rest"])
            found["heap_bytes"] = {"rest": rest} | {n: heap_and_import(pico, n)[0] for n in others}
            ends = {n: _same(pico, p) for n, p in measured(plays(workload()).items())}
    found["golden"] = {name: same for name, (same, _) in ends.items()}
    alone, by_object, bursts = (ends[name][1].cycles for name in ("rest", "object", "bursts"))
    found["cycles"] = {
        **{"median": float(median(alone)), "worst": max(alone)},
        **{"object_median": float(median(by_object)), "object_worst": max(by_object)},
        "burst": sum(bursts) / len(bursts) / _BURST,
    }
    found["share_percent"] = 100 * sum(alone) / len(alone) * _ODR_HZ / CORE_HZ
    found["frozen"] = {}
    with suppress(MissingRuntime), EmulatedPico(find_pico(_FROZEN)) as pico:
        some = plays(workload(_FROZEN_ROWS))
        found["frozen"] = {name: _same(pico, play)[0] for name, play in some.items()}
    return found | {"limits": verdicts(found, LIMITS)}


def _same(pico: EmulatedPico, play: Play) -> tuple[bool, Played]:
    """Whether it ends as on this host, and how it went."""
    played = on_pico(pico, play)
    return played.data == on_host(play).data, played


def plays(work: Workload) -> dict[str, Play]:
    """Mode -> what is run in it."""
    few = work.rows[:_COMPARED]
    alone = Play(work.rows[:CYCLE], state=work.state)
    return {
        "rest": replace(alone, at_once=0),
        "object": alone,
        "bursts": replace(alone, rows=work.rows[: CYCLE // _BURST * _BURST], at_once=_BURST),
        "every": Play(few, {"every": True}),
        "document": Play(few, {"document": True}),
        "motion": Play(_turning(few), {"gravity": False}),
        "motion and gravity": Play(_turning(few), {}),
        "effects, refined": Play(few, model=model()),
    }


def _turning(rows: np.ndarray) -> np.ndarray:
    """The rows with a motion of tens of degrees a second and the gravity that turns with it."""
    turned = rows.copy()
    phase = np.arange(len(rows)) / 100.0
    for axis in range(3):
        turned[:, 5 + axis] += (6000 * np.sin(2.1 * phase + 2 * axis)).astype(np.int32)
        turned[:, 1 + axis] += (4000 * np.sin(2.1 * phase + axis)).astype(np.int32)
    return np.clip(turned, -32000, 32000)


def model() -> bytes:
    """An effect model of two slots for the sensor of the plays."""
    slots = [
        Slot(Term("temp", 20, 45, 32.5, power=2), (0.001, -0.002, 0.0003)),
        Slot(Term("temp", 20, 45, 32.5), (0.004, 0.001, -0.002)),
    ]
    return encoded(build_model(slots, Scales("MPU-6050", 100.0, 131.0, 16384.0, 340.0, 36.53)))


def in_markdown(found: Mapping[str, Any]) -> str:
    """What it must be, heap by part, and the modes that gave equal numbers."""
    heap = table(["with", "heap, bytes"], [[k, number(v)] for k, v in found["heap_bytes"].items()])
    said, frozen = {None: "no image here", True: "yes", False: "**no**"}, found["frozen"]
    modes = [[m, said[same], said[frozen.get(m)]] for m, same in found["golden"].items()]
    same = table(["mode", "to the last bit as on the host", "frozen into the image"], modes)
    head = f"# {found['board']}\n\nEmulated, with {found['firmware']}.\n"
    return "\n".join([head, limits_table(found["limits"]), heap, same])
