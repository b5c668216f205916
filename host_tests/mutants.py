"""What share of mutants do the tests of an area kill? `make mutants`; cosmic-ray makes the mutants.

A sample by a seed, of each area the same number. A mutant stands in the place of its module in a
fork of its own, which runs the area's tests until one fails. No file changes. A kernel's mutant is
what CPython runs, and what the C for hosts is made of; machine code for boards plays no part.
Mutants that mean the same are listed in mutants.toml, each with why; they are drawn but not run.
"""

import argparse
import ast
import contextlib
import functools
import itertools
import os
import random
import re
import sys
import tempfile
from collections import Counter
from fnmatch import fnmatch
from operator import lshift, or_, rshift, sub, xor
from pathlib import Path

from cosmic_ray import plugins
from cosmic_ray.ast import ast_nodes, get_ast
from cosmic_ray.mutating import mutate_code
from zerorate_tools.runtimes.runtime import runtime_folder

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
_LIMIT = re.compile(
    r"(?:return|=) (.+) if \1 [<>] (.+) else \2$"
    r"|if (.+) [<>] (.+):\n\s*\3 = \4\n(?!\s*(?:else|elif (?!\3 )))",
    re.MULTILINE,
)
_AT_LIMIT = ("Lt_LtE", "Gt_GtE")
# What may make the same of two numbers as + does, and does so of anything and 0.
_SUM = re.compile(r"[\[(](\w+) \+ (\w+)[\])]")
_LIKE_ADD = {"BitOr": or_, "BitXor": xor, "Sub": sub, "LShift": lshift, "RShift": rshift}
_LAYOUT = re.compile(r"^# layout: .*?^# layout: end", re.MULTILINE | re.DOTALL)

# Numbers that are committed: what boards ask their machine code for, and what a trace ends in.
KNOWN = "native/test_native_files.py::test_the_known_answer_on_every_board_is_the_kernels"
GOLDEN = "firmware/test_equal_to_the_last_bit.py::test_the_numbers_are_those_that_were_committed"
EFFECTS = GOLDEN.replace("the_numbers", "the_effects")
SWUNG = GOLDEN.replace("the_numbers", "the_numbers_of_a_device_that_swings")

