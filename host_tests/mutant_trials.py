"""Runs the tests of mutants: a fork for each, in which its text stands in the place of its file."""

import importlib.abc
import importlib.machinery
import importlib.util
import os
import signal
import sys
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[1]
# Tests in other processes, and two that take long and see little that others do not.
NOT_IN_PROCESS = " and ".join(
    "not " + name
    for name in (
        *("micropython", "heap", "runtime", "last_byte", "any_slot", "no_intermediate"),
        *("signal_at_any_rename", "end_by_a_signal"),
    )
)
# What no mutant is in, and each process would else load anew.
LOADED_ONCE = (
    *("hypothesis.strategies", "hypothesis.internal.conjecture.engine"),
    *("_hypothesis_pytestplugin", "numpy", "pyarrow.parquet", "pyarrow.csv"),
)


class InPlaceOf(importlib.abc.MetaPathFinder, importlib.machinery.SourceFileLoader):
    """Loads a text in the place of a module's file."""

    def __init__(self, path, text):
        super().__init__("", str(path))
        self._file, self._text = path, text

    def find_spec(self, name, path=None, target=None):
        found = importlib.machinery.PathFinder.find_spec(name, path)
        if found is None or found.origin is None or Path(found.origin) != self._file:
            return None
        self.name = name
        return importlib.util.spec_from_file_location(name, self._file, loader=self)

    def get_code(self, fullname):
        return compile(self._text, self._file, "exec")


def put_in_place(path, text):
    """Let this process see the text in the place of the file, wherever it is loaded or read."""
    sys.meta_path.insert(0, InPlaceOf(path, text))
    plain = Path.read_text
    Path.read_text = lambda self, *how, **more: text if self == path else plain(self, *how, **more)


def _end_of(forked, seconds):
    """How a fork ends: passed, killed (what it calls fails), slow (seconds of processor)."""
    child = os.fork()
    if child == 0:
        signal.alarm(8 * seconds)
        signal.setitimer(signal.ITIMER_PROF, seconds)
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        os.dup2(1, 2)
        try:
            os._exit(int(forked()))
        finally:
            os._exit(1)
    _, status = os.waitpid(child, 0)
    if os.WIFSIGNALED(status):
        return "slow" if os.WTERMSIG(status) in (signal.SIGALRM, signal.SIGPROF) else "killed"
    return "killed" if os.WEXITSTATUS(status) else "passed"


def _fail(tests):
    quiet = ["-q", "-x", "-p", "no:cacheprovider", "-p", "no:xdist", "-k", NOT_IN_PROCESS]
    return pytest.main([*quiet, *tests]) != 0


def ends(tests, drawn):
    """{number: how it ends} of drawn, {number: (file, mutated text)}."""
    for name in LOADED_ONCE:
        importlib.import_module(name)
    before_s = os.times().children_user
    if _end_of(lambda: _fail(tests), 600) != "passed":
        raise SystemExit("the tests fail as they are")
    patience_s = int(2 * (os.times().children_user - before_s)) + 5

    def mutated(file, text):
        put_in_place(REPOSITORY / file, text)
        return _fail(tests)

    return {n: _end_of(lambda of=of: mutated(*of), patience_s) for n, of in drawn.items()}
