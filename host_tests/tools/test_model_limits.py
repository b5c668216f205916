"""The firmware takes every number of a model up to the ends of its range, and none beyond."""

import struct
import zlib
from array import array

import pytest
from zerorate import Sensor
from zerorate.effects import model_file
from zerorate.effects.model_file import IMPOSSIBLE, LOADED, OTHER_SCALE, TOO_LARGE
from zerorate.model import EffectModel
from zerorate_tools.layout import INPUT_KIND, MARKS, PLAY, SLOT
from zerorate_tools.model import Binding, Slot, build_model, encoded
from zerorate_tools.model.term import Term

from .test_model import SCALES, TABLE

TABLED, PLAIN, PLAYED = 0, 1, 2
SLOTS = [
    Slot(Term("temp", 20, 45, 30, table=TABLE), (0.1, 0, 0)),
    Slot(Term("load", -1, 1), (1e-6, 0, 0)),
    Slot(Term("temp", 20, 45, 32.5, memory="play", width=3), (0.001, 0, 0)),
]
INPUT_BYTES, SLOT_BYTES, BODY = 12, 120, 60
INPUTS, TABLES = 2, 1
TEMPERATURE, CHANNEL = 0, 1
PLACES = [BODY + INPUT_BYTES * INPUTS + SLOT_BYTES * i for i in range(2)]
PLACES.append(PLACES[1] + SLOT_BYTES + 36 * TABLES)
WIDE = 1 << 25
LARGE = 1 << 26

# (slot, word, least, most)
WORDS = [
    (PLAIN, SLOT.SLOT_SOURCE, 0, INPUTS - 1),
    (PLAIN, SLOT.SLOT_SECOND, -1, INPUTS - 1),
    (PLAIN, SLOT.SLOT_SHIFT, -8, 24),
    (PLAIN, SLOT.SLOT_POWER, 1, 3),
    (PLAIN, SLOT.SLOT_MEMORY, 0, 5),
    (PLAIN, SLOT.SLOT_LAG, 0, 1 << 15),
    (PLAIN, SLOT.SLOT_LAG + 1, 0, 13),
    (PLAIN, SLOT.SLOT_HALF_WIDTH, -WIDE, WIDE),
    (PLAIN, SLOT.SLOT_KNOT, -WIDE, WIDE),
    (PLAIN, SLOT.SLOT_DECAY, 0, 1 << 15),
    (PLAIN, SLOT.SLOT_DECAY + 1, 0, 13),
    (PLAIN, SLOT.SLOT_COEFFICIENT_SHIFT, 15, 30),
    (PLAIN, SLOT.SLOT_COEFFICIENT, -LARGE, LARGE),
    (PLAIN, SLOT.SLOT_COEFFICIENT + 2, -LARGE, LARGE),
    (PLAIN, SLOT.SLOT_RING, -1, 1),
    (PLAIN, SLOT.SLOT_DELAY, 0, 63),
    (PLAIN, SLOT.SLOT_RING_STEP, 1, 256),
    (TABLED, SLOT.SLOT_TABLE, -1, TABLES - 1),
    (TABLED, SLOT.SLOT_TABLE_SCALE + 1, 15, 30),
    (PLAYED, PLAY.PLAY_SOURCE, 0, INPUTS - 1),
    (PLAYED, PLAY.PLAY_RADIUS, 0, WIDE),
    (PLAYED, PLAY.PLAY_SHIFT, 15, 30),
    (PLAYED, PLAY.PLAY_COEFFICIENT, -LARGE, LARGE),
    (PLAYED, PLAY.PLAY_OF_SQUARE + 2, -LARGE, LARGE),
]


@pytest.fixture(scope="module")
def whole():
    """A model of one slot that follows a channel, one with a table, and a play operator."""
    data = bytearray(encoded(build_model(SLOTS, SCALES, binding=Binding(0x68, 0, 0, 3))))
    # a source that stands still fits any shift
    struct.pack_into("<4i", data, PLACES[PLAIN] + 4 * SLOT.SLOT_LOWEST_Q8, 0, 0, 0, 0)
    # and one of a tick may have any memory
    struct.pack_into("<i", data, BODY + INPUT_BYTES * CHANNEL, INPUT_KIND.KIND_CHANNEL)
    assert load(data) == LOADED
    return data


def load(data, *changes, sensor=None):
    """The verdict on a model with (form, place, values) changed and its checksum mended."""
    changed = bytearray(data)
    for form, place, *values in changes:
        struct.pack_into(form, changed, place, *values)
    struct.pack_into("<I", changed, len(changed) - 4, zlib.crc32(changed[:-4]))
    return EffectModel().load(bytes(changed), sensor or Sensor())


@pytest.mark.parametrize(("slot", "word", "least", "most"), WORDS)
def test_a_word_of_a_slot_or_play_operator_has_ends(whole, slot, word, least, most):
    place = PLACES[slot] + 4 * word
    verdicts = [load(whole, ("<i", place, v)) for v in (least - 1, least, most, most + 1)]
    assert verdicts == [IMPOSSIBLE, LOADED, LOADED, IMPOSSIBLE]


