"""Data-ready pulses give each sample its time and count those that nobody took."""

import pytest
from zerorate_fakes.pins import InterruptPin
from zerorate_i2c.data_ready import DataReady
from zerorate_i2c.mpu6050 import FRESH, RESTARTED, VERIFIED


@pytest.fixture
def bench(make_bench):
    return make_bench(linked=True)


@pytest.fixture
def ready(bench):
    return DataReady(bench.imu, InterruptPin(bench.chip))


def test_without_a_pulse_there_is_nothing_to_take(ready):
    assert not ready.take()


def test_a_pulse_is_taken_once(bench, ready):
    bench.clock.advance_us(10000)
    assert ready.take()
    assert not ready.take()


def test_the_time_between_samples_is_that_of_the_pulses(bench, ready):
    for late_us in (0, 3000, 6000):
        bench.clock.advance_us(10000 + late_us)
        ready.take()
        bench.clock.advance_us(10000 - late_us)
        ready.take()
        assert ready.dt_us == pytest.approx(10000, abs=6001)


def test_samples_nobody_took_are_counted_and_their_time_kept(bench, ready):
    bench.clock.advance_us(10000)
    ready.take()
    bench.clock.advance_us(50000)
    ready.take()
    assert ready.missed == 4
    assert ready.dt_us == 50000


def test_a_pulse_between_the_two_readings_of_the_handler_s_words_is_not_taken_twice(bench):
    class Interrupted(DataReady):
        """Its time is read while the next pulse comes."""

        late_us = 0

        @property
        def _edge_us(self):
            if self.late_us:
                by_us, self.late_us = self.late_us, 0
                bench.clock.advance_us(by_us)
            return self.kept_us

        @_edge_us.setter
        def _edge_us(self, now_us):
            self.kept_us = now_us

    ready = Interrupted(bench.imu, InterruptPin(bench.chip))
    bench.clock.advance_us(10000)
    ready.late_us = 10000
    assert ready.take()
    assert ready.dt_us == 20000
    assert not ready.take()


def test_waiting_ends_with_the_next_sample(bench, ready):
    assert ready.wait(20)
    assert bench.chip.samples_made > 0


def test_waiting_for_a_sleeping_chip_ends(bench, ready):
    bench.chip.power_up()
    before_us = bench.clock.now_us
    assert not ready.wait(50)
    assert bench.clock.now_us - before_us == 50000


def test_samples_that_pass_without_interrupts_are_counted_by_their_time(bench, ready):
    bench.clock.advance_us(10000)
    ready.take()
    handler, bench.chip.interrupt = bench.chip.interrupt, lambda: None
    bench.clock.advance_us(90000)  # as while flash is written
    bench.chip.interrupt = handler
    bench.clock.advance_us(10000)
    assert ready.take()
    assert ready.missed == 9
    assert ready.dt_us == 100000


def test_a_chip_that_lost_its_power_is_set_up_again_by_the_next_read(bench, ready):
    for _ in range(3):
        assert ready.wait(20) and bench.imu.read(bench.sample) in (FRESH, VERIFIED)
    bench.chip.power_up()
    assert not ready.wait(1000)
    assert ready.dt_us == 0
    assert bench.imu.read(bench.sample) == RESTARTED
    assert ready.wait(50) and bench.imu.read(bench.sample) == FRESH


def test_the_interrupt_survives_a_restart(bench, ready):
    bench.imu.restart()
    ready.take()
    assert ready.wait(20)
