"""Private names are short in what a board gets; the numbers and what a program names stay."""

import ast
import json
from pathlib import PurePosixPath

import pytest
from zerorate_tools.boards.parts import PARTS, part_files
from zerorate_tools.boards.short_names import short_names, shortened

from host_tests.firmware import trace
from host_tests.firmware.trace_on_host import GOLDEN, checksums


@pytest.fixture(scope="module")
def files():
    """Path on the board -> file, of all parts."""
    return part_files(PARTS)


@pytest.fixture(scope="module")
def short(files, tmp_path_factory):
    """A folder with all of it, its names short."""
    folder = tmp_path_factory.mktemp("short")
    for name, path in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(shortened(path, path.read_text()))
    return folder


def public(text):
    """What a program may call: names, methods and their parameters, less what begins with _."""
    tree = ast.parse(text)
    return {
        (node.name, *(arg.arg for arg in node.args.args))
        for node in ast.walk(tree)
        if isinstance(node, ast.FunctionDef) and not node.name.startswith("_")
    }


@pytest.mark.parametrize("name", ["checked", "corrector", "storage/store", "storage/places"])
def test_what_a_program_may_call_keeps_its_names(short, files, name):
    name = PurePosixPath(f"zerorate/{name}.py")
    nested = {("update", "x", "dt_us", "kept")}
    before = public(files[name].read_text()) - nested
    assert before and before <= public((short / name).read_text())


def test_two_names_that_meet_stay_two(files):
    names = short_names()
    assert len(names) > 100 and len(set(names.values())) < 50
    for path in files.values():
        tree = ast.parse(path.read_text())
        attributes = {n.attr for n in ast.walk(tree) if isinstance(n, ast.Attribute)}
        attributes |= {n.name for n in ast.walk(tree) if isinstance(n, ast.FunctionDef)}
        after = [names.get(name, name) for name in attributes]
        assert len(after) == len(set(after)), path


def test_a_constant_of_another_module_is_its_number(short):
    text = (short / "zerorate_i2c" / "fifo.py").read_text()
    assert "from .registers import decode\n" in text and "status >= 2" in text


def test_the_numbers_are_the_golden_ones(short, repository, find_runtime):
    there = repository / "host_tests" / "firmware"
    result = find_runtime("wasm").run(
        there / "on_micropython" / "trace_without_heap.py",
        ["ignoring", trace.UPDATES["ignoring"]],
        modules=[short, there],
        files_out=["state.bin", "bias.bin"],
        check=True,
    )
    golden = json.loads(GOLDEN.read_text())["ignoring"]
    assert checksums(result.files["state.bin"], result.files["bias.bin"]) == golden
