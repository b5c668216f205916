"""What share of mutants do the tests of an area kill? `make mutants`; cosmic-ray makes the mutants.

A sample by a seed, of each area the same number. A mutant stands in the place of its module in a
fork of its own, which runs the area's tests until one fails. No file changes. A kernel's mutant is
what CPython runs, and what the C for hosts is made of; machine code for boards plays no part.
Mutants that mean the same are listed in mutants.toml, each with why; they are drawn but not run.
"""

import argparse
import ast
import contextlib
import itertools
import os
import random
import re
import sys
import tempfile
from collections import Counter
from pathlib import Path

from cosmic_ray import plugins
from cosmic_ray.ast import ast_nodes, get_ast
from cosmic_ray.mutating import mutate_code

from .mutant_trials import REPOSITORY, ends

try:
    import tomllib
except ImportError:  # Python 3.10
    import tomli as tomllib

SURVIVORS_AND_WHY = Path(__file__).with_name("mutants.toml")
# What no test can tell apart: annotations, constants that `make layout` writes, == and is of what
# there is only one of, what is done without a module that MicroPython has and the tests have too.
_SAME = re.compile(r"^\s*(from |import |#)|TYPE_CHECKING|^@|^except ImportError:")
_SAME_OF_SMALL_INTEGERS = ("Eq_Is", "NotEq_IsNot")
# At the limit both are the limit.
_LIMIT = re.compile(r"(?:return|=) (.+) if \1 [<>] (.+) else \2$")
_AT_LIMIT = ("Lt_LtE", "Gt_GtE")
_LAYOUT = re.compile(r"^# layout: .*?^# layout: end", re.MULTILINE | re.DOTALL)

# Numbers that are committed: what boards ask their machine code for, and what a trace ends in.
KNOWN = "host_tests/native/test_known_answers.py"
GOLDEN = (
    "host_tests/firmware/test_equal_to_the_last_bit.py::"
    "test_the_numbers_are_those_that_were_committed"
)
SWUNG = GOLDEN.replace("the_numbers", "the_numbers_of_a_device_that_swings")

