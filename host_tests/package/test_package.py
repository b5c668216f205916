"""The wheel and the sdist: what they carry, that they work where no checkout is, their URLs."""

import importlib.util
import json
import os
import re
import shutil
import subprocess
import sys
import sysconfig
import tarfile
import zipfile
from pathlib import Path

import numpy as np
import pytest
import yaml
from zerorate_tools import __version__
from zerorate_tools.model import Slot, build_model, read_model, write_model
from zerorate_tools.model.term import Term
from zerorate_tools.recordings import Recording, Scales, write_recording

from host_tests.docs.outputs import DEMO, demo_shown, same_but_for_rounding
from project_urls import public_address

PACKAGES = {
    "zerorate": "firmware",
    "zerorate_i2c": "drivers",
    "zerorate_tools": "tools",
    "zerorate_fakes": "host_tests/fakes",
}
#: Set by CI: dependencies come from the index, as a user's do, not from this environment.
FROM_INDEX = "ZERORATE_INSTALL_FROM_INDEX" in os.environ


def uv(*words, cwd=None):
    """Run uv, or fail with what it said."""
    command = [sys.executable, "-m", "uv", "--quiet", *map(str, words)]
    done = subprocess.run(command, capture_output=True, text=True, cwd=cwd)
    assert done.returncode == 0, done.stderr


def fresh_python(folder, base=sys.executable):
    """The interpreter of a new virtual environment in `folder`, made with `base`."""
    uv("venv", "--python", base, folder / "venv")
    return folder / "venv" / ("Scripts" if os.name == "nt" else "bin") / "python"


@pytest.fixture(scope="module")
def built(repository, tmp_path_factory):
    """(sdist, wheel), the wheel built from the sdist."""
    folder = tmp_path_factory.mktemp("dist")
    uv("build", "--no-build-isolation", "--python", sys.executable, "--out-dir", folder, repository)
    (sdist,), (wheel,) = folder.glob("*.tar.gz"), folder.glob("*.whl")
    return sdist, wheel


@pytest.fixture(scope="module")
def away(built, tmp_path_factory):
    """run(*words) -> what a fresh environment with the wheel does, away from the checkout."""
    folder = tmp_path_factory.mktemp("away")
    python = fresh_python(folder)
    if FROM_INDEX:
        uv("pip", "install", "--python", python, f"{built[1]}[tools]")
    else:
        uv("pip", "install", "--python", python, "--no-deps", built[1])
        # the libraries of this environment; a .pth in there, of the editable install, is not read
        libraries = sysconfig.get_path("purelib")
        (site,) = (folder / "venv").rglob("site-packages")
        (site / "libraries.pth").write_text(libraries + "\n", encoding="utf-8")

    def run(*words):
        words = [python, *words]
        path = os.pathsep.join([str(python.parent), os.environ["PATH"]])
        narrow = {**os.environ, "PATH": path, "COLUMNS": "80", "TERM": "dumb"}
        return subprocess.run(words, capture_output=True, text=True, cwd=folder, env=narrow)

    run.folder = folder
    return run


@pytest.fixture(scope="module")
def bare(built, tmp_path_factory):
    """run(*words) -> what an environment with the wheel alone does, without any extra."""
    folder = tmp_path_factory.mktemp("bare")
    python = fresh_python(folder)
    uv("pip", "install", "--python", python, built[1])

    def run(*words):
        return subprocess.run([python, *words], capture_output=True, text=True, cwd=folder)

    return run


def sources(repository, package):
    """The files of a package in the checkout, as named in a wheel."""
    folder = repository / PACKAGES[package]
    files = (path for path in (folder / package).rglob("*") if path.is_file())
    names = (path.relative_to(folder).as_posix() for path in files)
    return {name for name in names if "__pycache__" not in name}


@pytest.mark.parametrize("package", PACKAGES)
def test_the_wheel_carries_every_file_of_a_package_and_no_other(repository, built, package):
    names = set(zipfile.ZipFile(built[1]).namelist())
    carried = {name for name in names if name.startswith(f"{package}/")}
    assert carried == sources(repository, package)


def test_the_sdist_has_what_a_checkout_needs_to_be_tested(built):
    with tarfile.open(built[0]) as archive:
        names = {name.partition("/")[2] for name in archive.getnames()}
    wanted = {"Makefile", "README.md", "LICENSE", "requirements/dev.txt", "host_tests/conftest.py"}
    wanted |= {".ci/run", ".ci/release.yml"}  # which tests read
    assert wanted <= names


