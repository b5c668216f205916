"""State and effect model of a device come back after a power cut, or a reason does."""

import random
import sys
from array import array
from binascii import crc32

import pytest
from zerorate import Corrector, Sensor
from zerorate.storage import store
from zerorate.storage.learned_store import MODEL_BYTES, LearnedStore
from zerorate_fakes.memory import FakeMemory, PowerCut

BINDING = bytes([0x68, 0, 0, 3])
MODEL = b"ZRM\x01\x40\x00" + bytes(range(58))  # the header's size field says 64


@pytest.fixture(scope="module")
def learned_words():
    """The state of a corrector that has rested for a minute."""
    corrector = Corrector(Sensor(odr_hz=100.0))
    noise = random.Random(4).gauss
    for _ in range(6000):
        accel = [round(noise(mean, 40)) for mean in (0, 0, 16384)]
        gyro = [round(noise(120, 6.5)) for _ in range(3)]
        corrector.update(array("i", [*accel, round(noise(-3000, 8)), *gyro]), 10000)
    return corrector.state


@pytest.fixture
def memory():
    return FakeMemory(16384)


def blank(memory, binding=BINDING, **options):
    return LearnedStore(memory, binding, Corrector(Sensor(odr_hz=100.0), **options))


@pytest.fixture
def saved(memory, learned_words):
    corrector = Corrector(Sensor(odr_hz=100.0))
    corrector.state[:] = learned_words
    assert LearnedStore(memory, BINDING, corrector).save()
    return corrector


def test_a_new_device_says_that_nothing_was_stored(memory):
    stores = blank(memory)
    before = array("i", stores.corrector.state)
    assert stores.load() == store.EMPTY
    assert stores.corrector.state == before


def test_what_was_learned_is_what_a_new_power_on_begins_with(memory, saved):
    stores = blank(memory)
    assert stores.load() == store.LOADED
    saved.power_on()
    assert stores.corrector.state == saved.state


@pytest.mark.parametrize("same", [False, True])
def test_a_program_that_began_anew_on_a_chip_that_kept_its_power_keeps_its_offsets(
    memory, saved, same
):
    stores = blank(memory)
    assert stores.load(same) == store.LOADED
    saved.power_on(same)
    assert stores.corrector.state == saved.state


def test_a_storage_that_fails_is_said(memory, saved):
    memory.broken = True
    stores = LearnedStore(memory, BINDING, saved)
    assert (stores.save(), stores.save_model(MODEL)) == (False, False)
    assert (stores.load(), stores.load_model()) == (store.UNREADABLE, b"")


def test_state_is_bound_to_every_word_of_the_settings(memory, saved):
    settings = saved.settings
    assert LearnedStore(memory, BINDING, saved).state.binding == BINDING + crc32(settings).to_bytes(
        4, "little"
    )
    for word in (0, len(settings) - 1):
        settings[word] ^= 1
        assert LearnedStore(memory, BINDING, saved).load() == store.OTHER_BINDING
        settings[word] ^= 1
    assert LearnedStore(memory, BINDING, saved).load() == store.LOADED


@pytest.mark.parametrize(("base", "pitch"), [(0, 0), (100, 0), (0, 4096), (4096, 4096)])
def test_state_and_model_have_two_slots_each_one_after_the_other(saved, base, pitch):
    memory = FakeMemory(24576)
    stores = LearnedStore(memory, BINDING, saved, base, pitch)
    for _ in range(2):
        assert stores.save() and stores.save_model(MODEL)
    words = len(saved.state) + len(saved.settings)
    of_state, of_model = pitch or 4 * words + 24, pitch or MODEL_BYTES + 24
    begins = [base, base + of_state, base + 2 * of_state, base + 2 * of_state + of_model]
    assert [at for at in range(len(memory.bytes)) if memory.bytes[at : at + 3] == b"ZRS"] == begins
    assert stores.end == begins[-1] + of_model
    assert set(memory.bytes[stores.end :]) == {0xFF}
    assert [memory.bytes[at + 4] for at in begins] == [2, 2, 1, 1]  # versions


@pytest.mark.parametrize("options", [{"binding": bytes([0x70, 0, 0, 3])}, {"still_dps": 0.2}])
def test_state_of_another_chip_or_other_settings_is_refused(memory, saved, options):
    assert blank(memory, **options).load() == store.OTHER_BINDING


@pytest.mark.parametrize(
    ("binding", "sensor", "options", "named"),
    [
        ([0x70, 0, 0, 3], {}, {}, "another chip: code 0x68, not 0x70"),
        ([0x68, 1, 0, 3], {}, {}, "another gyroscope range: code 0x00, not 0x01"),
        ([0x68, 0, 2, 3], {}, {}, "another accelerometer range: code 0x00, not 0x02"),
        ([0x68, 0, 0, 4], {}, {}, "another filter: code 0x03, not 0x04"),
        (BINDING, {"odr_hz": 200.0}, {}, "stored with another odr_hz"),
        (BINDING, {"temp_lsb_per_degc": 333.87}, {}, "stored with another temp_lsb_per_degc"),
        (BINDING, {}, {"still_dps": 0.2}, "stored with another still_dps"),
        (BINDING, {}, {"promote_s": 6.0}, "stored with another promote_s"),
        (BINDING, {}, {"fit_s": 3, "gate_dps": 0.2}, "another fit_s and another gate_dps"),
    ],
)
def test_a_refusal_names_what_differs(memory, saved, binding, sensor, options, named):
    own = Corrector(Sensor(**{"odr_hz": 100.0, **sensor}), **options)
    stores = LearnedStore(memory, bytes(binding), own)
    assert named in stores.in_words(stores.load())


def test_without_the_part_that_names_it_a_refusal_says_the_reason_alone(memory, saved, monkeypatch):
    monkeypatch.setitem(sys.modules, "zerorate.storage.differing", None)
    stores = LearnedStore(memory, bytes([0x70, 0, 0, 3]), Corrector(Sensor(odr_hz=100.0)))
    assert stores.in_words(stores.load()) == store.REASONS[store.OTHER_BINDING]


@pytest.mark.parametrize("options", [{"document": True}, {"every": True}, {"short": 2}])
def test_state_of_other_estimators_is_refused(memory, saved, options):
    assert blank(memory, **options).load() not in (store.LOADED, store.EMPTY)


@pytest.mark.parametrize("size", [64, 255, 256, 0x150, MODEL_BYTES - 1, MODEL_BYTES])
def test_a_model_comes_back_to_the_byte(memory, saved, size):
    model = MODEL[:4] + size.to_bytes(2, "little") + bytes(i % 253 for i in range(size - 6))
    assert blank(memory).save_model(model)
    assert blank(memory).load_model() == model


def test_no_model_is_no_bytes(memory, saved):
    assert blank(memory).load_model() == b""


def test_a_model_that_does_not_fit_is_a_value_error(memory):
    with pytest.raises(ValueError, match="does not fit 2048"):
        blank(memory).save_model(bytes(MODEL_BYTES + 1))


@pytest.mark.parametrize("cut", [0, 1, 100, 1000])
def test_a_cut_in_the_writing_of_one_does_not_cost_the_other(memory, saved, cut):
    stores = LearnedStore(memory, BINDING, saved)
    assert stores.save_model(MODEL)
    for write in (stores.save, lambda: stores.save_model(MODEL[::-1])):
        memory.cut_after = cut
        with pytest.raises(PowerCut):
            write()
        memory.cut_after = None
    again = blank(memory)
    assert again.load() == store.LOADED
    assert again.load_model() == MODEL
