"""What the firmware's tests stand on: the trace on every interpreter, run once each."""

from functools import cache, lru_cache
from pathlib import Path

import numpy as np
import pytest
from zerorate_fakes.memory import FakeMemory

from . import trace
from .simulated_sources import columns, tick_means
from .trace_on_host import on_cpython

_HERE = Path(__file__).parent


@pytest.fixture(scope="session")
def trace_on_host():
    """trace_on_host(mode) -> (final state, bias of every sample), bytes, by CPython."""
    return lru_cache(maxsize=None)(on_cpython)


@pytest.fixture(scope="session")
def trace_on(repository):
    """trace_on(runtime, mode) -> the same by a MicroPython whose heap is locked.

    Raises ZerorateError where anything was allocated.
    """

    @cache
    def run(runtime, mode):
        result = runtime.run(
            _HERE / "on_micropython" / "trace_without_heap.py",
            [mode, trace.UPDATES[mode]],
            modules=[repository / "firmware", _HERE],
            files_out=["state.bin", "bias.bin"],
            check=True,
        )
        return result.files["state.bin"], result.files["bias.bin"]

    return run


@pytest.fixture(scope="session")
def warm_up():
    """The simulated columns of hours, and their means by tick."""
    raw = columns()
    return raw, tick_means(raw)


@pytest.fixture
def memory():
    """Storage for what was learned, erased."""
    return FakeMemory(4096)


@pytest.fixture(params=range(4))
def draw(request):
    """A generator of random numbers; each test is run with four."""
    return np.random.default_rng(request.param)