def test_the_demo_runs_away_from_the_checkout_and_prints_what_its_page_shows(
    away, find_runtime, repository
):
    quick = find_runtime("x86").name  # the page's is wasm; host_tests/demo plays on each
    done = away("-m", "zerorate_tools.cli", "demo", "--out", "shown", "--runtime", quick)
    assert done.returncode == 0, done.stderr
    shown = demo_shown(repository)
    printed = done.stdout.replace(f"({quick})", "(wasm)")
    assert same_but_for_rounding(f"$ {DEMO}\n{printed}", shown), done.stdout
    named = re.findall(r"^  (shown/\S+)", shown, re.MULTILINE)
    assert len(named) == 4 and all((away.folder / name).is_file() for name in named)
    assert (away.folder / "shown" / "demo.png").read_bytes().startswith(b"\x89PNG")
    slots = read_model(away.folder / "shown" / "model.bin").slots
    remembering = {slot.effect for slot in slots if slot.term.memory != "none"}
    assert remembering == {"thermal-hysteresis"}


def test_what_runs_is_the_wheel_and_not_the_checkout(away, repository):
    done = away("-c", "import zerorate, zerorate_tools; print(zerorate.__file__)")
    assert done.returncode == 0, done.stderr
    assert not Path(done.stdout.strip()).is_relative_to(repository)


def test_firmware_drivers_and_fakes_need_nothing_else(bare):
    done = bare("-c", "import zerorate, zerorate_i2c.mpu6050, zerorate_fakes; zerorate.Corrector()")
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("version", ["3.10", "3.11", "3.12", "3.13"])
def test_firmware_and_command_line_run_on_every_python_that_is_here(version, built, tmp_path):
    words = [sys.executable, "-m", "uv", "python", "find", "--no-python-downloads", version]
    found = subprocess.run(words, capture_output=True, text=True, cwd=tmp_path)
    if found.returncode:
        pytest.skip(f"no Python {version} on this machine")
    python = fresh_python(tmp_path, found.stdout.strip())
    uv("pip", "install", "--python", python, built[1])
    code = (
        "from array import array; from zerorate import Corrector\n"
        "Corrector().update(array('i', [0, 0, 16384, 0, 1, 2, 3]), 10000)\n"
        "from zerorate_tools.cli import main; main([])"
    )
    done = subprocess.run([python, "-c", code], capture_output=True, text=True)
    assert "zerorate demo" in done.stdout, done.stderr


def test_without_its_extra_a_command_says_in_a_line_what_to_install(bare, built):
    done = bare("-m", "zerorate_tools.cli", "simulate", "day", "--out", "day.parquet")
    assert done.returncode == 2
    (line,) = done.stderr.splitlines()
    assert line.endswith(f"pip install '{built[1]}[tools]'")


def libraries_of_board(repository):
    """Modules of what the extra `board` asks for, and of what that brings."""
    brings = {"mpremote": ["mpremote", "serial"], "rich": ["rich", "pygments"]}
    (extra,) = re.findall(
        r"^board = (.*)", (repository / "pyproject.toml").read_text(), re.MULTILINE
    )
    for name in re.findall(r'"([\w-]+)', extra):
        yield from brings.get(name, [name.replace("-", "_")])


