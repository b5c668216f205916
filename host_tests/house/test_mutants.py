"""`make mutants` tells mutants from code that cannot be told apart, and tests see them."""

import sys

from ..mutant_trials import REPOSITORY, InPlaceOf, ends
from ..mutants import AREAS, mutants

GUARD = "firmware/zerorate/rest/guard.py"


def test_annotations_and_written_constants_have_no_mutants():
    found = mutants([GUARD])
    lines = (REPOSITORY / GUARD).read_text(encoding="utf-8").splitlines()
    drawn = {lines[row - 1] for _, _, _, row in found}
    assert "    repeats = exchange(s, x)" not in drawn and len(found) > 250
    assert not any("const(" in line and "_MOST_US" not in line for line in drawn)
    assert not any(line.startswith("def ") for line in drawn)


def test_every_file_and_every_test_of_an_area_is_there():
    named = [name for files, tests in AREAS.values() for name in (*files, *tests)]
    assert [name for name in named if not (REPOSITORY / name.partition("::")[0]).is_file()] == []


def test_a_mutant_stands_in_the_place_of_its_module(tmp_path, monkeypatch):
    (tmp_path / "mutated.py").write_text("VALUE = 1")
    monkeypatch.syspath_prepend(tmp_path)
    place = InPlaceOf(tmp_path / "mutated.py", "VALUE = 2")
    monkeypatch.setattr(sys, "meta_path", [place, *sys.meta_path])
    import mutated

    assert mutated.VALUE == 2
    monkeypatch.undo()
    del sys.modules["mutated"]


def test_mutants_of_functions_and_of_modules_are_told_from_those_that_live(tmp_path, monkeypatch):
    source = "LIMIT = 3\n\n\ndef below(n):\n    return n < LIMIT\n"
    (tmp_path / "limits.py").write_text(source)
    (tmp_path / "test_it.py").write_text(
        "from limits import below\n\ndef test_it():\n    assert below(1) and not below(4)\n"
    )
    monkeypatch.syspath_prepend(tmp_path)
    changes = [("<", "<="), ("<", ">"), ("3", "2"), ("3", "0")]
    drawn = {
        number: (str(tmp_path / "limits.py"), source.replace(before, after))
        for number, (before, after) in enumerate(changes)
    }
    found = ends([str(tmp_path)], drawn)
    assert [found[number] for number in range(4)] == ["passed", "killed", "passed", "killed"]
