"""The wheel's URLs: of the place that the sources came from, where others reach it."""

import json
import shutil
import subprocess
import sys

import pytest

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


@pytest.fixture
def cloned(repository, tmp_path):
    """cloned(remote) -> a checkout whose origin is that."""

    def make(remote):
        folder = tmp_path / "checkout"
        (folder / VERSION).parent.mkdir(parents=True)
        for name in (*NEEDED, VERSION):
            shutil.copy(repository / name, folder / name)
        for words in (["init", "-q"], ["remote", "add", "origin", remote]):
            subprocess.run(["git", *words], cwd=folder, check=True)
        return folder

    return make


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
def test_urls_are_of_the_origin_and_tell_no_password(cloned, remote):
    shown = urls(cloned(remote))
    assert shown["Homepage"] == HTTPS and shown["Issues"] == f"{HTTPS}/issues"
    assert all(url.startswith(HTTPS) for url in shown.values())
    assert {"Changelog", "Documentation"} <= set(shown)


@pytest.mark.parametrize(
    "remote", ["/home/me/zerorate", "../zerorate", "file:///srv/zerorate", "https://localhost/x"]
)
def test_a_place_that_nobody_else_reaches_gives_none(cloned, remote):
    assert urls(cloned(remote)) == {}


def test_an_sdist_keeps_the_urls_for_the_wheel_built_from_it(cloned, tmp_path):
    checkout = cloned(HTTPS)
    hatchling(checkout, "build", "-t", "sdist", "-d", str(tmp_path))
    (sdist,) = tmp_path.glob("*.tar.gz")
    shutil.unpack_archive(sdist, tmp_path / "unpacked")
    (unpacked,) = (tmp_path / "unpacked").iterdir()
    assert urls(unpacked) == urls(checkout) != {}