def test_with_its_extra_alone_all_of_the_page_on_a_board_runs(built, tmp_path, repository):
    python = fresh_python(tmp_path)
    if FROM_INDEX:
        uv("pip", "install", "--python", python, f"{built[1]}[board]")
    else:
        uv("pip", "install", "--python", python, "--no-deps", built[1])
        (site,) = (tmp_path / "venv").rglob("site-packages")
        for library in libraries_of_board(repository):
            spec = Path(next(iter(importlib.util.find_spec(library).submodule_search_locations)))
            for folder in (spec, spec.with_name(f"{library}.libs")):
                if folder.is_dir():
                    (site / folder.name).symlink_to(folder)

    def run(*words):
        words = [python, "-m", "zerorate_tools.cli", *words]
        return subprocess.run(words, capture_output=True, text=True, cwd=tmp_path)

    slot = Slot(Term("temp", 20.0, 45.0, 30.0), (0.01, 0.0, 0.0))
    scales = Scales("MPU-6050", 100.0, 131.0, 16384.0, 340.0, 36.53)
    write_model(build_model([slot], scales), tmp_path)
    done = run("flash", "/dev/no-board", "--dry-run", "--model", "model.bin")
    assert "lib/zerorate/corrector.mpy" in done.stdout, done.stderr
    assert run("export", "c", "c", "--model", "model.bin").returncode == 0
    columns = {
        name: np.zeros(50, np.int32) for name in ("ax", "ay", "az", "temp", "gx", "gy", "gz")
    }
    times = {"t_us": np.arange(50, dtype=np.int64) * 10000}
    write_recording(Recording({**times, **columns}, scales), tmp_path / "run.csv")
    assert "degC" in run("watch", "run.csv", "--once").stdout
    on_terminal = (
        "import pty; pty.spawn(['{}', '-m', 'zerorate_tools.cli', 'watch', 'run.csv', '--once'])"
    )
    shown = subprocess.run(
        [python, "-c", on_terminal.format(python)], capture_output=True, cwd=tmp_path
    )
    assert b"temperature" in shown.stdout
    for command in (["record", "/dev/no-board", "--out", "a.parquet"], ["watch", "/dev/no-board"]):
        assert "/dev/no-board: " in run(*command).stderr


def test_every_file_about_the_project_says_the_same_version(repository):
    for name, words in (
        ("CITATION.cff", f"version: {__version__}\n"),
        ("manifest.py", f'version="{__version__}"'),
        ("docs/pico.md", "/".join(["zerorate", f"firmware@v{__version__}"])),
    ):
        assert words in (repository / name).read_text(encoding="utf-8"), name


def test_a_release_runs_what_ci_runs_and_checks_what_it_uploads(repository):
    jobs = yaml.safe_load((repository / ".ci" / "release.yml").read_text())["jobs"]
    commands = {name: [step.get("run", "") for step in job["steps"]] for name, job in jobs.items()}
    assert ".ci/run" in commands["test"] and jobs["build"]["needs"] == "test"
    assert any("twine check --strict" in command for command in commands["build"])
    assert jobs["publish"]["needs"] == "build"


HTTPS = "https://forge.example/team/zerorate"
NEEDED = ("pyproject.toml", "project_urls.py", "README.md", "LICENSE", "CHANGELOG.md")
VERSION = "tools/zerorate_tools/__init__.py"


def hatchling(folder, *words):
    command = [sys.executable, "-m", "hatchling", *words]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout


def urls(folder):
    """What the metadata of a wheel built here would name, {} for nothing."""
    return json.loads(hatchling(folder, "metadata")).get("urls", {})


@pytest.mark.parametrize(
    "remote",
    [
        HTTPS,
        HTTPS + ".git",
        HTTPS + "/",
        "https://somebody:secret@forge.example/team/zerorate.git",
        "git@forge.example:team/zerorate.git",
        "ssh://git@forge.example:2222/team/zerorate.git",
    ],
)
def test_the_page_is_that_of_the_origin_and_tells_no_password(remote):
    assert public_address(remote) == HTTPS


@pytest.mark.parametrize(
    "remote", ["/home/me/zerorate", "../zerorate", "file:///srv/zerorate", "https://localhost/x"]
)
def test_a_place_that_nobody_else_reaches_is_none(remote):
    assert public_address(remote) is None


def test_an_sdist_keeps_the_urls_of_its_checkout_for_the_wheel_built_from_it(repository, tmp_path):
    checkout = tmp_path / "checkout"
    (checkout / VERSION).parent.mkdir(parents=True)
    for name in (*NEEDED, VERSION):
        shutil.copy(repository / name, checkout / name)
    for words in (["init", "-q"], ["remote", "add", "origin", HTTPS]):
        subprocess.run(["git", *words], cwd=checkout, check=True)
    hatchling(checkout, "build", "-t", "sdist", "-d", str(tmp_path))
    (sdist,) = tmp_path.glob("*.tar.gz")
    shutil.unpack_archive(sdist, tmp_path / "unpacked")
    (unpacked,) = (tmp_path / "unpacked").iterdir()
    shown = urls(checkout)
    assert urls(unpacked) == shown
    assert shown["Homepage"] == HTTPS and shown["Issues"] == f"{HTTPS}/issues"
    assert {"Changelog", "Documentation"} <= set(shown)
