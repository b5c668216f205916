"""A name of the firmware has one meaning, and one file says where a word of the state is."""

from pathlib import Path

from .census import layouts, several

FIRMWARE = Path(__file__).resolve().parents[2] / "firmware" / "zerorate"


def written():
    """The firmware's files, generated ones apart."""
    return [p for p in FIRMWARE.rglob("*.py") if p.parent.name != "native"]


def test_a_constant_has_one_value_in_all_files():
    assert several(written()) == set()


def test_no_file_of_a_board_but_the_headers_of_stores_says_where_a_word_is():
    own = {"store.py", "learned_store.py", "differing.py"}
    assert {path.name for path in layouts(written())} == own


def test_a_second_value_is_found(tmp_path):
    for name, value in (("a.py", 1), ("b.py", 2)):
        (tmp_path / name).write_text(f"_X = const({value})\n")
    assert several(tmp_path.glob("*.py")) == {"_X"}
