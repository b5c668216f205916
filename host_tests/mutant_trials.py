"""Runs the tests of mutants: a fork for each, which loads a text in the place of its file.

A first fork notes which of the rows in question each test reaches. In the fork of a mutant the
tests that reach its row run, those that reach the least else first, until one fails or a budget is
spent. A mutant is killed by a test that fails with it and, in a fork of its own, passes without it.
One that takes too long, cannot be loaded or collected, or ends in another way is neither killed nor
alive.
"""

import ast
import builtins
import contextlib
import functools
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
_ELSEWHERE = (
    *("micropython", "bytecode", "heap", "runtime", "last_byte", "any_slot", "no_intermediate"),
    *("every_interpreter", "signal_at_any_rename", "log_of_another_tool"),
    *("in_processes_of_their_own", "hang_up", "random_moment", "real_recording"),
    *("without_a_cache", "gives_what_the_disk_gives", "copied_and_seen_to_change"),
)
_FIXTURES_OF_OTHERS = {
    "runtime",
    "micropython",
    "find_runtime",
    "chromium",
    "browser",
    "pico_parts",
}
_FIXTURES_OF_OTHERS |= {"outcome", "closed"}  # whole closings, longer than all of the budget
_FIXTURES_OF_OTHERS |= {"others", "s3", "gs"}  # clusters and stores, whose threads no fork has
# Tests of what starts an interpreter: that is host code, which the mutant is in.
_STARTERS = ("test_interpreters",)
# Seconds of processor for the tests of one mutant: what lives longer has survived. And for all.
_BUDGET_S, _LONG_S = 20, 4
_PATIENCE_S = 90
_CRASHES = (signal.SIGSEGV, signal.SIGFPE, signal.SIGABRT, signal.SIGBUS, signal.SIGILL)
# Packages whose modules stand in the repository.
_OWN = (
    "zerorate",
    "zerorate_i2c",
    "zerorate_tools",
    "zerorate_bench",
    "zerorate_fakes",
    "host_tests",
)
_HIT = "__hit__"  # the name by which a file's statements say that they are reached


class InPlaceOf(importlib.abc.MetaPathFinder, importlib.machinery.SourceFileLoader):
    """Loads a text, or what was parsed of one, in the place of a module's file."""

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


def put_in_place(path, text, loaded=None):
    """Let this process see the text in the place of the file, wherever it is loaded or read.

    loaded: what is loaded in the place of the text.
    """
    sys.meta_path.insert(0, InPlaceOf(path, loaded or text))
    plain = Path.read_text
    Path.read_text = lambda self, *how, **more: text if self == path else plain(self, *how, **more)


class Hits(ast.NodeTransformer):
    """Lets a file's functions note when they run, and when statements at some rows do."""

    def __init__(self, file, rows):
        self._file, self._rows = str(file), rows

    def visit_FunctionDef(self, node):
        for inner in ast.walk(node):
            for name in ("body", "orelse", "finalbody"):
                block = getattr(inner, name, None)
                if isinstance(block, list):
                    setattr(inner, name, [one for of in block for one in self._with_hit(of)])
        # a docstring stays the first
        node.body.insert(int(ast.get_docstring(node) is not None), self._hit(node, 0, 0))
        return node

    visit_AsyncFunctionDef = visit_FunctionDef

    def _with_hit(self, of):
        body = getattr(of, "body", None)
        last = max(body[0].lineno - 1 if body else of.end_lineno, of.lineno)
        said = isinstance(of, ast.Expr) and isinstance(of.value, ast.Constant)
        reached = not said and any(of.lineno <= row <= last for row in self._rows)
        return [self._hit(of, of.lineno, last), of] if reached else [of]

    def _hit(self, of, first, last):
        said = ast.Constant((self._file, first, last))
        return ast.copy_location(ast.Expr(ast.Call(ast.Name(_HIT, ast.Load()), [said], [])), of)


def _runs_elsewhere(item):
    if item.path.stem in _STARTERS:
        return False
    fixtures = _FIXTURES_OF_OTHERS & set(item.fixturenames)
    return bool(fixtures) or any(name in item.path.stem + item.name for name in _ELSEWHERE)


def _address(item):
    """By which pytest finds a test, wherever it is started."""
    return f"{item.path}::{item.nodeid.partition('::')[2]}"


def _run(item, following):
    item.config.hook.pytest_runtest_protocol(item=item, nextitem=following)


class InProcess:
    """A plugin of pytest that leaves out tests which a mutant of this process cannot reach."""

    @pytest.hookimpl(trylast=True)
    def pytest_collection_modifyitems(self, items):
        items[:] = [item for item in items if not _runs_elsewhere(item)]


class Nearest(InProcess):
    """Which tests reach a row, and how long each takes; a plugin of pytest that tries one mutant.

    tests: {nodeid: [seconds, its path, [[file, first row, last row], ...]]}. at: a file that holds
    the test that runs.
    """

    def __init__(self, tests, at, file, row):
        self._file, self._tests, self._at = str(file), tests, at
        at_file = {n: [r for r in of[2] if r[0] == self._file] for n, of in tests.items()}
        self.at_file = {name for name, rows in at_file.items() if rows}
        self.at_row = {n for n, rows in at_file.items() if any(a <= row <= b for _, a, b in rows)}

    def pytest_runtestloop(self, session):
        """Run the tests near to the row until one fails or the budget is spent."""
        near = self.at_row or self.at_file or set(self._tests)
        first = [item for item in session.items if item.nodeid in near]
        # what a fixture of several tests reaches was noted for the first of them
        modules = {item.path for item in first}
        kernel = "firmware" in Path(self._file).parts  # its C is compiled once for all tests
        rest = [i for i in session.items if i not in first and (kernel or i.path in modules)]
        rest.sort(key=lambda item: item.path not in modules)
        first.sort(key=lambda item: self._turn(*self._tests[item.nodeid]))
        began_s = time.process_time()
        for item, following in zip(first + rest, [*first, *rest, None][1:]):
            if session.testsfailed or time.process_time() - began_s > _BUDGET_S:
                break
            signal.setitimer(signal.ITIMER_PROF, 5 + 3 * self._longest_s(item))
            self._at.write_text(_address(item), encoding="utf-8")
            _run(item, following)
        return True

    @staticmethod
    def _turn(seconds, _, reached):
        """When it is a test's turn: what reaches little else asks most of a row; long ones wait."""
        return seconds > _LONG_S, len(reached), seconds

    def _longest_s(self, item):
        """Seconds of the slowest test in an item's module: it may have made a fixture of all."""
        return max(s for s, path, _ in self._tests.values() if path == str(item.path))


