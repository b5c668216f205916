"""The firmware takes the model made for it to the ends of every range, and refuses any other."""

import struct
import zlib
from array import array
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from zerorate import Corrector, Sensor
from zerorate.effects import model_file
from zerorate.effects.model_file import IMPOSSIBLE, LOADED, OTHER_SCALE, TOO_LARGE
from zerorate.model import EffectModel
from zerorate_tools.errors import BadModel
from zerorate_tools.layout import EFFECTS, INPUT_KIND, MARKS, SLOT
from zerorate_tools.layout import PLAY as PLAY_WORDS
from zerorate_tools.model import Binding, Slot, build_model, decoded, encoded
from zerorate_tools.model.term import Term

from .test_model import BINDING, PLAY, SCALES, SLOTS, TABLE

DEVICE = bytes([0x68, 0, 0, 3])


@pytest.fixture
def model():
    return build_model(SLOTS, SCALES, binding=BINDING)


def load(data, sensor=None, binding=DEVICE):
    return EffectModel().load(data, sensor or Sensor(), binding)


def test_the_firmware_takes_what_was_made_for_it(model):
    held = EffectModel()
    assert held.load(encoded(model), Sensor(), DEVICE) == model_file.LOADED
    assert held.channels == ("load", "vdd_mv")
    assert held.e[EFFECTS.SLOT_COUNT] == len(SLOTS)
    assert not held.channel("humidity", 3)


@pytest.mark.parametrize(
    ("sensor", "binding", "reason"),
    [
        (Sensor(), bytes([0x70, 0, 0, 3]), model_file.OTHER_CHIP),
        (Sensor(), bytes([0x68, 1, 0, 3]), model_file.OTHER_RANGE),
        (Sensor(), bytes([0x68, 0, 2, 3]), model_file.OTHER_RANGE),
        (Sensor(), bytes([0x68, 0, 0, 4]), model_file.OTHER_FILTER),
        (Sensor(gyro_lsb_per_dps=65.5), None, model_file.OTHER_RANGE),
        (Sensor(accel_lsb_per_g=8192.0), None, model_file.OTHER_RANGE),
        (Sensor(temp_lsb_per_degc=333.87), None, model_file.OTHER_SCALE),
        (Sensor(temp_offset_degc=21.0), None, model_file.OTHER_SCALE),
    ],
)
def test_the_firmware_refuses_another_device_by_name(model, sensor, binding, reason):
    assert load(encoded(model), sensor, binding) == reason
    assert len(model_file.REASONS) == 12


def test_what_both_know_of_a_binding_is_compared(model):
    for binding in (b"", DEVICE[:1], DEVICE + b"\x99"):
        assert load(encoded(model), binding=binding) == model_file.LOADED
    unknown = encoded(build_model(SLOTS, SCALES))
    assert load(unknown, binding=bytes([0x99, 1, 2, 6])) == model_file.LOADED


def test_bytes_that_no_tool_would_write_are_refused(model):
    data = bytearray(encoded(model))[:-4]
    data[11] = 1
    with pytest.raises(BadModel, match="do not belong together"):
        decoded(bytes(data) + struct.pack("<I", zlib.crc32(data)))


def test_play_operators_stand_behind_the_slots_and_make_another_version():
    plays = [Slot(PLAY, (0.001, 0, 0.002), "a"), Slot(replace(PLAY, power=2), (0, 0, 1e-5), "a")]
    model = build_model([*plays, *SLOTS], SCALES, binding=BINDING)
    assert model.slots == (*SLOTS, *plays)
    data = encoded(model)
    assert (data[3], encoded(build_model(SLOTS, SCALES, binding=BINDING))[3]) == (2, 1)
    assert load(data) == model_file.LOADED