@pytest.mark.parametrize(("index", "word", "least", "most"), [
    (TEMPERATURE, 0, 0, 9), (TEMPERATURE, 1, 0, 15), (CHANNEL, 0, 16, 31), (CHANNEL, 1, -8, 15)
])  # fmt: skip
def test_kind_and_shift_of_an_input_have_ends(whole, index, word, least, most):
    place = BODY + INPUT_BYTES * index + 4 * word
    verdicts = [load(whole, ("<i", place, v)) for v in (least - 1, least, most, most + 1)]
    assert verdicts == [IMPOSSIBLE, LOADED, LOADED, IMPOSSIBLE]


def test_the_tick_has_ends(whole):
    verdicts = [load(whole, ("<I", 16, v)) for v in (9999, 10000, (1 << 29) - 1, 1 << 29)]
    assert verdicts == [IMPOSSIBLE, LOADED, LOADED, IMPOSSIBLE]


@pytest.mark.parametrize(("place", "most"), [(6, 8), (7, 12), (8, 2), (9, 8), (10, 6)])
def test_a_model_with_more_than_fits_is_too_large(whole, place, most):
    assert load(whole, ("<B", place, most)) != TOO_LARGE
    assert load(whole, ("<B", place, most + 1)) == TOO_LARGE


@pytest.mark.parametrize("slot", [PLAIN, PLAYED])
@pytest.mark.parametrize("shift", [-8, 0, 1])
def test_a_source_stays_within_q24_of_its_centre(whole, slot, shift):
    most = min((1 << 29) - 1, (1 << 24) >> shift if shift >= 0 else 1 << 32)
    first = PLACES[slot] + 4 * SLOT.SLOT_LOWEST_Q8

    def with_range(low, high, centre):
        return load(whole, ("<4i", first, low, high, centre, shift))

    assert with_range(-most, most, 0) == with_range(0, most, most) == LOADED
    assert with_range(1, 0, 0) == IMPOSSIBLE
    assert with_range(0, most + 1, 0) == with_range(-most - 1, 0, 0) == IMPOSSIBLE
    if shift >= 0:
        assert with_range(-1, 0, most) == with_range(0, 1, -most) == IMPOSSIBLE


@pytest.mark.parametrize("kind", [10, 12, 13, 15, 24])
@pytest.mark.parametrize("word", [SLOT.SLOT_MEMORY, SLOT.SLOT_DECAY, SLOT.SLOT_RING])
def test_what_follows_the_sample_itself_has_no_memory(whole, kind, word):
    of_the_sample = "<ii", BODY + INPUT_BYTES * CHANNEL, kind, 0
    none = -1 if word == SLOT.SLOT_RING else 0
    place = PLACES[PLAIN] + 4 * word
    assert load(whole, of_the_sample, ("<i", place, none)) == LOADED
    assert load(whole, of_the_sample, ("<i", place, none + 1)) == IMPOSSIBLE


def test_a_play_operator_follows_no_sample_itself(whole):
    assert load(whole, ("<i", BODY + INPUT_BYTES * TEMPERATURE, 10)) == IMPOSSIBLE


def test_a_model_cut_in_its_texts_is_impossible(whole):
    assert load(whole, ("<B", 9, 8)) == IMPOSSIBLE


@pytest.mark.parametrize(("off_degc", "verdict"), [(0.009, LOADED), (0.011, OTHER_SCALE)])
def test_the_temperature_s_offset_is_the_same_to_a_hundredth(whole, off_degc, verdict):
    for sign in (1, -1):
        sensor = Sensor(temp_offset_degc=36.53 + sign * off_degc)
        assert load(whole, sensor=sensor) == verdict


@pytest.mark.parametrize("field", ["gyro_lsb_per_dps", "accel_lsb_per_g", "temp_lsb_per_degc"])
def test_scales_are_the_same_to_a_ten_thousandth(whole, field):
    scale = getattr(Sensor(), field)
    verdicts = [load(whole, sensor=Sensor(**{field: scale * (1 + x)})) == LOADED
                for x in (-2e-4, -0.5e-4, 0.5e-4, 2e-4)]  # fmt: skip
    assert verdicts == [False, True, True, False]


@pytest.mark.parametrize(
    ("value", "fits"),
    [
        *((sign * ((1 << 29) - 1), True) for sign in (1, -1)),
        *((sign * (1 << 29), False) for sign in (1, -1)),
        *((MARKS.NO_VALUE, True), (MARKS.NO_VALUE - 1, False), (-1 << 31, False)),
    ],
)
def test_a_number_of_a_file_that_kernels_cannot_hold_is_not_put(value, fits):
    e = array("i", [0] * 4)
    assert model_file.put(e, 1, 2, struct.pack("<3i", 9, 5, value), 4) is fits
    assert list(e) == [0, 5, value if fits else 0, 0]
