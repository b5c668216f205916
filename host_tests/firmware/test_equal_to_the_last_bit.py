"""One trace gives one state and one bias for every sample, whoever runs the firmware."""

import ast
import json

import numpy as np
import pytest
from zerorate_tools.viper_twins import hot_functions, kernel_files

from . import trace
from .trace_on_host import GOLDEN, checksums, on_numba

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
    same(trace_on(micropython, "plain", mode), trace_on_host(mode))


@modes
def test_viper_gives_what_cpython_gives_and_allocates_nothing(
    viper_runtime, mode, trace_on, trace_on_host
):
    same(trace_on(viper_runtime, "viper", mode), trace_on_host(mode))


def test_the_kernels_that_numba_compiled_give_what_cpython_gives(trace_on_host):
    for mode in trace.MODES:  # in one test, for compiling them takes a while
        same(on_numba(mode), trace_on_host(mode))


@modes
def test_the_numbers_are_those_that_were_committed(mode, trace_on_host):
    golden = json.loads(GOLDEN.read_text(encoding="utf-8"))
    assert checksums(*trace_on_host(mode)) == golden[mode], (
        "the firmware gives other numbers; if that is meant: python -m host_tests.golden"
    )


def test_a_difference_of_one_bit_in_one_bias_is_found(trace_on_host):
    state, biases = trace_on_host("every")
    turned = bytearray(biases)
    turned[12 * 1234] ^= 1
    with pytest.raises(AssertionError, match="sample 1234"):
        same((state, bytes(turned)), (state, biases))


def negated_locals(tree):
    """Names that an expression negates, but for `x = -x`: in viper that may change the name."""
    own = {id(n.value) for n in ast.walk(tree) if isinstance(n, ast.Assign)}
    for node in ast.walk(tree):
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub) and id(node) not in own:
            if isinstance(node.operand, ast.Name) and not node.operand.id.isupper():
                yield f"{node.operand.id} in line {node.lineno}"


def test_no_kernel_negates_a_local_within_an_expression(repository):
    for file in kernel_files(repository / "firmware" / "zerorate"):
        tree = ast.parse(file.read_text(encoding="utf-8"))
        hot = [n for n in tree.body if getattr(n, "name", "") in hot_functions(file)]
        assert hot
        assert [name for function in hot for name in negated_locals(function)] == [], file.name


def test_viper_may_change_a_local_that_an_expression_negates(viper_runtime):
    script = """
import micropython
@micropython.viper
def negated(h: int) -> int:
    x = 1 if -h < 0 else 0
    return h
print(negated(3))
"""
    assert viper_runtime.run(script, check=True).stdout.strip() == "-3"
