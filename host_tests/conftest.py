"""What every area's tests stand on: interpreters, browser, the checkout, the real recordings."""

import functools
import os
import shutil
import sys
from dataclasses import dataclass
from pathlib import Path

# Matrices here are small: threads wait for each other, at three times the processor's time.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import hypothesis
import numpy as np
import pytest
from zerorate_bench.boards.pico import VARIABLE, find_pico
from zerorate_bench.boards.pico import boards_folder as named_folder
from zerorate_tools import cli
from zerorate_tools.errors import MissingRuntime
from zerorate_tools.model import Slot, build_model, write_model
from zerorate_tools.model.term import Term
from zerorate_tools.recordings import Scales
from zerorate_tools.runtimes import NAMES, available, find, how_to_get

_REPOSITORY = Path(__file__).resolve().parents[1]
_CHROMIUM = "chromium"
_CHROMIUMS = (_CHROMIUM, "chromium-browser", "google-chrome")
_NO_BROWSER = "install the system's package chromium"
_BOARDS = "boards"
_REQUIRED = frozenset(filter(None, os.environ.get("ZERORATE_REQUIRE", "").split(",")))

# What else is not of this project may lie beside the checkout, as the real recordings do.
if (_REPOSITORY.parent / "shared" / "boards").is_dir():
    os.environ.setdefault(VARIABLE, str(_REPOSITORY.parent / "shared" / "boards"))

# Hundreds of commands run in this process; it is the same for each.
cli.parser = functools.cache(cli.parser)

# No limits by the clock: machines differ, and are busy.
hypothesis.settings.register_profile("zerorate", deadline=None)
hypothesis.settings.load_profile("zerorate")


def pytest_configure():
    # where a machine asks for no bytecode each of hundreds of children would compile all it imports
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
    sys.dont_write_bytecode = False
    known = (*NAMES, _CHROMIUM, _BOARDS)
    unknown = _REQUIRED - set(known)
    if unknown:
        raise pytest.UsageError(f"ZERORATE_REQUIRE names {sorted(unknown)}; known: {known}")


def pytest_terminal_summary(terminalreporter):
    left_out = [name for name in NAMES if name not in available()]
    if not left_out:
        terminalreporter.write_line("interpreters: all of " + ", ".join(NAMES))
    for name in left_out:
        terminalreporter.write_line(f"interpreter left out: {name}; {how_to_get(name)}")
    try:
        find_pico()
    except MissingRuntime as missing:
        terminalreporter.write_line(f"emulated Pico left out: {missing}")
    if _browser() is None:
        terminalreporter.write_line(f"browser left out: {_CHROMIUM}; {_NO_BROWSER}")


def _browser():
    return next(filter(None, map(shutil.which, _CHROMIUMS)), None)


@dataclass(frozen=True)
class MatrixModel:
    """A model.bin of scale factors and axes: the error (3, 3) that it takes out, and rates."""

    path: Path
    error: np.ndarray
    lsb_per_dps: float
    rates_dps: np.ndarray


def matrix_slots(error):
    """Three rate slots that take the error (3, 3) out."""
    terms = [Term(f"rate_{axis}", -250.0, 250.0) for axis in "xyz"]
    return [Slot(term, tuple(column), "scale-factor") for term, column in zip(terms, error.T)]


@pytest.fixture
def matrix_model(tmp_path):
    """A MatrixModel; its rates (500, 3) change with every sample."""
    error = np.array([[0.01, 0.002, -0.003], [0.004, -0.02, 0.001], [0.0, 0.005, 0.006]])
    scales = Scales("MPU-6050", 100.0, 131.0, 16384.0, None, None)
    write_model(build_model(matrix_slots(error), scales), tmp_path)
    rates = np.random.default_rng(1).uniform(-240, 240, (500, 3))
    return MatrixModel(tmp_path / "model.bin", error, 131.0, rates)


@pytest.fixture(scope="session")
def chromium():
    """The path of this machine's Chromium."""
    path = _browser()
    if path is None and _CHROMIUM in _REQUIRED:
        pytest.fail(f"{_CHROMIUM} is named in ZERORATE_REQUIRE: {_NO_BROWSER}", pytrace=False)
    return path or pytest.skip(f"no Chromium here; {_NO_BROWSER}")


@pytest.fixture(scope="session")
def browser(chromium):
    """A Chromium that calls nobody; one for all, as a second driver beside it does not start."""
    playwright = pytest.importorskip("playwright.sync_api")
    quiet = ["--disable-background-networking", "--disable-component-update", "--disable-sync"]
    with playwright.sync_playwright() as driver:
        browser = driver.chromium.launch(
            executable_path=chromium, args=["--disable-gpu", "--no-first-run", *quiet]
        )
        yield browser
        browser.close()


def interpreter(name):
    """The interpreter, or a skip that says how to get it; a failure where it is required."""
    return _found(name, lambda: find(name))


def _found(name, sought):
    try:
        return sought()
    except MissingRuntime as missing:
        if name in _REQUIRED:
            pytest.fail(f"{name} is named in ZERORATE_REQUIRE: {missing}", pytrace=False)
        pytest.skip(str(missing))


@pytest.fixture(scope="session", params=NAMES)
def runtime(request):
    """Each of the four interpreters on which the firmware's state must be the same."""
    return interpreter(request.param)


@pytest.fixture(scope="session", params=[name for name in NAMES if name != "cpython"])
def micropython(request):
    """Each of the three MicroPythons."""
    return interpreter(request.param)


@pytest.fixture(scope="session")
def find_runtime():
    """The function that finds an interpreter by name, skipping or failing as the others do."""
    return interpreter


@pytest.fixture(scope="session")
def boards_folder():
    """The folder of boards' firmware and tools that ZERORATE_BOARDS names."""
    return _found(_BOARDS, named_folder)


@pytest.fixture(scope="session")
def pico_parts():
    """What an emulated Pico is made of."""
    return _found(_BOARDS, find_pico)


@pytest.fixture(scope="session")
def repository():
    """The checkout's folder."""
    return _REPOSITORY


@pytest.fixture(scope="session")
def real_data():
    """The folder of real recordings: $ZERORATE_DATA, else shared/data beside the checkout."""
    from zerorate_bench.public_data import data_folder

    return data_folder() or pytest.skip("no real recordings; ZERORATE_DATA names their folder")
