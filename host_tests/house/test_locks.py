"""What is installed is pinned, by locks that agree with pyproject.toml and with each other."""

import re
import sys

import pytest
from packaging.requirements import Requirement

from .readability import LEAST_READING_EASE, MOST_WORDS_A_SENTENCE, pages, prose, readability

if sys.version_info >= (3, 11):
    import tomllib
else:
    import tomli as tomllib


def pins(path):
    """Name -> its pins, one for each marker."""
    lines = path.read_text(encoding="utf-8").splitlines()
    pinned = {}
    for line in lines:
        if line and not line.lstrip().startswith("#"):
            requirement = Requirement(line)
            pinned.setdefault(requirement.name, set()).add(line)
    return pinned


@pytest.fixture
def requirements(repository):
    return repository / "requirements"


@pytest.fixture
def extras(repository):
    project = tomllib.loads((repository / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    return {
        extra: [Requirement(line) for line in lines]
        for extra, lines in project["optional-dependencies"].items()
    }


@pytest.mark.parametrize("lock", ["tools.txt", "dev.txt", "node.txt"])
def test_every_line_of_a_lock_is_an_exact_pin(requirements, lock):
    pinned = pins(requirements / lock)
    assert pinned
    for line in (line for lines in pinned.values() for line in lines):
        assert re.match(r"[a-z0-9.-]+==[^ *]+( ;|$)", line)


def test_no_lock_names_a_host(repository):
    locks = [*repository.glob("requirements/*"), *repository.rglob("tools/**/package-lock.json")]
    assert len(locks) > 4
    assert [lock.name for lock in locks if "://" in lock.read_text(encoding="utf-8")] == []


def test_the_two_locks_agree(requirements):
    tools, dev = pins(requirements / "tools.txt"), pins(requirements / "dev.txt")
    differing = [name for name in tools.keys() & dev.keys() if tools[name] != dev[name]]
    assert differing == []


@pytest.mark.parametrize("extra", ["tools", "linux", "fleet", "bench", "dev"])
def test_every_need_is_locked_in_a_version_that_satisfies_it(requirements, extras, extra):
    locked = pins(requirements / ("tools.txt" if extra == "tools" else "dev.txt"))
    for need in extras[extra]:
        assert need.name in locked, f"`make lock` adds {need.name}"
        versions = [line.split("==")[1].split(" ")[0] for line in locked[need.name]]
        assert all(need.specifier.contains(version) for version in versions), need


def test_every_page_reads_easily(repository):
    found = {p: readability((repository / p).read_text("utf-8")) for p in pages(repository)}
    assert len(found) > 25
    hard = {
        page: (words, ease)
        for page, (words, ease) in found.items()
        if words > MOST_WORDS_A_SENTENCE or ease < LEAST_READING_EASE
    }
    assert hard == {}


def test_only_sentences_count():
    page = (
        "# A title\n\nIt takes 3.5 s of [rest](docs/rest.md), says `a.py`:\n\n- one\n- two.\n\n"
        "| table | is |\n|---|---|\n| not | prose |\n\n```python\ncode\n```\n\n![picture](a.png)\n"
    )
    assert prose(page) == "It takes 35 s of rest, says code.\none.\ntwo."


def test_long_sentences_of_long_words_are_hard_to_read():
    hard = "Notwithstanding considerable instrumentation heterogeneity, " * 8 + "it works."
    words, ease = readability(hard)
    assert words > MOST_WORDS_A_SENTENCE and ease < LEAST_READING_EASE
