"""The trace ends in the same bits on every interpreter, and takes nothing from the heap."""

import json
import re
from array import array
from binascii import crc32
from pathlib import Path

import numpy as np
import pytest
from zerorate import Corrector, Sensor
from zerorate.effects import effects
from zerorate.model import EffectModel
from zerorate_bench.cost_report import import_heap_bytes
from zerorate_tools.layout import (
    EFFECTS,
    PLAY,
    SLOT,
    STATE,
    slot_at,
)

from . import swung, trace
from .played import IMPORT_BYTES, STATE_BYTES
from .simulated_sources import EVERY_SLOT, every_slot_bin
from .trace_on_host import GOLDEN, checksums, on_machine_code, where_it_parts

modes = pytest.mark.parametrize("mode", sorted(trace.MODES))


def same(one, other):
    """Assert equal (state, biases) and say where they part."""
    for name, a, b, words in zip(("sample", "word of the state"), one[::-1], other[::-1], (3, 1)):
        a, b = (np.frombuffer(x, np.int32).reshape(-1, words) for x in (a, b))
        assert a.shape == b.shape
        apart = np.flatnonzero((a != b).any(axis=1))
        assert not len(apart), f"{name} {apart[0]}: {a[apart[0]]} and {b[apart[0]]}"


# In every form on the quickest; the form that boards run is played on all in test_sources_together.
@pytest.mark.parametrize(
    ("name", "mode"),
    [*(("x86", mode) for mode in sorted(trace.MODES)), ("wasm", "ignoring"), ("armhf", "ignoring")],
)
def test_bytecode_gives_what_cpython_gives_and_allocates_nothing(
    find_runtime, name, mode, trace_on, trace_on_host
):
    same(trace_on(find_runtime(name), mode), trace_on_host(mode))


def test_the_kernels_that_are_compiled_give_what_cpython_gives(trace_on_host):
    for mode in trace.MODES:  # in one test, for compiling them takes a while
        same(on_machine_code(mode), trace_on_host(mode))


@modes
def test_the_numbers_are_those_that_were_committed(mode, trace_on_host):
    golden = json.loads(GOLDEN.read_text(encoding="utf-8"))
    assert checksums(*trace_on_host(mode)) == golden[mode], (
        f"the firmware gives other numbers, {where_it_parts(mode, *trace_on_host(mode))}; "
        "if that is meant: python -m host_tests.golden"
    )


@pytest.mark.parametrize("source", swung.SOURCES)
def test_the_numbers_of_a_device_that_swings_are_those_that_were_committed(source):
    golden = json.loads(swung.GOLDEN.read_text(encoding="utf-8"))[source]
    parts = [n for n, (a, b) in enumerate(zip(golden, swung.checksums(source))) if a != b]
    assert not parts, f"other numbers in parts {parts[:3]}; if that is meant: -m host_tests.golden"


_HERE = Path(__file__).parent
UPDATES = 4000
EFFECTS_CRC = 1018273669


@pytest.fixture(scope="module")
def model_bin():
    return every_slot_bin()


@pytest.fixture(scope="module")
def on_host(model_bin):
    """(UPDATES, 3) effects and the final array, by CPython."""
    model = EffectModel()
    assert model.load(model_bin, Sensor(4.0)) == 0
    state, frame, out = array("i", [0] * STATE.FIT_WEIGHTS), array("i", [0] * 7), []
    did = set()
    for k in range(UPDATES):
        frame[:] = array("i", [(k * (i + 3) * 7919 >> 3) % 9001 - 4500 for i in range(7)])
        frame[3] = 6000 - abs(k * 6 - 12000)
        model.channel("vdd_mv", 5000 + k % 97)
        effects.sense(state, model.e, frame, 3000000 if k % 211 == 0 else 250000, int(k % 13 > 0))
        out.append(state[STATE.EFFECT_Q8 : STATE.EFFECT_Q8 + 3])
        did |= {i for i in range(len(EVERY_SLOT)) if model.e[slot_at(i) + SLOT.SLOT_VALUE]}
    assert did == set(range(len(EVERY_SLOT)))
    first, second = (EFFECTS.PLAYS + PLAY.size * i + PLAY.PLAY_STATE for i in range(2))
    assert model.e[first] != model.e[second] != 0
    return np.array(out), np.array(model.e)


def test_the_effects_are_those_that_were_committed(on_host):
    """To the last bit: what the references see within a tolerance is here held exactly."""
    assert crc32(on_host[0].astype("<i4").tobytes()) == EFFECTS_CRC, (
        "the effects are other numbers; if that is meant, say so here"
    )


def test_bytecode_gives_the_effects_that_cpython_gives(micropython, repository, model_bin, on_host):
    result = micropython.run(
        _HERE / "on_micropython" / "parts_without_heap.py",
        ["effects"],
        modules=[repository / "firmware"],
        files_in={"model.bin": model_bin},
        files_out=["out.bin"],
        check=True,
    )
    wanted = np.concatenate([part.ravel() for part in on_host])
    np.testing.assert_array_equal(np.frombuffer(result.files["out.bin"], "<i4"), wanted)


def test_the_state_of_three_axes_stays_within_its_limit(capsys):
    size = len(Corrector().state) * 4
    with capsys.disabled():
        print(f"\nstate of three axes: {size} bytes")
    assert 0 < size <= STATE_BYTES


def test_importing_the_firmware_takes_no_more_heap_than_it_may(find_runtime, repository, capsys):
    find_runtime("wasm")
    taken = import_heap_bytes(repository / "firmware")
    source = (repository / "firmware" / "zerorate" / "corrector.py").read_text()
    held = int(re.search(r"^_held = \[bytearray\((\d+)\)\]$", source, re.MULTILINE)[1])
    with capsys.disabled():
        print(f"\nheap of `import zerorate` on wasm: {taken} bytes, {held} of them held")
    assert 8192 < taken - held <= IMPORT_BYTES
