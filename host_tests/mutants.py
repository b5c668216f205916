"""What share of mutants do the tests of an area kill? `make mutants`; cosmic-ray makes the mutants.

A sample by a seed, of each area the same number. A mutant is loaded in the place of its module by
a process of its own, which runs the area's tests; no file changes. A kernel's mutant is what
CPython runs, and what the C for hosts is made of; machine code for boards plays no part. Mutants
that mean the same are listed in mutants.toml, each with why; they are drawn but not run.
"""

import argparse
import importlib.abc
import importlib.machinery
import importlib.util
import os
import random
import re
import signal
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

import pytest
from cosmic_ray import plugins
from cosmic_ray.ast import ast_nodes, get_ast
from cosmic_ray.mutating import mutate_code

try:
    import tomllib
except ImportError:  # Python 3.10
    import tomli as tomllib

REPOSITORY = Path(__file__).resolve().parents[1]
SURVIVORS_AND_WHY = Path(__file__).with_name("mutants.toml")
# Tests in other processes, and two that take long and see little that others do not.
NOT_IN_PROCESS = " and ".join(
    "not " + name
    for name in ("micropython", "heap", "runtime", "last_byte", "any_slot", "no_intermediate")
)
# What no test can tell apart: annotations, constants that `make layout` writes, == and is of what
# there is only one of.
_SAME = re.compile(r"^\s*(def |from |import |#)|^\s+\w+: .*[,=]$|^    \) ->|TYPE_CHECKING|^@")
_SAME_OF_SMALL_INTEGERS = ("Eq_Is", "NotEq_IsNot")
_LAYOUT = re.compile(r"^# layout: .*?^# layout: end", re.MULTILINE | re.DOTALL)

# area -> (files, tests)
AREAS = {
    "drivers": (
        ["drivers/zerorate_i2c/" + name for name in (
            "mpu6050.py", "fifo.py", "data_ready.py", "bus_recovery.py", "settings.py",
            "identity.py", "registers.py")],
        ["host_tests/drivers/test_" + name for name in (
            "mpu6050.py", "faults.py", "fifo.py", "data_ready.py")],
    ),
    "storage": (
        [f"firmware/zerorate/storage/{n}.py" for n in ("store", "places", "learned_store")],
        ["host_tests/firmware/test_store.py", "host_tests/firmware/test_learned_store.py"],
    ),
    "guard": (
        ["firmware/zerorate/rest/guard.py", "firmware/zerorate/checked.py"],
        ["host_tests/firmware/test_guard.py", "host_tests/firmware/test_checked.py"],
    ),
    "effects": (
        ["firmware/zerorate/effects/" + name for name in (
            "effects.py", "effect_basis.py", "effect_inputs.py", "effect_plays.py")],
        ["host_tests/firmware/test_effects.py"],
    ),
    "models": (
        ["firmware/zerorate/effects/model_file.py", "firmware/zerorate/model.py",
         "tools/zerorate_tools/model/binary.py"],
        ["host_tests/tools/test_model_limits.py",
         "host_tests/firmware/test_effects.py::test_the_first_sample_speaks_until_the_first_tick_ends",
         "host_tests/firmware/test_effects.py::test_a_power_on_begins_every_memory_anew",
         "host_tests/tools/test_model.py"],
    ),
    "recordings": (
        ["tools/zerorate_tools/recordings/" + name for name in (
            "checks.py", "csv_format.py", "scales.py", "atomic.py", "bounded.py")],
        ["host_tests/tools/test_recordings.py", "host_tests/tools/test_atomic.py",
         "host_tests/hostile/test_any_bytes.py"],
    ),
}  # fmt: skip


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


