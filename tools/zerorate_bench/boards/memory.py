"""Heap on an emulated Pico: what imports and objects keep, and the least that a program runs in."""

import ast
import time

import serial
from zerorate_tools.boards.connection import connected, told

from .pico import EmulatedPico

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
_STEP = 1024
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
            said = told(board, _MEASURED.format(options=options, more=more, aside=aside))
        found.append(ast.literal_eval(said.splitlines()[-1]))
    return min(kept for kept, _ in found), min(took_us for _, took_us in found) / 1e6


def least_heap(pico: EmulatedPico, program: str, sign: str, low: int, high: int) -> int:
    """The smallest heap in steps of 1 KiB, low < it <= high, in which program prints `sign`.

    program becomes main.py, and a boot.py takes all but so much of the heap. Raises ValueError
    where it does not run in `high`.
    """
    if not runs_in(pico, program, sign, high):
        raise ValueError(f"the program does not run in {high} bytes of heap")
    while high - low > _STEP:
        middle = (low + high) // 2 // _STEP * _STEP
        if runs_in(pico, program, sign, middle):
            high = middle
        else:
            low = middle
    return high


def runs_in(pico: EmulatedPico, program: str, sign: str, heap: int) -> bool:
    """Whether the program prints `sign` before an error, on a board of that heap."""
    with connected(pico.port, go_on=False) as board:
        board.exec(
            "import os\nfor n in ('learned.bin',):\n try: os.remove(n)\n except OSError: pass"
        )
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
