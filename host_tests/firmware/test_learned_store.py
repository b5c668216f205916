"""State and effect model of a device come back after a power cut, or a reason does."""

import sys
from array import array
from binascii import crc32
from time import monotonic_ns

import pytest
from zerorate import Corrector, Sensor
from zerorate.model import EffectModel
from zerorate.storage import codes, reasons, save_schedule
from zerorate.storage.learned_store import MODEL_BYTES, LearnedStore
from zerorate.storage.save_schedule import SaveSchedule
from zerorate_fakes.memory import FakeMemory, PowerCut
from zerorate_tools import layout
from zerorate_tools.model import Slot, build_model, encoded
from zerorate_tools.model.term import Term
from zerorate_tools.recordings import Scales

from .played import play, rest
from .test_store import OLD, make_store

BINDING = bytes([0x68, 0, 0, 3])
MODEL = b"ZRM\x01\x40\x00" + bytes(range(58))  # the header's size field says 64


@pytest.fixture(scope="module")
def learned_words():
    """The state of a corrector that has rested for a minute."""
    return play(rest(60, 4, (0.9, 0.9, 0.9), temp=-3000))[0].state


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
    assert (stores.load(), stores.load_model()) == (codes.EMPTY, b"")
    assert stores.corrector.state == before


def test_what_was_learned_is_what_a_new_power_on_begins_with(memory, saved):
    stores = blank(memory)
    assert stores.load() == codes.LOADED
    saved.power_on()
    assert stores.corrector.state == saved.state


@pytest.mark.parametrize("same", [False, True])
def test_a_program_that_began_anew_on_a_chip_that_kept_its_power_keeps_its_offsets(
    memory, saved, same
):
    stores = blank(memory)
    assert stores.load(same) == codes.LOADED
    saved.power_on(same)
    assert stores.corrector.state == saved.state


def test_a_storage_that_fails_is_said(memory, saved):
    memory.broken = True
    stores = LearnedStore(memory, BINDING, saved)
    assert (stores.save(), stores.save_model(MODEL)) == (False, False)
    assert (stores.load(), stores.load_model()) == (codes.UNREADABLE, b"")


def test_state_is_bound_to_every_word_of_the_settings(memory, saved):
    settings = saved.settings
    assert LearnedStore(memory, BINDING, saved).state.binding == BINDING + crc32(settings).to_bytes(
        4, "little"
    )
    for word in (0, len(settings) - 1):
        settings[word] ^= 1
        assert LearnedStore(memory, BINDING, saved).load() == codes.OTHER_BINDING
        settings[word] ^= 1
    assert LearnedStore(memory, BINDING, saved).load() == codes.LOADED


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


def with_model(memory, constant_dps, span_degc=4.0, **options):
    """A store of a device whose model adds a constant over that range of temperature."""
    stores = blank(memory, **options)
    effects, sensor = EffectModel(), stores.corrector.sensor
    term = Term("temp", 25.0 - span_degc / 2, 25.0 + span_degc / 2, 25.0)
    slot = Slot(term, (constant_dps,) * 3, "temperature-quadratic")
    scales = Scales("MPU-6050", 100.0, 131.0, 16384.0, 340.0, 36.53)
    assert effects.load(encoded(build_model([slot], scales)), sensor) == codes.LOADED
    stores.corrector.use_model(effects)
    return stores


def test_what_was_learned_beside_a_model_is_loaded_beside_that_model_alone(memory, saved):
    stores = with_model(memory, 0.01)
    assert stores.load() == codes.OTHER_BINDING
    assert "another effect model" in stores.in_words(codes.OTHER_BINDING)
    stores.corrector.state[:] = saved.state
    assert stores.save()
    assert with_model(memory, 0.01).load() == codes.LOADED
    assert blank(memory).load() == codes.LOADED  # the older slot
    assert stores.save()
    for other in (with_model(memory, 0.02), with_model(memory, 0.01, 40.0), blank(memory)):
        assert other.load() == codes.OTHER_BINDING
        assert "another effect model" in other.in_words(codes.OTHER_BINDING)


def test_a_model_may_come_before_the_store_or_after_it(memory):
    after = with_model(memory, 0.01, 40.0)
    assert after.save()
    corrector = with_model(FakeMemory(16384), 0.01, 40.0).corrector
    assert LearnedStore(memory, BINDING, corrector).load() == codes.LOADED


def test_without_the_part_that_names_it_a_refusal_says_the_reason_alone(memory, saved, monkeypatch):
    monkeypatch.setitem(sys.modules, "zerorate.storage.differing", None)
    stores = LearnedStore(memory, bytes([0x70, 0, 0, 3]), Corrector(Sensor(odr_hz=100.0)))
    assert stores.in_words(stores.load()) == reasons.REASONS[codes.OTHER_BINDING]