def mutants(files):
    """[(file, operator, occurrence, row)] of all that can be told apart."""
    found = []
    for file in files:
        source = (REPOSITORY / file).read_text(encoding="utf-8")
        rows = source.splitlines()
        written = [
            source.count("\n", 0, end) for part in _LAYOUT.finditer(source) for end in part.span()
        ]
        nodes = list(ast_nodes(get_ast(source)))
        for name in sorted(plugins.operator_names()):
            operator_class = plugins.get_operator(name)
            if operator_class.arguments() or name.endswith(_SAME_OF_SMALL_INTEGERS):
                continue
            operator = operator_class()
            at = [start[0] for node in nodes for start, _ in operator.mutation_positions(node)]
            for occurrence, row in enumerate(at):
                in_layout = any(a < row <= b for a, b in zip(written[::2], written[1::2]))
                if not in_layout and not _SAME.search(rows[row - 1]):
                    found.append((file, name, occurrence, row))
    return found


def run(tests, seconds, mutant=None):
    """How a process ends that runs the tests, with mutant (file, text): passed, killed, slow."""
    with tempfile.TemporaryDirectory(prefix="zerorate-mutant-") as cache:
        child = os.fork()
        if child == 0:
            os.environ["ZERORATE_CACHE"] = cache  # compiled mutants are nobody else's
            _run_tests(tests, seconds, mutant)
        _, status = os.waitpid(child, 0)
    if os.WIFSIGNALED(status):
        return "slow" if os.WTERMSIG(status) == signal.SIGALRM else "killed"
    return "killed" if os.WEXITSTATUS(status) else "passed"


def _run_tests(tests, seconds, mutant):
    signal.alarm(seconds)
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    os.dup2(1, 2)
    if mutant is not None:
        put_in_place(*mutant)
    quiet = ["-q", "-x", "-p", "no:cacheprovider", "-p", "no:xdist", "-k", NOT_IN_PROCESS]
    os._exit(int(pytest.main([*quiet, *tests]) != 0))


def same(mutant, text):
    """Why the mutant means the same, by mutants.toml, or ""."""
    for entry in tomllib.loads(SURVIVORS_AND_WHY.read_text(encoding="utf-8"))["same"]:
        names = entry["operators"]
        if entry["file"] == mutant[0] and entry["line"] == text and mutant[1] in names:
            return entry["why"]
    return ""


def area_score(name, count, seed):
    """Counter of killed, survived, same; prints each survivor."""
    files, tests = AREAS[name]
    began = time.monotonic()
    if run(tests, 600) != "passed":
        raise SystemExit(f"the tests of {name} fail as they are")
    patience = int(5 * (time.monotonic() - began)) + 30
    drawn = mutants(files)
    drawn = random.Random(seed).sample(drawn, min(count, len(drawn)))
    found = Counter()
    for file, operator, occurrence, row in drawn:
        path = REPOSITORY / file
        source = path.read_text(encoding="utf-8")
        line = source.splitlines()[row - 1].strip()
        text = mutate_code(source, plugins.get_operator(operator)(), occurrence)
        if same((file, operator), line):
            found["same"] += 1
        elif run(tests, patience, (path, text)) == "passed":
            found["survived"] += 1
            print(f"survived: {file}:{row} {operator} {occurrence}: {line}", flush=True)
        else:
            found["killed"] += 1
    return found


def main(arguments=None):
    """Print the table; 1 where an area is below nine tenths."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("areas", nargs="*", choices=[*AREAS, []], help="default: all")
    parser.add_argument("--each", type=int, default=25, help="mutants of an area")
    parser.add_argument("--seed", type=int, default=1)
    chosen = parser.parse_args(arguments)
    os.chdir(REPOSITORY)
    low = 0
    for name in chosen.areas or AREAS:
        found = area_score(name, chosen.each, chosen.seed)
        tried = found["killed"] + found["survived"]
        share = found["killed"] / tried if tried else 0.0
        low += share < 0.9
        counts = f"{found['killed']} of {tried} killed, {found['same']} mean the same"
        print(f"{name:<12}{share:>6.0%}  {counts}", flush=True)
    return 1 if low else 0


if __name__ == "__main__":
    sys.exit(main())
