"""One trace gives one state and one bias for every sample, whoever runs the firmware."""

import json

import numpy as np
import pytest
from zerorate_tools.layout import GRAVITY, MOTION, STATE

from . import swung, trace
from .trace_on_host import GOLDEN, checksums, on_machine_code, where_it_parts

modes = pytest.mark.parametrize("mode", sorted(trace.MODES))


def same(one, other):
    """Assert equal (state, biases) and say where they part."""
    for name, a, b, words in zip(("sample", "word of the state"), one[::-1], other[::-1], (3, 1)):
        a, b = (np.frombuffer(x, np.int32).reshape(-1, words) for x in (a, b))
        assert a.shape == b.shape
        apart = np.flatnonzero((a != b).any(axis=1))
        assert not len(apart), f"{name} {apart[0]}: {a[apart[0]]} and {b[apart[0]]}"


@modes
def test_bytecode_gives_what_cpython_gives_and_allocates_nothing(
    micropython, mode, trace_on, trace_on_host
):
    same(trace_on(micropython, mode), trace_on_host(mode))


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


def test_where_the_numbers_part_from_those_committed_is_said(trace_on_host):
    state, biases = map(bytearray, trace_on_host("every"))
    assert where_it_parts("every", state, biases).startswith("no bias differs; 0 words")
    state[4 * STATE.OUT_Q8] ^= 1
    biases[12 * 1234] ^= 1
    said = where_it_parts("every", state, biases)
    assert said.startswith("first at samples 1216 and on; 1 words of the state: OUT_Q8[0] ")


def test_a_difference_of_one_bit_in_one_bias_is_found(trace_on_host):
    state, biases = trace_on_host("every")
    turned = bytearray(biases)
    turned[12 * 1234] ^= 1
    with pytest.raises(AssertionError, match="sample 1234"):
        same((state, bytes(turned)), (state, biases))


@pytest.mark.parametrize("source", swung.SOURCES)
def test_the_numbers_of_a_device_that_swings_are_those_that_were_committed(source):
    golden = json.loads(swung.GOLDEN.read_text(encoding="utf-8"))[source]
    parts = [n for n, (a, b) in enumerate(zip(golden, swung.checksums(source))) if a != b]
    assert not parts, f"other numbers in parts {parts[:3]}; if that is meant: -m host_tests.golden"


def test_a_device_that_swings_is_known_in_motion_and_against_gravity():
    for source, bias, within_lsb in (
        ("motion", MOTION.MOTION_BIAS_Q8, 40),
        ("gravity", GRAVITY.GRAVITY_BIAS_Q8, 260),
    ):
        update, state, settings = swung.SOURCES[source]()
        for frame, dt_us in swung.frames():
            update(state, settings, frame, dt_us)
        found_lsb = np.array(state[bias : bias + 3]) / 256
        assert np.abs(found_lsb - swung.BIAS_LSB).max() < within_lsb, source
