"""Runs the tests of mutants: a fork for each, in which its text stands in the place of its file.

The tests that reach a mutant's line run first, the fastest first of all. If they pass, all others
run, too: what the C that is made of a kernel does is not seen here.
"""

import ast
import builtins
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
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[1]
# Tests in other processes, and some that take long and see little that others do not.
# (An interpreter reads the file as it is, and so would tell any mutant from it.)
NOT_IN_PROCESS = " and ".join(
    "not " + name
    for name in (
        *("micropython", "bytecode", "heap", "runtime", "last_byte", "any_slot", "no_intermediate"),
        *("every_interpreter", "signal_at_any_rename", "end_by_a_signal", "log_of_another_tool"),
    )
)

_HIT = "__hit__"  # the name by which a file's statements say that they are reached


class InPlaceOf(importlib.abc.MetaPathFinder, importlib.machinery.SourceFileLoader):
    """Loads a text, or what it was parsed to, in the place of a module's file."""

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


class Hits(ast.NodeTransformer):
    """Puts a call before every statement of a file's functions, which notes its rows as reached."""

    def __init__(self, file):
        self._file = str(file)

    def generic_visit(self, node):
        super().generic_visit(node)
        for name in ("body", "orelse", "finalbody"):
            block = getattr(node, name, None)
            if isinstance(block, list) and not isinstance(node, ast.Module):
                # a docstring stays the first
                parts = [(of,) if _is_text(of) else (self._hit(of), of) for of in block]
                setattr(node, name, [one for part in parts for one in part])
        return node

    def _hit(self, of):
        body = getattr(of, "body", None)
        last = body[0].lineno - 1 if body else of.end_lineno
        said = ast.Constant((self._file, of.lineno, max(last, of.lineno)))
        return ast.copy_location(ast.Expr(ast.Call(ast.Name(_HIT, ast.Load()), [said], [])), of)


def _is_text(statement):
    return isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Constant)


class Reach:
    """A plugin of pytest: which rows of some files each test reaches, and its seconds."""

    def __init__(self, files, written):
        self._files, self.written = files, written
        self.reached, self.took_s = {}, {}

    def pytest_configure(self):
        setattr(builtins, _HIT, set().add)
        for file in self._files:
            tree = Hits(file).visit(ast.parse(file.read_text(encoding="utf-8")))
            sys.meta_path.insert(0, InPlaceOf(file, ast.fix_missing_locations(tree)))

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item):
        rows = self.reached[item.nodeid] = set()
        setattr(builtins, _HIT, rows.add)
        began_s = time.process_time()
        try:
            return (yield)
        finally:
            self.took_s[item.nodeid] = time.process_time() - began_s

    def pytest_sessionfinish(self, exitstatus):
        rows = [[test, *reached] for test, every in self.reached.items() for reached in every]
        # what no mutant is in, and each process would else load anew
        others = [
            n for n, m in sys.modules.items() if "site-packages" in str(vars(m).get("__file__"))
        ]
        self.written.write_text(json.dumps([rows, self.took_s, others]), encoding="utf-8")


class NearestFirst:
    """A plugin of pytest: tests in the order of nearness, each with a limit of its own."""

    def __init__(self, reached, took_s, file, row):
        self._took_s = took_s
        near = {test for test, of, *_ in reached if of == str(file)}
        at_row = {test for test, of, a, b in reached if of == str(file) and a <= row <= b}
        # a line of no function runs when its module loads
        self._near = at_row or near

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
        reach = Reach({REPOSITORY / file for file, *_ in drawn.values()}, Path(folder, "reach"))
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