def test_every_cut_and_every_turned_bit_is_refused(model):
    data = encoded(model)
    cuts = {load(data[:n]) for n in range(len(data))}
    assert cuts == {model_file.NO_MODEL, model_file.TRUNCATED}
    for n in range(len(data)):
        said = f"is cut short at byte {n}; copy it again" if n > 2 else "is no effect model"
        with pytest.raises(BadModel, match=said):
            decoded(data[:n])
        if n > 5:  # one that says itself to be so short
            said = "is cut short" if n < 64 else "is damaged: its checksum differs; copy it again"
            with pytest.raises(BadModel, match=said):
                decoded(data[:4] + n.to_bytes(2, "little") + data[6:n])
    seen = set()
    for bit in range(8 * len(data)):
        turned = bytearray(data)
        turned[bit // 8] ^= 1 << bit % 8
        seen.add(load(turned))
        if bit % 7 == 0:
            with pytest.raises(BadModel):
                decoded(bytes(turned))
    refused = {model_file.NO_MODEL, model_file.OTHER_VERSION, model_file.TRUNCATED}
    assert seen == refused | {model_file.DAMAGED}


@pytest.mark.parametrize("more", [b"\0", b"\0" * 40])
def test_a_model_longer_than_it_says_is_damaged_whatever_its_checksum(model, more):
    longer = encoded(model)[:-4] + more
    assert load(longer + zlib.crc32(longer).to_bytes(4, "little")) == model_file.DAMAGED


@given(noise=st.binary(max_size=300), at=st.integers(0, 1200))
@settings(max_examples=25, deadline=None)
def test_bytes_of_any_kind_with_a_right_checksum_never_raise(noise, at):
    data = bytearray(encoded(build_model(SLOTS, SCALES)))[:-4]
    data[at : at + len(noise)] = noise
    data[4:6] = struct.pack("<H", len(data) + 4)
    whole = bytes(data) + struct.pack("<I", zlib.crc32(data))
    assert 0 <= load(whole, binding=None) < len(model_file.REASONS)
    try:
        assert encoded(decoded(whole)) == whole
    except BadModel:
        pass


def test_a_refused_model_or_one_that_is_not_there_leaves_none(model, tmp_path):
    held = EffectModel()
    for end in (
        lambda: held.load_file(str(tmp_path / "none.bin"), Sensor()) == model_file.UNREADABLE,
        lambda: held.load(encoded(model), Sensor(), bytes([1, 0, 0, 3])) == model_file.OTHER_CHIP,
    ):
        held.load(encoded(model), Sensor())
        assert end() and held.e[EFFECTS.SLOT_COUNT] == 0


def test_a_device_whose_model_is_not_loaded_yet_or_no_longer_goes_on_without_effects(model):
    held, device, plain = EffectModel(), Corrector(), Corrector()
    device.use_model(held)

    def live():
        for _ in range(300):
            frames = [array("i", [0, 0, 16384, 0, 40, -20, 10]) for _ in range(2)]
            device.update(frames[0], 10_000)
            plain.update(frames[1], 10_000)
        return frames[0] == frames[1]

    assert live()
    held.load(encoded(model), device.sensor, DEVICE)
    assert not live()
    held.forget()
    assert live()


TABLED, PLAIN, PLAYED = 0, 1, 2
LIMITED = [
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
    (PLAYED, PLAY_WORDS.PLAY_SOURCE, 0, INPUTS - 1),
    (PLAYED, PLAY_WORDS.PLAY_RADIUS, 0, WIDE),
    (PLAYED, PLAY_WORDS.PLAY_SHIFT, 15, 30),
    (PLAYED, PLAY_WORDS.PLAY_COEFFICIENT, -LARGE, LARGE),
    (PLAYED, PLAY_WORDS.PLAY_OF_SQUARE + 2, -LARGE, LARGE),
]
# (input, word, least, most) of kind and shift
OF_INPUTS = [(TEMPERATURE, 0, 0, 9), (TEMPERATURE, 1, 0, 15), (CHANNEL, 0, 16, 31)]
OF_INPUTS.append((CHANNEL, 1, -8, 15))


@pytest.fixture(scope="module")
def whole():
    """A model of one slot that follows a channel, one with a table, and a play operator."""
    data = bytearray(encoded(build_model(LIMITED, SCALES, binding=Binding(0x68, 0, 0, 3))))
    # a source that stands still fits any shift
    struct.pack_into("<4i", data, PLACES[PLAIN] + 4 * SLOT.SLOT_LOWEST_Q8, 0, 0, 0, 0)
    # and one of a tick may have any memory
    struct.pack_into("<i", data, BODY + INPUT_BYTES * CHANNEL, INPUT_KIND.KIND_CHANNEL)
    assert loaded_with(data) == LOADED
    return data


def loaded_with(data, *changes, sensor=None):
    """The verdict on a model with (form, place, values) changed and its checksum mended."""
    changed = bytearray(data)
    for form, place, *values in changes:
        struct.pack_into(form, changed, place, *values)
    struct.pack_into("<I", changed, len(changed) - 4, zlib.crc32(changed[:-4]))
    return EffectModel().load(bytes(changed), sensor or Sensor())


@pytest.mark.parametrize(
    ("form", "place", "least", "most"),
    [
        *(("<i", PLACES[slot] + 4 * word, *ends) for slot, word, *ends in WORDS),
        *(("<i", BODY + INPUT_BYTES * at + 4 * word, *ends) for at, word, *ends in OF_INPUTS),
        ("<I", 16, 10_000, (1 << 29) - 1),  # the tick
    ],
)
def test_a_word_of_a_slot_a_play_operator_or_an_input_has_ends(whole, form, place, least, most):
    verdicts = [loaded_with(whole, (form, place, v)) for v in (least - 1, least, most, most + 1)]
    assert verdicts == [IMPOSSIBLE, LOADED, LOADED, IMPOSSIBLE]


@pytest.mark.parametrize(("place", "most"), [(6, 8), (7, 12), (8, 2), (9, 8), (10, 6)])
def test_a_model_with_more_than_fits_is_too_large(whole, place, most):
    assert loaded_with(whole, ("<B", place, most)) != TOO_LARGE
    assert loaded_with(whole, ("<B", place, most + 1)) == TOO_LARGE


@pytest.mark.parametrize("slot", [PLAIN, PLAYED])
@pytest.mark.parametrize("shift", [-8, 0, 1])
def test_a_source_stays_within_q24_of_its_centre(whole, slot, shift):
    most = min((1 << 29) - 1, (1 << 24) >> shift if shift >= 0 else 1 << 32)
    first = PLACES[slot] + 4 * SLOT.SLOT_LOWEST_Q8

    def with_range(low, high, centre):
        return loaded_with(whole, ("<4i", first, low, high, centre, shift))

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
    assert loaded_with(whole, of_the_sample, ("<i", place, none)) == LOADED
    assert loaded_with(whole, of_the_sample, ("<i", place, none + 1)) == IMPOSSIBLE


def test_a_play_operator_follows_no_sample_itself(whole):
    assert loaded_with(whole, ("<i", BODY + INPUT_BYTES * TEMPERATURE, 10)) == IMPOSSIBLE


def test_a_model_cut_in_its_texts_is_impossible(whole):
    assert loaded_with(whole, ("<B", 9, 8)) == IMPOSSIBLE


@pytest.mark.parametrize(("off_degc", "verdict"), [(0.009, LOADED), (0.011, OTHER_SCALE)])
def test_the_temperature_s_offset_is_the_same_to_a_hundredth(whole, off_degc, verdict):
    for sign in (1, -1):
        sensor = Sensor(temp_offset_degc=36.53 + sign * off_degc)
        assert loaded_with(whole, sensor=sensor) == verdict


@pytest.mark.parametrize("field", ["gyro_lsb_per_dps", "accel_lsb_per_g", "temp_lsb_per_degc"])
def test_scales_are_the_same_to_a_ten_thousandth(whole, field):
    scale = getattr(Sensor(), field)
    verdicts = [loaded_with(whole, sensor=Sensor(**{field: scale * (1 + x)})) == LOADED
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


@pytest.mark.parametrize(
    ("changes", "coefficients", "degc"),
    [
        ({}, (0.1, 0.1, 0.1), 25),
        ({}, (0.1, 0.0, 0.1), 0),
        ({"knot": 0.0}, (0.1, 0.1, 0.1), 0),
        ({"power": 2}, (0.1, 0.1, 0.1), 0),
        ({"table": TABLE}, (0.1, 0.1, 0.1), 0),
        ({"memory": "peak"}, (0.1, 0.1, 0.1), 0),
    ],
)
def test_a_plain_line_over_temperature_on_every_axis_has_a_range_and_nothing_else(
    changes, coefficients, degc
):
    effects = EffectModel()
    line = Slot(Term("temp", 20, 45, 30, **changes), coefficients)
    assert effects.load(encoded(build_model([line], SCALES)), Sensor()) == LOADED
    assert effects.e[EFFECTS.CURVE_LSB] == pytest.approx(340 * degc, abs=2)
