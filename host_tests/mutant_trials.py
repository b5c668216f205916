"""Runs the tests of mutants: collected once, then a fork for each mutant, until a test fails."""

import ast
import gc
import importlib.abc
import importlib.machinery
import importlib.util
import inspect
import json
import os
import signal
import sys
import time
import types
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[1]
# Tests in other processes, and two that take long and see little that others do not.
NOT_IN_PROCESS = " and ".join(
    "not " + name
    for name in ("micropython", "heap", "runtime", "last_byte", "any_slot", "no_intermediate")
)
# What no mutant is in, and each process would else load anew.
LOADED_ONCE = (
    "hypothesis.strategies",
    "hypothesis.internal.conjecture.engine",
    "_hypothesis_pytestplugin",
    "numpy",
    "pyarrow.parquet",
    "pyarrow.csv",
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


class Trial:
    """The tests, collected once; a fork of them for each mutant that is in a function.

    What is told of each is written to `told`, a file: {number: how it ended}, and "as it is".
    """

    def __init__(self, drawn, told):
        self.drawn, self.told = drawn, told

    def pytest_runtestloop(self, session):
        touched = Touched(file for file, *_ in self.drawn.values())
        outcome = {"as it is": _end_of(lambda: touched.run(session, self.told), 600)}
        if outcome["as it is"] == "passed":
            calls, seconds = json.loads(self.told.read_text(encoding="utf-8"))
            patience = int(2 * sum(seconds.values())) + 5
            for number, (file, row, text) in self.drawn.items():
                path, within = REPOSITORY / file, _function(REPOSITORY / file, row)
                code = _function_code(compile(text, path, "exec"), within)

                def fork(file=file, path=path, text=text, within=within, code=code):
                    put_in_place(path, text)
                    _exchange(str(path), code)
                    called = [file, within]
                    session.items.sort(
                        key=lambda i: (called not in calls[i.nodeid], seconds[i.nodeid])
                    )
                    return _run_items(session)

                outcome[number] = _end_of(fork, patience)
        self.told.write_text(json.dumps(outcome), encoding="utf-8")
        return True


class Touched:
    """Which tests call which functions of the files, and how long each takes."""

    def __init__(self, files):
        self.names = {str(REPOSITORY / file): file for file in files}

    def run(self, session, told):
        calls, seconds = {}, {}
        for item in session.items:
            began, found = time.process_time(), set()

            def called(frame, _event, _argument, found=found):
                name = self.names.get(frame.f_code.co_filename)
                if name:
                    found.add((name, frame.f_code.co_firstlineno))

            sys.settrace(called)
            _run_items(session, [item])
            sys.settrace(None)
            calls[item.nodeid], seconds[item.nodeid] = sorted(found), time.process_time() - began
        told.write_text(json.dumps([calls, seconds]), encoding="utf-8")
        return bool(session.testsfailed)


def _run_items(session, items=None):
    """Whether a test failed; no more are run then."""
    items = items or session.items
    for item, following in zip(items, [*items[1:], None]):
        item.config.hook.pytest_runtest_protocol(item=item, nextitem=following)
        if session.testsfailed:
            return True
    return False


def _function(path, row):
    """Where the outermost function begins that a row is in, as code says it; 0 outside of all."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    for node in _outermost(tree):
        first = min([node.lineno, *(part.lineno for part in node.decorator_list)])
        if node.body[0].lineno <= row <= node.end_lineno:
            return first
    return 0


def _outermost(tree):
    for node in ast.iter_child_nodes(tree):
        if isinstance(node, ast.FunctionDef):
            yield node
        else:
            yield from _outermost(node)


def _function_code(code, begins):
    """The code of the function that begins in that row; None where there is none."""
    if code.co_firstlineno == begins and code.co_flags & inspect.CO_OPTIMIZED:
        return code
    parts = [part for part in code.co_consts if isinstance(part, types.CodeType)]
    return next(filter(None, (_function_code(part, begins) for part in parts)), None)


def _exchange(file, code):
    """Give the function its mutant's code, wherever it was imported to."""
    for known in gc.get_objects():
        if isinstance(known, types.FunctionType) and known.__code__.co_filename == file:
            if _function_code(known.__code__, code.co_firstlineno) is known.__code__:
                known.__code__ = code


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


def _pytest(tests, *plugins):
    quiet = ["-q", "-x", "-p", "no:cacheprovider", "-p", "no:xdist", "-k", NOT_IN_PROCESS]
    return pytest.main([*quiet, *tests], plugins=plugins) != 0


def ends(tests, drawn, told):
    """{number: how it ends} of drawn, {number: (file, row, mutated text)}."""
    for name in LOADED_ONCE:
        importlib.import_module(name)
    inside = {n: of for n, of in drawn.items() if _function(REPOSITORY / of[0], of[1])}
    _end_of(lambda: _pytest(tests, Trial(inside, told)), 36000)
    outcome = json.loads(told.read_text(encoding="utf-8"))
    if outcome.pop("as it is") != "passed":
        raise SystemExit("the tests fail as they are")
    outcome = {int(number): end for number, end in outcome.items()}

    def anew(file, text):
        put_in_place(REPOSITORY / file, text)
        return _pytest(tests)

    for number in drawn.keys() - inside.keys():
        file, _, text = drawn[number]
        outcome[number] = _end_of(lambda file=file, text=text: anew(file, text), 120)
    return outcome
