"""What is flashed, installed by mip and frozen is the same: the packages as they are."""

import json
import subprocess
import sys
from pathlib import PurePosixPath

import pytest
from zerorate_tools import __version__
from zerorate_tools.boards.flashing import package_files
from zerorate_tools.boards.manifests import FOLDERS, package_json

from host_tests.drivers.unix_board import UnixBoard

PACKAGES = sorted(FOLDERS)


@pytest.mark.parametrize("package", PACKAGES)
def test_package_json_is_fresh(repository, package):
    path = repository / FOLDERS[package] / "package.json"
    remedy = "python -m zerorate_tools.boards.manifests writes it again"
    assert path.read_text() == package_json(package), remedy


@pytest.mark.parametrize("package", PACKAGES)
def test_every_file_of_package_json_is_beside_it(repository, package):
    folder = repository / FOLDERS[package]
    listed = json.loads((folder / "package.json").read_text())["urls"]
    assert len(listed) > 5
    assert all((folder / url).is_file() for _, url in listed)


@pytest.mark.parametrize("package", PACKAGES)
def test_the_manifest_freezes_the_same_files(repository, package):
    folder = repository / FOLDERS[package]
    assert frozen(folder) == set(package_files(package))


@pytest.mark.parametrize("package", PACKAGES)
def test_the_manifest_has_the_project_version(repository, package):
    assert f'version="{__version__}"' in (repository / FOLDERS[package] / "manifest.py").read_text()


def test_the_driver_on_a_board_has_no_part_for_linux():
    assert PurePosixPath("zerorate_i2c/linux.py") not in package_files("zerorate_i2c")


def test_mip_installs_the_driver_from_package_json_and_it_imports(
    repository, find_runtime, tmp_path
):
    pytest.importorskip("mpremote")
    board = UnixBoard(find_runtime("x86"), tmp_path)
    source = str(repository / "drivers" / "package.json")
    command = [sys.executable, "-m", "mpremote", "connect", board.port]
    try:
        subprocess.run([*command, "mip", "install", "--target", "lib", source], check=True)
    finally:
        board.close()
    for name, path in package_files("zerorate_i2c").items():
        assert (tmp_path / "lib" / name).read_bytes() == path.read_bytes()
    runtime = find_runtime("x86")
    modules = [tmp_path / "lib"]
    said = runtime.run("import zerorate_i2c.fifo\nprint('ok')\n", modules=modules, check=True)
    assert said.stdout.strip() == "ok"


def frozen(folder):
    """Files that a manifest.py names, by the rules of MicroPython's docs/reference/manifest.rst."""
    found = set()

    def package(name, files=None):
        below = [path.relative_to(folder) for path in (folder / name).rglob("*.py")]
        found.update(
            PurePosixPath(path)
            for path in below
            if files is None or str(path.relative_to(name)) in files
        )

    text = (folder / "manifest.py").read_text()
    exec(compile(text, "manifest.py", "exec"), {"package": package, "metadata": lambda **_: None})
    return found
