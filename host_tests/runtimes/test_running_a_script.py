"""One script, the same on every interpreter."""

import pytest
from zerorate_tools.errors import MissingRuntime, ZerorateError
from zerorate_tools.runtimes import find

ROUND_TRIP = """
with open("in.bin", "rb") as source, open("deep/out.bin", "wb") as target:
    target.write(bytes(255 - byte for byte in source.read()))
"""

UNDER_LOCK = """
import micropython
from array import array
counts = array("i", [0] * 4)
def count():
    for i in range(4):
        counts[i] += i * 1000003
def make_a_list():
    return [0] * 10
count()
micropython.heap_lock()
try:
    count()
    print("counting takes nothing")
    make_a_list()
    print("a list was made under lock")
except MemoryError:
    print("a list is refused")
micropython.heap_unlock()
"""


def test_arguments_arrive_as_written(runtime):
    result = runtime.run("import sys\nprint('|'.join(sys.argv[1:]))\n", ["two words", 3, "ä"])
    assert result.stdout.strip() == "two words|3|ä"


def test_a_script_in_a_file_runs_as_the_main_module(runtime, tmp_path):
    script = tmp_path / "say.py"
    script.write_text("if __name__ == '__main__':\n    print('main')\n")
    assert runtime.run(script).stdout.strip() == "main"


def test_all_bytes_make_the_round_trip(runtime):
    result = runtime.run(
        ROUND_TRIP,
        files_in={"in.bin": bytes(range(256)) * 300, "deep/here": b""},
        files_out=["deep/out.bin", "never-written.bin"],
        check=True,
    )
    assert result.files == {"deep/out.bin": bytes(range(255, -1, -1)) * 300}


def test_a_file_of_the_host_is_read(runtime, tmp_path):
    (tmp_path / "host.txt").write_bytes(b"from the host\n")
    result = runtime.run(
        "\nprint(open('a.txt').read())\n", files_in={"a.txt": tmp_path / "host.txt"}
    )
    assert result.stdout.strip() == "from the host"


def test_modules_are_imported_from_their_folders(runtime, tmp_path):
    for name in ("one", "two"):
        (tmp_path / name / f"pack_{name}").mkdir(parents=True)
        (tmp_path / name / f"pack_{name}" / "__init__.py").write_text("from .part import X\n")
        (tmp_path / name / f"pack_{name}" / "part.py").write_text(f"X = '{name}'\n")
    script = "import pack_one, pack_two\nprint(pack_one.X, pack_two.X)\n"
    result = runtime.run(script, modules=[tmp_path / "one", tmp_path / "two"], check=True)
    assert result.stdout.strip() == "one two"


def test_standard_input_is_given(runtime):
    result = runtime.run("import sys\nprint(repr(sys.stdin.readline()))\n", stdin=b"a line\n")
    assert result.stdout.strip() == r"'a line\n'"


@pytest.mark.parametrize(
    ("ending", "code"), [("", 0), ("sys.exit()", 0), ("sys.exit(3)", 3), ("1 // 0", 1)]
)
def test_the_exit_code_is_the_scripts(runtime, ending, code):
    result = runtime.run(f"import sys\nprint('before')\n{ending}\n")
    assert (result.stdout.strip(), result.returncode) == ("before", code)


def test_a_failed_check_tells_the_scripts_last_words(runtime):
    with pytest.raises(ZerorateError, match=rf"main.py failed on {runtime.name}.*KeyError"):
        runtime.run("\n{}['absent']\n", check=True)


def test_a_script_that_never_ends_is_stopped(runtime):
    with pytest.raises(ZerorateError, match="stopped after"):
        runtime.run("while True:\n    pass\n", timeout=2)


def test_allocating_under_heap_lock_is_a_memory_error(micropython):
    said = micropython.run(UNDER_LOCK, check=True).stdout.splitlines()
    assert said == ["counting takes nothing", "a list is refused"]


def test_a_script_that_fails_under_heap_lock_ends(micropython):
    script = "import micropython\nmicropython.heap_lock()\n[1, 2, 3]\n"
    assert micropython.run(script, timeout=60).returncode == 1


def test_small_integers_have_31_bits(micropython):
    script = """
import micropython
def product(a, b):
    return a * b
product(1, 1)
micropython.heap_lock()
try:
    print(product(32768, 32767))
    print(product(32768, 32768))
except MemoryError:
    print("on the heap")
micropython.heap_unlock()
"""
    assert micropython.run(script).stdout.splitlines() == ["1073709056", "on the heap"]


@pytest.mark.parametrize("name", ["x86", "armhf"])
def test_the_heap_is_as_large_as_asked(find_runtime, name):
    script = "import gc\ngc.collect()\nprint(gc.mem_free() + gc.mem_alloc())\n"
    assert int(find_runtime(name).run(script, heap=100_000).stdout) in range(90_000, 100_001)


@pytest.mark.parametrize("name", ["x86", "armhf"])
def test_an_executable_is_found_by_its_path(find_runtime, name, tmp_path):
    known = find_runtime(name)
    launch = " ".join([*known.launcher, str(known.executable)])
    wrapper = tmp_path / "micropython"
    wrapper.write_text(f'#!/bin/sh\nexec {launch} "$@"\n')
    wrapper.chmod(0o755)
    runtime = find(wrapper)
    assert runtime.run("\nprint('here')\n").stdout.strip() == "here"


def test_an_unknown_name_lists_the_known_ones():
    with pytest.raises(MissingRuntime, match="cpython, wasm, x86, armhf"):
        find("micropithon")


def test_an_interpreter_that_is_not_fetched_says_how_to_get_it(tmp_path, monkeypatch):
    monkeypatch.setenv("ZERORATE_CACHE", str(tmp_path))
    for name in ("wasm", "x86", "armhf"):
        with pytest.raises(MissingRuntime, match=f"zerorate runtimes get {name}"):
            find(name)


def test_a_file_name_outside_the_scratch_folder_is_refused():
    for name in ("../up", "/etc/passwd"):
        with pytest.raises(ValueError, match="relative name"):
            find("cpython").run("\npass\n", files_in={name: b""})