_FIGURES = "golden/test_known.py::test_the_figures_are_those_that_were_committed"
_TOOLS = "tools/zerorate_tools/"
# area -> (folders, tests below host_tests); a file belongs to the longest of the folders above it
AREAS = {
    "drivers": (
        ["drivers/zerorate_i2c/"],
        ["drivers/test_" + name for name in (
            "mpu6050.py", "fifo.py", "data_ready.py", "settings.py",
            "record_bus.py", "fake_buses.py", "faults.py")],
    ),
    "storage": (
        ["firmware/zerorate/storage/"],
        ["firmware/test_" + name for name in (
            "store.py", "places.py", "learned_store.py", "corrector.py", "soundness.py")],
    ),
    "rest": (
        ["firmware/zerorate/rest/"],
        ["firmware/test_" + name for name in (
            "guard.py", "estimators.py", "fit.py", "histogram.py", "bursts.py",
            "turn_on.py", "stillness.py")]
        + [KNOWN, GOLDEN, _FIGURES + "[kernels of rest]"],
    ),
    "motion": (
        ["firmware/zerorate/motion/"],
        [SWUNG, KNOWN, _FIGURES + "[settings]", _FIGURES + "[kernels of motion]"]
        + ["firmware/test_" + name for name in (
            "in_motion.py", "motion_frame.py", "motion_fit.py")],
    ),
    "gravity": (
        ["firmware/zerorate/gravity/"],
        [SWUNG, KNOWN, "firmware/test_gravity.py", "firmware/test_documents.py",
         _FIGURES + "[settings]", _FIGURES + "[kernels of gravity]"],
    ),
    "effects": (
        ["firmware/zerorate/effects/", "firmware/zerorate/model.py"],
        ["firmware/test_effect" + name for name in (
            "_refine.py", "s.py", "s_in_time.py")]
        + ["tools/test_model_on_device.py", KNOWN, EFFECTS, _FIGURES + "[kernels of effects]"],
    ),
    # what puts the firmware's parts together, and what they compute with
    "corrector": (
        ["firmware/zerorate/"],
        ["firmware/test_" + name for name in (
            "corrector.py", "checked.py", "bursts.py", "documents.py",
            "sources_together.py", "estimators.py", "motion_fit.py", "turn_on.py",
            "machine_code_by_hand.py", "guard.py")]
        + [KNOWN, GOLDEN, _FIGURES + "[settings]", _FIGURES + "[watched]"]
        + [_FIGURES + "[arithmetic]"],
    ),
    "recordings": (
        [_TOOLS + "recordings/"],
        ["tools/test_" + name for name in (
            "recordings.py", "bad_recordings.py", "atomic.py", "drafts.py", "growing.py")]
        + ["hostile/test_guarded.py", "importers/test_turning.py", _FIGURES + "[turned]"],
    ),
    "importers": (
        [_TOOLS + "importers/"],
        ["importers/"] + [_FIGURES + f"[imported {kind}]" for kind in (
            *("arrays", "changed", "clocks", "flights", "phones", "robots", "sensors", "tools"),
            *("wearables", "parts", "columns", "units", "stamps", "devices", "doubted"),
            *("texts", "records", "checked", "cuts", "spools", "plans", "logs"))],
    ),
    # what they print is seen where they really run
    "commands": (
        [_TOOLS + "commands/"],
        ["tools/test_words_reach.py", "tools/test_commands_by_hand.py", "tools/test_cli.py",
         "compare/test_compare.py", "guide/test_guide.py", "replay/test_replay.py",
         "tools/test_model.py"],
    ),
    # what stands in no folder: the library's own doors, and what all share
    "tools": (
        [_TOOLS],
        ["tools/test_words_reach.py", "tools/test_host.py", "tools/test_tools_by_hand.py",
         "tools/test_atomic.py", "tools/test_cli.py", _FIGURES + "[moved together]"],
    ),
    "model": (
        [_TOOLS + "model/"],
        ["tools/test_model" + name for name in (
            ".py", "_on_device.py")]
        + ["loop/test_basis.py", "tools/test_host.py"],
    ),
    "read": (
        [_TOOLS + "loop/read/"],
        ["loop/test_gate_by_hand.py", "loop/test_ticks.py", "loop/test_read_by_hand.py",
         _FIGURES + "[read]", _FIGURES + "[parts of reading]"],
    ),
    "fit": (
        [_TOOLS + "loop/fit/"],
        ["loop/test_" + name for name in (
            "chance.py", "left_out.py", "line.py", "pieces.py", "regression.py", "smooth.py")]
        + [_FIGURES + "[steps found]", _FIGURES + "[reported]"],
    ),
    "search": (
        [_TOOLS + "loop/search/"],
        ["loop/test_" + name for name in (
            "catalogue.py", "curve.py", "decide.py", "drift_test.py", "likely_hysteresis.py",
            "naming.py", "periodic.py", "select_by_hand.py", "selection.py", "steps_first.py",
            "steps_listed.py")]
        + [_FIGURES + f"[{whole}]" for whole in ("steps found", "searched one", "searched two")],
    ),
    "verify": (
        [_TOOLS + "loop/verify/"],
        ["loop/test_courses.py", "loop/test_judge.py", "loop/test_kernels_by_hand.py",
         "loop/test_power_on.py", _FIGURES + "[reported]"],
    ),
    # its figures see more than whole closings do, which would take all of a mutant's time
    "turning": (
        [_TOOLS + "loop/motion/"],
        ["loop/test_axes_by_gravity.py::test_" + name for name in (
            "a_gap_of_days_leaves_the_motion_before_and_after_it",
            "a_hand_that_turns_one_way_more_than_back_is_no_bias",
            "a_loud_recording_that_hides_tilts_does_not_outweigh_a_quiet_one_when_judged",
            "a_slow_recording_may_end_with_one_sample_more_than_it_is_read_in",
            "one_turn_between_two_rests_is_told_by_gravity_before_and_after_it",
            "only_entries_that_surely_lessen_the_heading_lost_are_deployed")]
        + ["loop/test_courses.py", "loop/test_power_on.py", "loop/test_motion_by_hand.py",
           _FIGURES + "[moved]", _FIGURES + "[moved together]"],
    ),
    "findings": (
        [_TOOLS + "loop/"],
        ["loop/test_analyse.py", "loop/test_report_form.py", "loop/test_unexplained.py",
         _FIGURES + "[reported]"],
    ),
    "report": (
        [_TOOLS + "report/"],
        ["report/test_page.py", "report/test_plots.py", "report/test_print.py",
         _FIGURES + "[drawn]", _FIGURES + "[reported]"],
    ),
    "replay": ([_TOOLS + "replay/"], ["replay/"]),
    "simulate": (
        [_TOOLS + "simulate/"],
        ["tools/test_simulate.py", _FIGURES + "[simulated]"],
    ),
    "fleet": (
        [_TOOLS + "fleet/"],
        ["fleet/test_run.py", "fleet/test_population.py", "fleet/test_cluster.py",
         _FIGURES + "[fleet of ten]", _FIGURES + "[parts of a fleet]"],
    ),
    "boards": (
        [_TOOLS + "boards/"],
        ["drivers/test_" + name for name in (
            "streams_by_hand.py", "flashing_by_hand.py", "record_bus.py", "packages.py")],
    ),
    "kernels": (
        [_TOOLS + "kernels/", _TOOLS + "layout/"],
        ["layout/", "native/test_export_c.py", "native/test_kernels_in_c.py", KNOWN,
         "replay/test_library.py", _FIGURES + "[exported]"],
    ),
    # what is shown beside others: the comparison, the demo, and the methods of others
    "compare": (
        [_TOOLS + "compare/", _TOOLS + "demo/", _TOOLS + "peers.py"],
        ["compare/", "demo/", _FIGURES + "[compared]",
         _FIGURES + "[demonstrated]"],
    ),
    "watch": (
        [_TOOLS + "watch/", _TOOLS + "guide.py"], ["watch/", _FIGURES + "[watched]"],
    ),
    "runtimes": (
        [_TOOLS + "runtimes/"],
        ["runtimes/test_interpreters.py"],
    ),
    "service": (
        [_TOOLS + "service/"], ["service/test_service.py", _FIGURES + "[served]"],
    ),
}  # fmt: skip