_COMMANDS = REPOSITORY / "tools" / "zerorate_tools" / "commands"
# area -> (files, tests)
AREAS = {
    "drivers": (
        ["drivers/zerorate_i2c/" + name for name in (
            "mpu6050.py", "fifo.py", "data_ready.py", "bus_recovery.py", "settings.py",
            "identity.py", "registers.py")],
        ["host_tests/drivers/test_" + name for name in (
            "mpu6050.py", "faults.py", "fifo.py", "fifo_by_hand.py", "data_ready.py",
            "settings.py")],
    ),
    "storage": (
        ["firmware/zerorate/storage/" + name for name in (
            "store.py", "places.py", "learned_store.py", "save_schedule.py", "soundness.py")],
        ["host_tests/firmware/test_" + name for name in (
            "store.py", "store_records.py", "places.py", "learned_store.py", "corrector.py",
            "soundness.py")],
    ),
    "guard": (
        ["firmware/zerorate/rest/guard.py", "firmware/zerorate/checked.py"],
        ["host_tests/firmware/test_guard.py", "host_tests/firmware/test_checked.py"],
    ),
    "rest": (
        ["firmware/zerorate/rest/" + name for name in (
            "bias.py", "block.py", "copying.py", "estimators.py", "fit.py", "histogram.py",
            "recent.py", "step.py", "stillness.py")],
        ["host_tests/firmware/test_" + name for name in (
            "estimators.py", "fit.py", "histogram.py", "bursts.py", "windows.py", "offsets.py",
            "published.py")]
        + [KNOWN, GOLDEN],
    ),
    "motion": (
        ["firmware/zerorate/motion/" + name for name in (
            "attitude.py", "in_motion.py", "increments.py", "least_squares.py",
            "motion_verdict.py", "orientation.py", "posterior.py", "regression.py", "thermal.py",
            "tilt_frame.py")],
        [SWUNG, KNOWN]
        + ["host_tests/firmware/test_" + name for name in (
            "in_motion.py", "orientation.py", "motion_frame.py", "motion_fit.py",
            "motion_known.py", "motion_verdicts.py")],
    ),
    "gravity": (
        ["firmware/zerorate/gravity/gravity.py", "firmware/zerorate/gravity/gravity_settings.py"],
        [SWUNG, KNOWN, "host_tests/firmware/test_gravity.py",
         "host_tests/firmware/test_documents.py"],
    ),
    "importers": (
        ["tools/zerorate_tools/importers/" + name for name in (
            "importing.py", "report.py", "columns/names.py", "columns/guesses.py",
            "samples/between.py", "samples/conversion.py", "samples/gather.py",
            "logs/columnar.py", "logs/messages.py")],
        ["host_tests/importers/test_" + name for name in (
            "by_a_plain_reading.py", "small_steps.py", "tables.py", "odd_files.py",
            "odd_names.py", "odd_times.py", "units_told.py", "steps_of_logs.py",
            "together.py")],
    ),
    "effects": (
        ["firmware/zerorate/effects/" + name for name in (
            "effects.py", "effect_basis.py", "effect_inputs.py", "effect_plays.py")],
        ["host_tests/firmware/test_effect" + name for name in (
            "_refine.py", "_kernels.py", "s.py", "s_in_time.py", "s_on_interpreters.py")]
        + [KNOWN],
    ),
    "models": (
        ["firmware/zerorate/effects/model_file.py", "firmware/zerorate/model.py",
         "tools/zerorate_tools/model/binary.py"],
        ["host_tests/tools/test_model_limits.py", "host_tests/firmware/test_effect_kernels.py",
         "host_tests/firmware/test_effects_in_time.py::test_the_first_sample_speaks_until_the_first_tick_ends",
         "host_tests/firmware/test_effects_in_time.py::test_a_power_on_begins_every_memory_anew",
         "host_tests/firmware/test_effects_on_interpreters.py",
         "host_tests/tools/test_model.py", "host_tests/tools/test_model_on_device.py",
         "host_tests/firmware/test_fit.py::test_a_model_without_the_slope_leaves_them_as_they_are",
         "host_tests/firmware/test_fit.py::test_estimators_share_the_range_of_a_curve_that_the_model_holds_whole"],
    ),
    "recordings": (
        ["tools/zerorate_tools/recordings/" + name for name in (
            "checks.py", "csv_format.py", "scales.py", "bounded.py")],
        ["host_tests/tools/test_recordings.py", "host_tests/tools/test_bad_recordings.py",
         "host_tests/tools/test_recording_limits.py"],
    ),
    "commands": (
        sorted(str(path.relative_to(REPOSITORY)) for path in _COMMANDS.glob("[a-z]*.py")),
        ["host_tests/tools/test_words_reach.py"],
    ),
    "fit": (
        ["tools/zerorate_tools/loop/fit/" + name for name in (
            "common_cause.py", "cross_products.py", "free_curve.py", "intervals.py",
            "left_out.py", "likelihood.py", "line.py", "noise.py", "regression.py", "shrunk.py",
            "single.py", "smooth.py", "surrogates.py")],
        ["host_tests/loop/test_fit_" + name for name in ("dense.py", "by_hand.py")],
    ),
    "verify": (
        ["tools/zerorate_tools/loop/verify/" + name for name in (
            "analysis.py", "by_kernels.py", "firmware.py", "judge.py", "measure.py",
            "measured.py", "power_on.py", "prune_by_holdout.py", "slots.py")],
        ["host_tests/loop/test_verify_by_hand.py", "host_tests/loop/test_kernels_by_hand.py"],
    ),
    # what one search is made of; its course is judged by whole closings
    "search": (
        ["tools/zerorate_tools/loop/search/" + name for name in (
            "catalogue.py", "cancels.py", "confounding.py", "decide.py", "detectable.py",
            "drift_test.py", "fits_in_slots.py", "multiple_testing.py", "naming.py",
            "ols_holdout_ratio.py", "periodic.py", "refine.py", "selection.py",
            "step_places.py", "steps.py")],
        ["host_tests/loop/test_search_by_hand.py", "host_tests/loop/test_steps_by_hand.py"],
    ),
    "writers": (
        ["tools/zerorate_tools/ending.py"]
        + ["tools/zerorate_tools/recordings/" + name for name in (
            "atomic.py", "drafts.py", "growing.py", "unfinished.py")],
        ["host_tests/tools/test_" + name for name in (
            "atomic.py", "drafts.py", "growing.py")],
    ),
}  # fmt: skip


def _annotations(source):
    """[(start, end)] of all annotations, each (row, column)."""
    kinds = (ast.arg, ast.AnnAssign), (ast.FunctionDef, ast.AsyncFunctionDef)
    nodes = list(ast.walk(ast.parse(source)))
    found = [node.annotation for node in nodes if isinstance(node, kinds[0])]
    found += [node.returns for node in nodes if isinstance(node, kinds[1])]
    return [
        ((a.lineno, a.col_offset), (a.end_lineno, a.end_col_offset)) for a in found if a is not None
    ]


