"""When what was learned is saved: once it changed, at rest, and seldom enough for the memory."""

from time import monotonic_ns

import pytest
from zerorate import Corrector, Sensor
from zerorate.storage import save_schedule
from zerorate.storage.save_schedule import SaveSchedule
from zerorate_tools import layout

from .test_store import OLD, make_store


class TestSavingAtRest:
    @pytest.fixture
    def corrector(self):
        return Corrector(Sensor(odr_hz=100.0))

    @pytest.fixture
    def schedule(self, memory, corrector):
        return SaveSchedule(make_store(memory), 3, tolerance=10, corrector=corrector)

    def test_a_save_waits_for_a_rest(self, schedule, corrector):
        assert not schedule.offer(OLD, [0, -10, 0], 0)
        corrector.state[layout.STATE.STILLNESS] = layout.STILLNESS.STILL
        assert schedule.offer(OLD, [0, -10, 0], 1)
        assert schedule.postponed == 1

    def test_but_no_longer_than_a_write_s_share_of_a_day(self, schedule):
        assert not schedule.offer(OLD, [0, -10, 0], 10)
        assert not schedule.offer(OLD, [0, -10, 0], 3609)
        assert schedule.offer(OLD, [0, -10, 0], 3610)

    def test_and_waits_anew_after_a_save(self, schedule):
        schedule.offer(OLD, [0, -10, 0], 10)
        assert schedule.offer(OLD, [0, -10, 0], 3610)
        assert not schedule.offer(OLD, [0, -20, 0], 7300)
        assert not schedule.offer(OLD, [0, -20, 0], 10899)
        assert schedule.offer(OLD, [0, -20, 0], 10900)

    def test_the_longest_save_is_kept(self, schedule, corrector, monkeypatch):
        corrector.state[layout.STATE.STILLNESS] = layout.STILLNESS.STILL
        times_us = iter([0, 500, 1000, 1900, 3000, 3100])
        monkeypatch.setattr(save_schedule, "ticks_us", lambda: next(times_us))
        for number in range(1, 4):
            assert schedule.offer(OLD, [0, -10 * number, 0], 3600 * number)
        assert (schedule.longest_us, schedule.saves) == (900, 3)

    def test_what_saving_costs_is_told(self, schedule, corrector):
        assert "Nothing was saved yet" in corrector.explain()
        corrector.state[layout.STATE.STILLNESS] = layout.STILLNESS.STILL
        schedule.offer(OLD, [0, -10, 0], 0)
        schedule.longest_us = 97_400
        told = "Saved 1 times, for 97 ms at the longest: 10 samples pass, which a FIFO keeps"
        assert told in corrector.explain()


class TestSchedule:
    @pytest.fixture
    def schedule(self, memory):
        return SaveSchedule(make_store(memory), 3, tolerance=10, writes_a_day=24)

    def test_what_changed_little_is_not_written(self, schedule):
        assert not schedule.offer(OLD, [9, -9, 0], 0)

    def test_what_changed_by_the_tolerance_is(self, schedule):
        assert schedule.offer(OLD, [0, -10, 0], 0)

    def test_what_was_loaded_needs_no_writing(self, schedule):
        schedule.loaded([1000, 2000, 3000])
        assert not schedule.offer(OLD, [1001, 2001, 2999], 5)

    def test_a_day_of_wild_changes_stays_within_the_budget(self, schedule, memory):
        for second in range(0, 86400, 7):
            schedule.offer(OLD, [second * 50, 0, 0], second)
        assert schedule.store.saves == 24
        assert memory.written == 24 * schedule.store.slot_bytes
        assert schedule.postponed > 0

    def test_a_failed_write_also_counts_against_the_budget(self, schedule, memory):
        memory.broken = True
        assert [schedule.offer(OLD, [100, 0, 0], second) for second in range(100)] == [False] * 100
        assert schedule.store.failures == 1


def test_on_a_host_ticks_are_microseconds_too():
    before = monotonic_ns()
    assert before // 1000 <= save_schedule.ticks_us() <= monotonic_ns() // 1000
    assert save_schedule.ticks_diff(7, 9) == -2
