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


class TestEdges:
    """The handler called by hand, at the times chosen."""

    @pytest.fixture
    def edge(self, make_bench):
        bench = make_bench()
        pin = InterruptPin(bench.chip)
        bench.clock.now_us = 0
        ready = DataReady(bench.imu, pin)

        def edge(*times_us):
            for at_us in times_us:
                bench.clock.now_us = at_us
                pin._handler(pin)
            return ready

        edge.bench = bench
        return edge

    def test_the_chip_is_told_to_pulse_and_any_read_to_clear(self, edge):
        registers = edge.bench.chip.registers
        assert (registers[0x37], registers[0x38]) == (0x10, 0x01)

    @pytest.mark.parametrize(
        "times_us, dt_us, missed",
        [
            ([10000], 10000, 0),
            ([14999], 14999, 0),
            ([15000], 15000, 1),
            ([24999], 24999, 1),
            ([25000], 25000, 2),
            ([5000, 10000], 10000, 1),
            ([1000, 2000, 3000], 3000, 2),
            ([4999], 4999, 0),
            ([600_000_000 - (1 << 30)], 600_000_000, 59_999),  # a clock that wraps
        ],
    )
    def test_what_was_missed_is_the_more_of_edges_and_time(self, edge, times_us, dt_us, missed):
        ready = edge(*times_us)
        assert ready.take() is True
        assert (ready.dt_us, ready.missed) == (dt_us, missed)
        assert ready.take() is False
        assert edge(times_us[-1] + 30000).take()
        assert (ready.dt_us, ready.missed) == (30000, missed + 2)

    def test_edges_are_counted_over_the_end_of_sixteen_bits(self, edge):
        ready = edge(0)
        ready._edges = ready._taken = 0xFFFE
        assert edge(1000, 2000, 3000).take()
        assert ready.missed == 2
        assert edge(4000).take() and not ready.take()
        assert ready.missed == 2

    @pytest.mark.parametrize("timeout_ms", [0, 1, 5])
    def test_a_sample_within_the_time_is_taken_at_once(self, edge, timeout_ms):
        assert edge(7000).wait(timeout_ms)
        assert edge.bench.clock.now_us == 7000

    def test_a_sample_in_the_last_millisecond_is_taken(self, edge):
        clock, ready, sleep_ms = edge.bench.clock, edge(), edge.bench.clock.sleep_ms
        clock.sleep_ms = lambda ms: edge(3000) if clock.now_us == 2000 else sleep_ms(ms)
        assert ready.wait(3) is True
        assert (clock.now_us, ready.dt_us) == (3000, 3000)

    def test_waiting_in_vain_is_a_doubt_and_no_time(self, edge):
        ready = edge(1000)
        assert ready.take() and ready.wait(3) is False
        assert (edge.bench.clock.now_us, ready.dt_us) == (4000, 0)
        assert (edge.bench.imu.suspects, edge.bench.imu.restarts) == (1, 0)
        assert edge.bench.read() == VERIFIED  # asked for its settings, which it kept


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