def mutants(files):
    """[(file, operator, occurrence, row)] of all that can be told apart."""
    found = []
    for file in files:
        source = (REPOSITORY / file).read_text(encoding="utf-8")
        rows = source.splitlines()
        written = [
            source.count("\n", 0, end) for part in _LAYOUT.finditer(source) for end in part.span()
        ]
        annotations = _annotations(source)
        nodes = list(ast_nodes(get_ast(source)))
        for name in sorted(plugins.operator_names()):
            operator_class = plugins.get_operator(name)
            if operator_class.arguments() or name.endswith(_SAME_OF_SMALL_INTEGERS):
                continue
            operator = operator_class()
            at = [start for node in nodes for start, _ in operator.mutation_positions(node)]
            for occurrence, start in enumerate(at):
                row = start[0]
                in_layout = any(a < row <= b for a, b in zip(written[::2], written[1::2]))
                annotates = any(a <= start < b for a, b in annotations)
                if not in_layout and not annotates and not _SAME.search(rows[row - 1]):
                    found.append((file, name, occurrence, row))
    return found


def same(mutant, text, mutated=""):
    """Why the mutant of a line, which makes another of it, means the same; or ""."""
    if mutant[1].endswith(_AT_LIMIT) and _LIMIT.search(text):
        return "at the limit both are the limit"
    for entry in tomllib.loads(SURVIVORS_AND_WHY.read_text(encoding="utf-8"))["same"]:
        names = entry["operators"]
        there = mutant[0].startswith(entry["file"]) and mutated in entry.get("become", [mutated])
        if there and entry["line"] == text and mutant[1].rpartition("/")[2] in names:
            return entry["why"]
    return ""


def draws(files, seed):
    """Yield (file, operator, occurrence, row, line, mutated text), all that are Python."""
    every = mutants(files)
    for file, operator, occurrence, row in random.Random(seed).sample(every, len(every)):
        source = (REPOSITORY / file).read_text(encoding="utf-8")
        # the * of a parameter list is no product, and cosmic-ray knows no dot after except
        with contextlib.suppress(SyntaxError, AttributeError):
            text = mutate_code(source, plugins.get_operator(operator)(), occurrence)
            ast.parse(text)
            yield file, operator, occurrence, row, source.splitlines()[row - 1].strip(), text


def area_score(name, count, seed):
    """Counter of killed, survived, same; prints each survivor."""
    files, tests = AREAS[name]
    found, drawn, said = Counter(), {}, {}
    for number, (file, operator, occurrence, row, line, text) in enumerate(
        itertools.islice(draws(files, seed), count)
    ):
        if same((file, operator), line, text.splitlines()[row - 1].strip()):
            found["same"] += 1
            continue
        drawn[number] = (file, row, text)
        said[number] = f"survived: {file}:{row} {operator} {occurrence}: {line}"
    for number, end in ends(tests, drawn).items():
        found["survived" if end == "passed" else "killed"] += 1
        if end == "passed":
            print(said[number], flush=True)
    return found


def low_score(name, count, seed):
    """Whether an area's share is below nine tenths, having printed it."""
    found = area_score(name, count, seed)
    tried = found["killed"] + found["survived"]
    share = found["killed"] / tried if tried else 0.0
    counts = f"{found['killed']} of {tried} killed, {found['same']} mean the same"
    print(f"{name:<12}{share:>6.0%}  {counts}", flush=True)
    return share < 0.9


def main(arguments=None):
    """Print the table; 1 where an area is below nine tenths."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("areas", nargs="*", choices=[*AREAS, []], help="default: all")
    parser.add_argument("--each", type=int, default=25, help="mutants of an area")
    drawn = random.SystemRandom().randrange(1 << 31)
    parser.add_argument("--seed", type=int, default=drawn, help="of the draw; default: a new one")
    chosen = parser.parse_args(arguments)
    print(f"{chosen.each} of each area, --seed {chosen.seed}", flush=True)
    os.chdir(REPOSITORY)
    # one cache for all: what is compiled is kept by its text, and a mutant's is another
    with tempfile.TemporaryDirectory(prefix="zerorate-mutants-") as cache:
        os.environ["ZERORATE_CACHE"] = cache
        low = sum(low_score(name, chosen.each, chosen.seed) for name in chosen.areas or AREAS)
    return 1 if low else 0


if __name__ == "__main__":
    sys.exit(main())