class Reach(InProcess):
    """A plugin of pytest that notes which hits each test has, and how long it takes.

    Writes [{nodeid: [seconds, its path, [[file, first row, last row], ...]]}, modules of others
    that are loaded by then]; or, where a test fails, its nodeid.
    """

    def __init__(self, written):
        self._written = written

    def pytest_runtestloop(self, session):
        tests = {}
        for item, following in zip(session.items, [*session.items[1:], None]):
            reached, began_s = set(), time.process_time()
            setattr(builtins, _HIT, reached.add)
            self._written.write_text(item.nodeid, encoding="utf-8")
            _run(item, following)
            took_s = time.process_time() - began_s
            tests[item.nodeid] = [took_s, str(item.path), sorted(reached)]
            if session.testsfailed:
                return True
        others = [
            n for n, m in sys.modules.items() if "site-packages" in str(vars(m).get("__file__"))
        ]
        self._written.write_text(json.dumps([tests, others]), encoding="utf-8")
        return True


@functools.cache
def _passes_alone(failed):
    """Whether a test passes without any change; asked once of each that has failed."""
    return _end_of(lambda: _pytest([failed], InProcess()), _PATIENCE_S) == "passed"


def _tried(mutated, at):
    """How a mutant ends: killed only if the test that failed passes alone, without the change."""
    at.write_text("", encoding="utf-8")
    end = _end_of(mutated, _PATIENCE_S)
    if end != "killed":
        return end
    failed = at.read_text(encoding="utf-8")
    return "killed" if failed and _passes_alone(failed) else "untried"


def _end_of(forked, seconds):
    """How a fork ends: passed, killed (a test fails or crashes), slow (its time is up), untried."""
    child = os.fork()
    if child == 0:
        signal.alarm(8 * seconds)
        signal.setitimer(signal.ITIMER_PROF, seconds)
        os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
        os.dup2(1, 2)
        try:
            os._exit(int(forked()))
        finally:
            os._exit(pytest.ExitCode.INTERNAL_ERROR)
    _, status = os.waitpid(child, 0)
    if os.WIFSIGNALED(status):
        late = os.WTERMSIG(status) in (signal.SIGALRM, signal.SIGPROF)
        return "slow" if late else "killed" if os.WTERMSIG(status) in _CRASHES else "untried"
    return {0: "passed", 1: "killed"}.get(os.WEXITSTATUS(status), "untried")


def _pytest(tests, plugin):
    """What pytest returns for tests with a plugin of this file; our own modules are loaded anew."""
    for name in [n for n in sys.modules if n.partition(".")[0] in _OWN]:
        del sys.modules[name]
    # plain: else pytest loads modules named like tests (drift_test.py) by itself
    quiet = ["-q", "-s", "-x", "--assert=plain", "-p", "no:cacheprovider", "-p", "no:xdist"]
    return pytest.main([*quiet, *tests], plugins=[plugin])


def _reached(tests, drawn):
    """What `Reach` writes of the rows that are drawn."""
    with tempfile.TemporaryDirectory(prefix="zerorate-reach-") as folder:
        written = Path(folder, "reach")

        def note():
            setattr(builtins, _HIT, lambda hit: None)
            for file in {Path(file) for file, *_ in drawn.values()}:
                text = file.read_text(encoding="utf-8")
                tree = Hits(file, [row for of, row, _ in drawn.values() if Path(of) == file])
                tree = ast.fix_missing_locations(tree.visit(ast.parse(text)))
                # C is made of kernels as they are, and some files are run from their text
                kernel = "firmware" in file.parts
                put_in_place(file, text if kernel else ast.unparse(tree), tree)
            return _pytest(tests, Reach(written))

        _end_of(note, 1800)
        said = written.read_text(encoding="utf-8") if written.exists() else "at collection"
        if not said.startswith("[{"):
            raise SystemExit(f"the tests fail as they are: {said}")
        return json.loads(said)


def ends(tests, drawn):
    """{number: how it ends} of drawn, {number: (file, row, mutated text)}."""
    drawn = {number: (str(REPOSITORY / file), *of) for number, (file, *of) in drawn.items()}
    reached, others = _reached(tests, drawn)
    for name in others:  # what no mutant is in, and each fork would else load anew
        with contextlib.suppress(ImportError):
            importlib.import_module(name)
    return {number: _end(tests, reached, *of) for number, of in drawn.items()}


def _end(tests, reached, file, row, text):
    """How a mutant ends."""
    with tempfile.TemporaryDirectory(prefix="zerorate-mutant-") as folder:
        at = Path(folder, "at")
        nearest = Nearest(reached, at, file, row)
        near = sorted({reached[name][1] for name in nearest.at_row or nearest.at_file})

        def mutated():
            put_in_place(Path(file), text)
            return _pytest(near or tests, nearest)

        return _tried(mutated, at)
