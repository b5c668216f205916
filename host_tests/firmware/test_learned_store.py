"""State and effect model of a device come back after a power cut, or a reason does."""

import random
from array import array

import pytest
from zerorate import Corrector, Sensor
from zerorate.storage import store
from zerorate.storage.learned_store import MODEL_BYTES, LearnedStore
from zerorate_fakes.memory import FakeMemory, PowerCut

BINDING = bytes([0x68, 0, 0, 3])
MODEL = b"ZRM\x01\x40\x00" + bytes(range(58))  # the header's size field says 64


def learned(bias_lsb=120, **options):
    """A corrector that has rested for a minute."""
    corrector = Corrector(Sensor(odr_hz=100.0), **options)
    noise = random.Random(4).gauss
    for _ in range(6000):
        accel = [round(noise(mean, 40)) for mean in (0, 0, 16384)]
        gyro = [round(noise(bias_lsb, 6.5)) for _ in range(3)]
        corrector.update(array("i", [*accel, round(noise(-3000, 8)), *gyro]), 10000)
    return corrector


@pytest.fixture
def memory():
    return FakeMemory(16384)


def blank(memory, binding=BINDING, **options):
    return LearnedStore(memory, binding, Corrector(Sensor(odr_hz=100.0), **options))


@pytest.fixture
def saved(memory):
    corrector = learned()
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


def test_state_of_other_settings_is_refused(memory, saved):
    assert blank(memory, still_dps=0.2).load() == store.OTHER_BINDING


@pytest.mark.parametrize("options", [{"document": True}, {"every": True}, {"short": 2}])
def test_state_of_other_estimators_is_refused(memory, saved, options):
    assert blank(memory, **options).load() not in (store.LOADED, store.EMPTY)


def test_state_of_another_chip_is_refused(memory, saved):
    assert blank(memory, bytes([0x70, 0, 0, 3])).load() == store.OTHER_BINDING


def test_a_model_comes_back_to_the_byte(memory, saved):
    assert blank(memory).save_model(MODEL)
    assert blank(memory).load_model() == MODEL


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


def test_both_stay_before_the_end(memory, saved):
    stores = LearnedStore(memory, BINDING, saved)
    for _ in range(3):
        assert stores.save() and stores.save_model(MODEL)
    assert set(memory.bytes[stores.end :]) == {0xFF}
    assert stores.end < 11000
