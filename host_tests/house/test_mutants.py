"""`make mutants` tells mutants from code that cannot be told apart, and tests see them."""

import sys

from ..mutants import AREAS, REPOSITORY, InPlaceOf, mutants

GUARD = "firmware/zerorate/rest/guard.py"


def test_annotations_and_written_constants_have_no_mutants():
    found = mutants([GUARD])
    lines = (REPOSITORY / GUARD).read_text(encoding="utf-8").splitlines()
    drawn = {lines[row - 1] for _, _, _, row in found}
    assert "    repeats = exchange(s, x)" not in drawn and len(found) > 300
    assert not any("const(" in line and "_MOST_US" not in line for line in drawn)
    assert not any(line.startswith("def ") for line in drawn)


def test_every_file_and_every_test_of_an_area_is_there():
    named = [name for files, tests in AREAS.values() for name in (*files, *tests)]
    assert [name for name in named if not (REPOSITORY / name.partition("::")[0]).is_file()] == []


def test_a_mutant_stands_in_the_place_of_its_module(tmp_path, monkeypatch):
    (tmp_path / "mutated.py").write_text("VALUE = 1")
    (tmp_path / "test_it.py").write_text(
        "import mutated\n\ndef test_it():\n    assert mutated.VALUE == 1\n"
    )
    monkeypatch.syspath_prepend(tmp_path)
    place = InPlaceOf(tmp_path / "mutated.py", "VALUE = 2")
    monkeypatch.setattr(sys, "meta_path", [place, *sys.meta_path])
    import mutated

    assert mutated.VALUE == 2
    monkeypatch.undo()
    del sys.modules["mutated"]
