"""Samples out of the FIFO come whole, in order, with the right time, and losses are counted."""

import pytest
from zerorate_i2c.fifo import EMPTY, Fifo
from zerorate_i2c.mpu6050 import FRESH, RESTARTED, VERIFIED

PERIOD_US = 10000


class FifoBench:
    """A linked bench whose recording has a calm temperature, and what was delivered from it."""

    def __init__(self, make_bench, **options):
        rows = [[300, -7, 16000, 9000 + n % 50, 5000, -2570, n] for n in range(6000)]
        self.bench = make_bench(source=rows, linked=True, **options)
        self.chip, self.bus, self.clock = self.bench.chip, self.bench.bus, self.bench.clock
        self.imu = self.bench.imu
        self.fifo = Fifo(self.imu)
        self.numbers = []
        self.times_us = []
        self.statuses = []
        self.now_us = 0

    def run(self, us):
        self.clock.advance_us(us)

    def drain(self, after_us=0):
        """Read until empty, some time later; the statuses."""
        self.clock.advance_us(after_us)
        statuses = []
        for _ in range(2000):
            status = self.fifo.read(self.bench.sample)
            if status == EMPTY:
                break
            statuses.append(status)
            if status in (FRESH, VERIFIED):
                self.now_us += self.fifo.dt_us
                self.numbers.append(self.bench.sample[6])
                self.times_us.append(self.now_us)
        return statuses

    def slips_us(self):
        """Delivered time minus true time, from the first sample on."""
        first = self.numbers[0] * PERIOD_US - self.times_us[0]
        pairs = zip(self.numbers, self.times_us, strict=True)
        return [at_us + first - number * PERIOD_US for number, at_us in pairs]

    def missing(self):
        return self.chip.samples_made - self.numbers[0] - len(self.numbers)


@pytest.fixture
def fifo_bench(make_bench):
    return FifoBench(make_bench)


def test_frames_come_in_order_and_none_is_lost(fifo_bench):
    for pause_us in (35000, 10000, 200000, 5000, 400000):
        fifo_bench.drain(pause_us)
    assert fifo_bench.numbers == list(range(fifo_bench.numbers[0], fifo_bench.numbers[-1] + 1))
    assert fifo_bench.missing() == 0
    assert fifo_bench.fifo.lost == 0
    assert max(abs(slip) for slip in fifo_bench.slips_us()) <= PERIOD_US


def test_several_frames_go_by_one_transfer(fifo_bench):
    fifo_bench.run(80000)
    before = fifo_bench.bus.transfers
    for _ in range(8):
        assert fifo_bench.fifo.read(fifo_bench.bench.sample) == FRESH
    assert fifo_bench.bus.transfers - before == 3


def test_a_chip_that_runs_fast_does_not_outrun_the_clock(fifo_bench):
    fifo_bench.imu.period_us = 10300
    before_first_us = fifo_bench.clock.now_us - PERIOD_US // 2
    for _ in range(200):
        fifo_bench.drain(50000)
        assert before_first_us + fifo_bench.now_us <= fifo_bench.clock.now_us
    assert max(abs(slip) for slip in fifo_bench.slips_us()) <= 2 * PERIOD_US


@pytest.mark.parametrize("lost_bytes", [1, 2, 7, 13])
def test_lost_alignment_is_found_before_a_frame_of_it_is_delivered(fifo_bench, lost_bytes):
    fifo_bench.drain(100000)
    fifo_bench.run(100000)
    for _ in range(lost_bytes):
        fifo_bench.chip.fifo.get()
    fifo_bench.drain()
    fifo_bench.drain(100000)
    assert fifo_bench.fifo.misalignments == 1
    assert fifo_bench.numbers == sorted(fifo_bench.numbers)
    assert all(number < 6000 for number in fifo_bench.numbers)
    assert abs(fifo_bench.fifo.lost - fifo_bench.missing()) <= 1
    assert max(abs(slip) for slip in fifo_bench.slips_us()) <= PERIOD_US