@functools.cache
def _listed():
    """mutants.toml: files that are apart, and mutants that mean the same."""
    return tomllib.loads(SURVIVORS_AND_WHY.read_text(encoding="utf-8"))


def area_of(file):
    """The area of a file, by the longest folder above it; None if it has none or is apart."""
    areas = {folder: name for name, (folders, _) in AREAS.items() for folder in folders}
    longest = max(filter(file.startswith, areas), key=len, default=None)
    return None if apart(file) else areas.get(longest)


def apart(file):
    """Why a file has no mutants; or ""."""
    return next((e["why"] for e in _listed()["apart"] if fnmatch(file, e["file"])), "")


def files_of(name):
    """The files of an area, below the repository's folder."""
    paths = [path for folder in AREAS[name][0] for path in _below(REPOSITORY / folder)]
    files = [path.relative_to(REPOSITORY).as_posix() for path in paths]
    return sorted(f for f in set(files) if area_of(f) == name)


def _below(path):
    return path.rglob("*.py") if path.is_dir() else [path]


def _annotations(source):
    """[(start, end)] of all annotations, each (row, column)."""
    kinds = (ast.arg, ast.AnnAssign), (ast.FunctionDef, ast.AsyncFunctionDef)
    nodes = list(ast.walk(ast.parse(source)))
    found = [node.annotation for node in nodes if isinstance(node, kinds[0])]
    found += [node.returns for node in nodes if isinstance(node, kinds[1])]
    return [
        ((a.lineno, a.col_offset), (a.end_lineno, a.end_col_offset)) for a in found if a is not None
    ]


def _is_wording(node):
    """Whether a node of parso joins, repeats or fills a text, or is the number by which it does."""
    beside = [n for n in (node.get_previous_sibling(), node.get_next_sibling()) if n is not None]
    if node.type == "number":
        return any(n.type == "operator" and _is_wording(n) for n in beside)
    texts = {"string", "strings", "fstring"}
    return getattr(node, "value", "") in ("+", "*", "%") and any(n.type in texts for n in beside)


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
            at = [(node, at) for node in nodes for at, _ in operator.mutation_positions(node)]
            for occurrence, (node, start) in enumerate(at):
                row = start[0]
                in_layout = any(a < row <= b for a, b in zip(written[::2], written[1::2]))
                annotates = any(a <= start < b for a, b in annotations)
                no_code = in_layout or annotates or _is_wording(node)
                if not no_code and not _SAME.search(rows[row - 1]):
                    found.append((file, name, occurrence, row))
    return found