@pytest.mark.parametrize("options", [{"document": True}, {"every": True}, {"short": 2}])
def test_state_of_other_estimators_is_refused(memory, saved, options):
    assert blank(memory, **options).load() not in (codes.LOADED, codes.EMPTY)


@pytest.mark.parametrize("size", [64, 255, 256, 0x150, MODEL_BYTES - 1, MODEL_BYTES])
def test_a_model_comes_back_to_the_byte(memory, saved, size):
    model = MODEL[:4] + size.to_bytes(2, "little") + bytes(i % 253 for i in range(size - 6))
    assert blank(memory).save_model(model)
    assert blank(memory).load_model() == model


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
    assert again.load() == codes.LOADED
    assert again.load_model() == MODEL


class TestSavingAtRest:
    @pytest.fixture
    def corrector(self):
        return Corrector(Sensor(odr_hz=100.0))

    @pytest.fixture
    def schedule(self, memory, corrector):
        return SaveSchedule(make_store(memory), 3, tolerance=10, corrector=corrector)

    @pytest.mark.parametrize(
        ("rest_s", "offers"),
        [
            (1, {0: False, 1: True}),
            # but no longer than a write's share of a day; and anew after a save
            (99999, {10: False, 3609: False, 3610: True, 7300: False, 10899: False, 10900: True}),
        ],
    )
    def test_a_save_waits_for_a_rest(self, schedule, corrector, rest_s, offers):
        for now_s, written in offers.items():
            if now_s >= rest_s:
                corrector.state[layout.STATE.STILLNESS] = layout.STILLNESS.STILL
            moved = -10 * (1 + schedule.saves)
            assert schedule.offer(OLD, [0, moved, 0], now_s) is written
        assert schedule.postponed == list(offers.values()).count(False)

    def test_the_longest_save_is_kept(self, schedule, corrector, monkeypatch):
        corrector.state[layout.STATE.STILLNESS] = layout.STILLNESS.STILL
        times_us = iter([0, 500, 1000, 1900, 3000, 3100])
        monkeypatch.setattr(save_schedule, "ticks_us", lambda: next(times_us))
        for number in range(1, 4):
            assert schedule.offer(OLD, [0, -10 * number, 0], 3600 * number)
        assert (schedule.longest_us, schedule.saves) == (900, 3)


class TestSchedule:
    @pytest.fixture
    def schedule(self, memory):
        return SaveSchedule(make_store(memory), 3, tolerance=10, writes_a_day=24)

    def test_only_what_changed_by_the_tolerance_since_it_was_loaded_is_written(self, schedule):
        schedule.loaded([1000, 2000, 3000])
        assert not schedule.offer(OLD, [1009, 1991, 3000], 5)
        assert schedule.offer(OLD, [1000, 1990, 3000], 6)

    def test_what_a_power_on_began_with_is_not_written_again(self):
        store = LearnedStore(FakeMemory(20_000), BINDING, Corrector())
        assert store.save() and store.load() == codes.LOADED
        schedule = SaveSchedule(store, 3, tolerance=10)
        offered = [schedule.offer(store.corrector.state, [x, 0, 0], 0) for x in (9, 100, 109, 110)]
        assert offered == [False, False, False, True]

    def test_a_day_of_wild_changes_stays_within_the_budget(self, schedule, memory):
        def offered(second):
            return schedule.offer(OLD, [1000 + second * 50, 0, 0], second)

        written_s = list(filter(offered, range(0, 86400, 5)))
        assert written_s == [0, 225, 675, 1575, *range(3375, 86400, 3600)]  # 24 and four
        assert memory.written == 28 * schedule.store.slot_bytes
        assert schedule.postponed > 0

    def test_a_failed_write_also_counts_against_the_budget(self, schedule, memory):
        memory.broken = True
        assert [schedule.offer(OLD, [100, 0, 0], second) for second in range(100)] == [False] * 100
        assert schedule.store.failures == 1


@pytest.mark.parametrize("writes_a_day", [1, 2, 86400])
def test_a_days_budget_is_spread_over_the_day(memory, writes_a_day):
    schedule = SaveSchedule(make_store(memory), 3, tolerance=10, writes_a_day=writes_a_day)
    schedule.written_at(-5)
    share_s = 86400 // writes_a_day
    assert [schedule.is_due(share_s - 5 + by) for by in (-1, 0)] == [False, True]


@pytest.mark.parametrize("writes_a_day", [0, -1])
def test_a_budget_below_one_write_a_day_is_refused(memory, writes_a_day):
    with pytest.raises(ValueError, match="at least 1"):
        SaveSchedule(make_store(memory), 3, tolerance=10, writes_a_day=writes_a_day)


def test_on_a_host_ticks_are_microseconds_too():
    before = monotonic_ns()
    assert before // 1000 <= save_schedule.ticks_us() <= monotonic_ns() // 1000
    assert save_schedule.ticks_diff(7, 9) == -2
