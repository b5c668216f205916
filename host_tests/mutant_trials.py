"""Runs the tests of mutants: a fork for each, in which its text stands in the place of its file.

The tests that reach a mutant's line run first, the fastest first of all. If they pass, all others
run, too: what the C that is made of a kernel does is not seen here.
"""

import contextlib
import importlib.abc
import importlib.machinery
import importlib.util
import json
import os
import signal
import sys
import tempfile
import time
from collections import Counter, defaultdict
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[1]
# Tests in other processes, and two that take long and see little that others do not.
# (An interpreter reads the file as it is, and so would tell any mutant from it.)
NOT_IN_PROCESS = " and ".join(
    "not " + name
    for name in (
        *("micropython", "bytecode", "heap", "runtime", "last_byte", "any_slot", "no_intermediate"),
        *("every_interpreter", "signal_at_any_rename", "end_by_a_signal"),
    )
)

# Of a function, in which a test's lines are looked for: a line that it reaches later only changes
# which tests run first.
_CALLS = 2000


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


class Reach:
    """A plugin of pytest: which lines of some files each test reaches, and its seconds."""

    def __init__(self, files, written):
        self._files, self.written = set(map(str, files)), written
        self.lines = defaultdict(set)  # (test, file) -> lines
        self.took_s = {}
        self._test, self._left, self._calls = "", {}, Counter()

    def _enter(self, frame, event, arg):
        code = frame.f_code
        if code.co_filename not in self._files:
            return None
        if code not in self._left:
            self._left[code] = {line for *_, line in code.co_lines() if line}
        self._calls[code] += 1
        return self._go if self._left[code] and self._calls[code] < _CALLS else None

    def _go(self, frame, event, arg):
        left = self._left[frame.f_code]
        if frame.f_lineno in left:
            left.remove(frame.f_lineno)
            self.lines[self._test, frame.f_code.co_filename].add(frame.f_lineno)
        return self._go if left else None

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item):
        self._test, self._left, self._calls = item.nodeid, {}, Counter()
        began_s = time.process_time()
        sys.settrace(self._enter)
        try:
            return (yield)
        finally:
            sys.settrace(None)
            self.took_s[item.nodeid] = time.process_time() - began_s

    def pytest_sessionfinish(self, exitstatus):
        rows = [[test, file, sorted(lines)] for (test, file), lines in self.lines.items()]
        # what no mutant is in, and each process would else load anew
        others = [
            n for n, m in sys.modules.items() if "site-packages" in str(vars(m).get("__file__"))
        ]
        self.written.write_text(json.dumps([rows, self.took_s, others]), encoding="utf-8")


class NearestFirst:
    """A plugin of pytest: tests in the order of nearness, each with a limit of its own."""

    def __init__(self, reached, took_s, file, row):
        self._took_s = took_s
        near = {test: lines for test, of, lines in reached if of == str(file)}
        at_row = {test for test, lines in near.items() if row in lines}
        # a line of no function runs when its module loads
        self._near = at_row or set(near)

    @pytest.hookimpl(trylast=True)
    def pytest_collection_modifyitems(self, items):
        items.sort(key=self._nearness)

    def _nearness(self, item):
        near = item.nodeid in self._near
        return (not near, self._took_s.get(item.nodeid, 0.0) if near else 0.0)

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item):
        signal.setitimer(signal.ITIMER_PROF, 5 + 3 * self._took_s.get(item.nodeid, 0.0))
        return (yield)


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


def _fail(tests, plugin):
    # plain: else pytest loads modules named like tests (drift_test.py) by itself
    quiet = ["-q", "-x", "--assert=plain", "-p", "no:cacheprovider", "-p", "no:xdist"]
    return pytest.main([*quiet, "-k", NOT_IN_PROCESS, *tests], plugins=[plugin]) != 0


def ends(tests, drawn):
    """{number: how it ends} of drawn, {number: (file, row, mutated text)}."""
    before_s = os.times().children_user
    with tempfile.TemporaryDirectory(prefix="zerorate-reach-") as folder:
        reach = Reach({REPOSITORY / file for file, _, _ in drawn.values()}, Path(folder, "reach"))
        if _end_of(lambda: _fail(tests, reach), 900) != "passed":
            raise SystemExit("the tests fail as they are")
        reached, took_s, others = json.loads(reach.written.read_text(encoding="utf-8"))
    for name in others:
        with contextlib.suppress(ImportError):
            importlib.import_module(name)
    patience_s = int(os.times().children_user - before_s) + 30

    def mutated(file, row, text):
        put_in_place(REPOSITORY / file, text)
        return _fail(tests, NearestFirst(reached, took_s, REPOSITORY / file, row))

    return {n: _end_of(lambda of=of: mutated(*of), patience_s) for n, of in drawn.items()}