def same(mutant, text, mutated="", below=()):
    """Why the mutant of a line, which makes another of it, means the same; or "".

    below: the lines below it.
    """
    if mutant[1].endswith(_AT_LIMIT) and _LIMIT.search("\n".join([text, *below, ""])):
        return "at the limit both are the limit"
    if _sums_alike(*mutant, text, mutated):
        return "it makes the same of these numbers"
    for entry in _listed()["same"]:
        names = entry["operators"]
        there = mutant[0].startswith(entry["file"]) and mutated in entry.get("become", [mutated])
        lines = entry["line"] if isinstance(entry["line"], list) else [entry["line"]]
        if there and text in lines and mutant[1].rpartition("/")[2] in names:
            return entry["why"]
    return ""


def _sums_alike(file, operator, text, mutated):
    """Whether another operator makes what + makes, of an index and 0 by name or of two numbers."""
    become, at = operator.partition("Operator_Add_")[2], len(os.path.commonprefix([text, mutated]))
    sums = [m.groups() for m in _SUM.finditer(text) if m.start() < at < m.end()]
    if become not in _LIKE_ADD or not sums:
        return False
    source = (REPOSITORY / file).read_text(encoding="utf-8")
    one, other = (_constant(name, source) for name in sums[0])
    if one is None or other is None:
        return other == 0 or (one == 0 and become in ("BitOr", "BitXor"))
    return _LIKE_ADD[become](one, other) == one + other


def _constant(name, source):
    """The number that a word of code is, by itself or by name; None where it is none."""
    named = re.search(rf"^{name} = const\((-?\w+)\)$", source, re.MULTILINE)
    return int(name) if name.isdigit() else int(named[1], 0) if named else None


def _keyword_only(source):
    """How many parameters of each function go by name alone. Raises SyntaxError."""
    nodes = ast.walk(ast.parse(source))
    return [len(node.kwonlyargs) for node in nodes if isinstance(node, ast.arguments)]


def draws(files, seed):
    """Yield (file, operator, occurrence, row, line, mutated text), all that are Python."""
    every = mutants(files)
    for file, operator, occurrence, row in random.Random(seed).sample(every, len(every)):
        source = (REPOSITORY / file).read_text(encoding="utf-8")
        # the * of a parameter list is no product, and cosmic-ray knows no dot after except
        with contextlib.suppress(SyntaxError, AttributeError):
            text = mutate_code(source, plugins.get_operator(operator)(), occurrence)
            if _keyword_only(text) != _keyword_only(source):
                continue
            yield file, operator, occurrence, row, source.splitlines()[row - 1].strip(), text


def area_score(name, count, seed):
    """Counter of same and of how the others end; prints each that no test killed."""
    files, tests = files_of(name), [f"host_tests/{test}" for test in AREAS[name][1]]
    found, drawn, said = Counter(), {}, {}
    for number, (file, operator, occurrence, row, line, text) in enumerate(
        itertools.islice(draws(files, seed), count)
    ):
        mutated, *below = text.splitlines()[row - 1 : row + 2]
        if same((file, operator), line, mutated.strip(), below):
            found["same"] += 1
            continue
        drawn[number] = (file, row, text)
        said[number] = f"{file}:{row} {operator} {occurrence}: {line}"
    for number, end in ends(tests, drawn).items():
        found[end] += 1
        if end != "killed":
            print(f"{end}: {said[number]}", flush=True)
    return found


def low_score(name, count, seed):
    """Whether an area's share is below nine tenths, having printed it."""
    found = area_score(name, count, seed)
    tried = found["killed"] + found["passed"]
    share = found["killed"] / tried if tried else 0.0
    apart_from_them = f"{found['same']} mean the same, {found['slow']} do not end"
    counts = f"{found['killed']} of {tried} killed, {apart_from_them}, {found['untried']} untried"
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
        interpreters = runtime_folder("")
        os.environ["ZERORATE_CACHE"] = cache
        Path(cache, "runtimes").symlink_to(interpreters)
        low = sum(low_score(name, chosen.each, chosen.seed) for name in chosen.areas or AREAS)
    return 1 if low else 0


if __name__ == "__main__":
    sys.exit(main())
