"""The layout of the firmware's arrays: one name for one word, and every file's constants fresh."""

import re

import pytest
from zerorate import Corrector
from zerorate.model import EffectModel
from zerorate_tools import layout

from .page import files, page, refreshed, settings_page


def firmware(repository):
    """The files that people write."""
    found = (repository / "firmware" / "zerorate").rglob("*.py")
    return sorted(path for path in found if path.parent.name != "native")


def test_every_file_has_the_constants_of_the_layout(repository):
    stale = [path.name for path in files(repository) if refreshed(path) != path.read_text("utf-8")]
    assert stale == [], "run `make layout`"


def test_the_page_is_that_of_the_layout(repository):
    assert (repository / "docs" / "layout.md").read_text("utf-8") == page(), "run `make layout`"


def test_the_page_of_the_settings_is_that_of_the_code(repository):
    made = settings_page(repository)
    assert (repository / "docs" / "settings.md").read_text("utf-8") == made, "run `make layout`"


def test_no_name_stands_for_two_things():
    names = [word.name for array in layout.ARRAYS for word in array.words]
    names += [array.size_name for array in layout.ARRAYS if array.size_name]
    numbers = {pair for codes in layout.CODES for pair in codes.numbers.items()}
    names += [name for name, _ in numbers]  # store and model say some things by the same number
    assert sorted(names) == sorted(set(names))


def test_no_word_lies_behind_the_end():
    for array in (array for array in layout.ARRAYS if array.size):
        assert all(word.index + word.count <= array.size for word in array.words)


@pytest.mark.parametrize("block", [layout.INPUT, layout.SLOT, layout.PLAY, layout.RING])
def test_blocks_of_the_effect_model_fill_their_places(block):
    whole = {
        layout.INPUT: ("INPUTS", layout.LIMITS.MOST_INPUTS),
        layout.SLOT: ("SLOTS", layout.LIMITS.MOST_SLOTS),
        layout.PLAY: ("PLAYS", layout.LIMITS.MOST_PLAYS),
        layout.RING: ("RINGS", layout.LIMITS.MOST_RINGS),
    }
    name, most = whole[block]
    place = next(word for word in layout.EFFECTS.words if word.name == name)
    assert place.count == most * block.size


def test_the_arrays_are_as_long_as_the_layout_says():
    corrector = Corrector(motion=True, gravity=True)
    last = layout.axis_at(corrector.settings, 3)
    assert len(corrector.state) == last
    assert len(corrector.settings) == layout.SETTINGS.size
    assert len(corrector.motion_settings) == layout.MOTION_SETTINGS.size
    assert len(corrector.gravity) == layout.GRAVITY.size
    assert len(EffectModel().e) == layout.EFFECTS.size


BLOCKS = {"INPUTS": "INPUT", "SLOTS": "SLOT", "PLAYS": "PLAY", "RINGS": "RING"}
BLOCKS |= {"WINDOW_ROWS": "ROW", "ESTIMATORS": "ESTIMATOR"}


def place(array, name, settings):
    """The index and the unit of a word by its name, in an array or in a block of it."""
    word, number, inside = re.fullmatch(r"(\w+)(?:\[(\d+)\])?(?:\.(.+))?", name).groups()
    if array is layout.STATE and word in ("x", "y", "z"):
        at, unit = place(layout.AXIS, inside, settings)
        return layout.axis_at(settings, "xyz".index(word)) + at, unit
    behind = layout.TURN_ON.words if array is layout.STATE else []
    own = next(one for one in array.words + behind if one.name == word)
    first = own.index + (settings[layout.SETTINGS.AXES] if own in behind else 0)
    if not inside:
        return first + int(number or 0), own.unit
    block = getattr(layout, BLOCKS[word])
    at, unit = place(block, inside, settings)
    size = block.size or settings[layout.SETTINGS.ESTIMATOR_WORDS]
    if block is layout.SLOT:
        assert layout.slot_at(int(number)) == first + int(number) * size
    return first + int(number) * size + at, unit


@pytest.mark.parametrize("options", [{}, {"document": True}, {"bins": 5}])
def test_every_word_of_every_array_has_its_name_and_unit_at_its_place(options):
    corrector = Corrector(**{**options, "motion": True, "gravity": True})
    c = corrector.settings
    lengths = {"motion": len(corrector.motion), "gravity": len(corrector.gravity)}
    lengths["effects"] = layout.EFFECTS.size
    named = [(layout.STATE, layout.named_state(c), len(corrector.state))]
    named.append((layout.SETTINGS, layout.named(layout.SETTINGS, 9), 9))
    for name, length in lengths.items():
        source = layout.named_source(name, length)
        named.append((getattr(layout, name.upper()), source, length))
    for array, words, length in named:
        found = [place(array, name, c) for name, _ in words]
        assert found == [(at, unit) for at, (_, unit) in enumerate(words)]
        assert len(words) == length