def test_a_frame_half_written_when_counted_is_no_loss(fifo_bench):
    fifo_bench.drain(100000)
    fifo_bench.run(50000)
    chip = fifo_bench.chip
    late = []
    frame = [chip.registers[0x3B + i] for i in range(14)]
    for byte in frame[:6]:
        chip.fifo.put(byte)
    reads = []

    def finish(i):
        reads.append(i)
        if len(reads) == 3 and not late:
            late.append(True)
            for byte in frame[6:]:
                chip.fifo.put(byte)

    fifo_bench.bus.between_bytes = finish
    fifo_bench.drain()
    assert fifo_bench.fifo.misalignments == 0
    assert fifo_bench.fifo.lost == 0


@pytest.mark.parametrize("kind", ["all_ff", "all_00"])
def test_a_dead_bus_ends_in_an_error_and_never_in_a_sample(fifo_bench, kind):
    fifo_bench.drain(100000)
    delivered = len(fifo_bench.numbers)
    fifo_bench.bus.fault(kind, times=None)
    with pytest.raises(OSError):
        for _ in range(30):
            fifo_bench.drain(50000)
    assert len(fifo_bench.numbers) == delivered


@pytest.mark.parametrize(
    "part, size", [("MPU-6500", 512), ("ICM-20602", 1008), ("ICM-20689", 4096)]
)
def test_each_part_overflows_at_its_own_size(make_bench, part, size):
    bench = FifoBench(make_bench, part=part)
    bench.drain(10000 * (size // 14 - 2))
    assert bench.fifo.overflows == 0
    bench.drain(10000 * (size // 14 + 2))
    assert bench.fifo.overflows == 1


@pytest.mark.parametrize(
    "max_burst, asked, batch",
    [
        (None, 8, 8),
        (0, 8, 8),
        (32, 8, 2),
        (28, 8, 2),
        (27, 8, 1),
        (14, 8, 1),
        (500, 3, 3),
        (0, 1, 1),
    ],
)
def test_a_bus_of_short_transfers_gets_short_batches(make_bench, max_burst, asked, batch):
    bench = make_bench()
    if max_burst is not None:
        bench.bus.max_burst = max_burst
    sizes = [len(view) for view in Fifo(bench.imu, asked)._views]
    assert sizes == [14 * (count + 1) for count in range(batch)]
    assert len(Fifo(bench.imu)._views) == (batch if max_burst in (27, 28, 32, 14) else 8)


@pytest.mark.parametrize("max_burst, asked", [(13, 8), (1, 8), (0, 0), (0, -1)])
def test_a_batch_without_a_frame_is_a_value_error(make_bench, max_burst, asked):
    bench = make_bench()
    bench.bus.max_burst = max_burst
    with pytest.raises(ValueError, match="at least one frame of 14 bytes"):
        Fifo(bench.imu, asked)


def test_stop_leaves_the_fifo_off_through_restarts(fifo_bench):
    fifo_bench.fifo.stop()
    fifo_bench.imu.restart()
    assert fifo_bench.chip.registers[0x6A] == fifo_bench.chip.registers[0x23] == 0


def test_the_time_that_a_program_adds_up_is_the_chips_over_restarts(fifo_bench):
    """As examples/main.py does it: dt_us is added for every status but EMPTY."""
    taken_us, step = {}, fifo_bench.chip.step

    def noted():
        taken_us[fifo_bench.chip.samples_made] = fifo_bench.clock.now_us
        return step()

    fifo_bench.chip.step = noted
    passed_us, restarts, ends = 0, 0, []
    for _ in range(10):
        for _ in range(300):
            fifo_bench.run(PERIOD_US // 10)
            status = fifo_bench.fifo.read(fifo_bench.bench.sample)
            restarts += status == RESTARTED
            assert status != RESTARTED or fifo_bench.fifo.dt_us == 0
            if status != EMPTY:
                passed_us += fifo_bench.fifo.dt_us
            if status in (FRESH, VERIFIED):
                ends.append((passed_us, taken_us[fifo_bench.bench.sample[6]]))
        fifo_bench.chip.power_up()
        fifo_bench.imu.doubt(False)
    (first_us, first_taken_us), *_, (last_us, last_taken_us) = ends
    assert restarts == 9
    assert last_us - first_us == pytest.approx(last_taken_us - first_taken_us, abs=PERIOD_US)
