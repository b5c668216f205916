"""Print the mutants of FILES that no test of TESTS kills, and the share of those killed.

make mutants FILES='firmware/zerorate/rest/*.py' TESTS='host_tests/firmware host_tests/golden'.
cosmic-ray makes the mutants, in a copy of the checkout. Some mean the same as the code.
"""

import argparse
import os
import random
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from cosmic_ray import plugins
from cosmic_ray.ast import ast_nodes, get_ast
from cosmic_ray.mutating import mutate_code

REPOSITORY = Path(__file__).resolve().parents[1]
_NOT_COPIED = shutil.ignore_patterns(".git", ".venv", "__pycache__", "site", "dist")
_PATIENCE_S = 600


def mutants(file):
    """Yield (file, operator, occurrence) of every mutant of a file."""
    nodes = list(ast_nodes(get_ast(Path(file).read_text(encoding="utf-8"))))
    for name in sorted(plugins.operator_names()):
        operator = plugins.get_operator(name)
        if not operator.arguments():
            at = [place for node in nodes for place in operator().mutation_positions(node)]
            yield from ((file, name, occurrence) for occurrence in range(len(at)))


def is_killed(copy, file, text, tests):
    """Whether a test fails, or does not end, with a text in the place of a file of the copy."""
    whole = (copy / file).read_text(encoding="utf-8")
    folders = ("", "tools", "firmware", "drivers", "host_tests/fakes")
    path = {"PYTHONPATH": os.pathsep.join(str(copy / folder) for folder in folders)}
    command = [sys.executable, "-m", "pytest", "-x", "-q", "-p", "no:cacheprovider", *tests]
    try:
        (copy / file).write_text(text, encoding="utf-8")
        how = {"cwd": copy, "env": os.environ | path, "timeout": _PATIENCE_S}
        return subprocess.run(command, capture_output=True, **how).returncode != 0
    except subprocess.TimeoutExpired:
        return True
    finally:
        (copy / file).write_text(whole, encoding="utf-8")


def main():
    """Print the mutants that live; 1 where fewer than nine tenths are killed."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("files", nargs="+", metavar="FILE", help="below the checkout's folder")
    parser.add_argument("--tests", nargs="+", required=True, help="files or folders for pytest")
    parser.add_argument("--each", type=int, default=25, help="mutants that are drawn")
    parser.add_argument("--seed", type=int, default=random.SystemRandom().randrange(1 << 31))
    chosen = parser.parse_args()
    os.chdir(REPOSITORY)
    every = [mutant for file in chosen.files for mutant in mutants(file)]
    drawn = random.Random(chosen.seed).sample(every, min(chosen.each, len(every)))
    killed = 0
    with tempfile.TemporaryDirectory(prefix="zerorate-mutants-") as folder:
        copy = shutil.copytree(REPOSITORY, Path(folder, "copy"), ignore=_NOT_COPIED, symlinks=True)
        if is_killed(copy, file := drawn[0][0], Path(file).read_text("utf-8"), chosen.tests):
            raise SystemExit("the tests fail as they are")
        for file, name, occurrence in drawn:
            source = Path(file).read_text(encoding="utf-8")
            text = mutate_code(source, plugins.get_operator(name)(), occurrence)
            if is_killed(copy, file, text, chosen.tests):
                killed += 1
                continue
            before, after = source.splitlines(), text.splitlines()
            row = next(row for row, pair in enumerate(zip(before, after)) if len({*pair}) > 1)
            print(f"{file}:{row + 1}: {before[row].strip()} -> {after[row].strip()}", flush=True)
    print(f"{killed} of {len(drawn)} killed, --seed {chosen.seed}")
    return int(killed < 0.9 * len(drawn))


if __name__ == "__main__":
    sys.exit(main())
