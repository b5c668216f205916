"""Samples out of the FIFO come whole, in order, with the right time, and losses are counted."""

import pytest
from zerorate_i2c.fifo import EMPTY, Fifo
from zerorate_i2c.mpu6050 import FRESH, RESTARTED, SUSPECT, VERIFIED

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


def test_nothing_waiting_is_empty(fifo_bench):
    assert fifo_bench.fifo.read(fifo_bench.bench.sample) == EMPTY


def test_frames_come_in_order_and_none_is_lost(fifo_bench):
    for pause_us in (35000, 10000, 200000, 5000, 400000):
        fifo_bench.drain(pause_us)
    assert fifo_bench.numbers == list(range(fifo_bench.numbers[0], fifo_bench.numbers[-1] + 1))
    assert fifo_bench.missing() == 0
    assert fifo_bench.fifo.lost == 0


def test_time_steps_are_the_period_when_nothing_is_lost(fifo_bench):
    for _ in range(20):
        fifo_bench.drain(35000)
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


def test_an_overflow_is_told_counted_and_kept_right_in_time(fifo_bench):
    fifo_bench.drain(100000)
    fifo_bench.drain(1500000)
    fifo_bench.drain(100000)
    assert fifo_bench.fifo.overflows == 1
    assert abs(fifo_bench.fifo.lost - fifo_bench.missing()) <= 1
    assert fifo_bench.missing() >= 150
    assert max(abs(slip) for slip in fifo_bench.slips_us()) <= PERIOD_US


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


def test_lost_alignment_that_the_count_hides_is_found_by_temperature(fifo_bench):
    fifo_bench.drain(100000)
    fifo_bench.run(100000)
    for _ in range(4):
        fifo_bench.chip.fifo.get()
    for _ in range(4):
        fifo_bench.chip.fifo.put(0)
    statuses = fifo_bench.drain()
    assert fifo_bench.fifo.misalignments == 1
    assert SUSPECT in statuses


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


def test_a_bus_lost_in_mid_burst_costs_samples_but_not_alignment(fifo_bench):
    fifo_bench.drain(100000)
    fifo_bench.run(100000)
    fifo_bench.bus.fault("gone", skip=2, at_byte=20)
    fifo_bench.drain()
    fifo_bench.drain(100000)
    assert fifo_bench.imu.bus_errors == 1
    assert abs(fifo_bench.fifo.lost - fifo_bench.missing()) <= 1
    assert max(abs(slip) for slip in fifo_bench.slips_us()) <= PERIOD_US


def test_a_brown_out_restarts_the_chip_with_its_fifo(fifo_bench):
    fifo_bench.drain(100000)
    fifo_bench.chip.power_up()
    statuses = []
    for _ in range(10):
        statuses += fifo_bench.drain(100000)
    assert RESTARTED in statuses
    assert fifo_bench.imu.restarts == 1
    assert fifo_bench.chip.registers[0x23] == 0xF8
    assert statuses[-1] == FRESH


def test_frozen_frames_are_suspect_and_restart_the_chip(fifo_bench):
    fifo_bench.drain(100000)
    fifo_bench.chip.frozen = True
    statuses = fifo_bench.drain(300000)
    assert SUSPECT in statuses and RESTARTED in statuses


@pytest.mark.parametrize("kind", ["all_ff", "all_00"])
def test_a_dead_bus_ends_in_an_error_and_never_in_a_sample(fifo_bench, kind):
    fifo_bench.drain(100000)
    delivered = len(fifo_bench.numbers)
    fifo_bench.bus.fault(kind, times=None)
    with pytest.raises(OSError):
        for _ in range(30):
            fifo_bench.drain(50000)
    assert len(fifo_bench.numbers) == delivered


def test_the_configuration_is_read_back_while_frames_flow(make_bench):
    bench = FifoBench(make_bench, check_every=40)
    statuses = []
    for _ in range(20):
        statuses += bench.drain(100000)
    assert statuses.count(VERIFIED) >= 4


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


class TestByHand:
    """Frames put into the chip, and times, one by one; the period is 10 ms, the FIFO 1008 bytes."""

    @pytest.fixture
    def make(self, make_bench):
        class ByHand:
            def __init__(self, **options):
                self.bench = make_bench(part="ICM-20602", **options)
                self.imu, self.clock, self.chip = self.bench.imu, self.bench.clock, self.bench.chip
                self.clock.now_us = 0
                self.fifo = Fifo(self.imu)
                self.temp, self.number = 9000, 0

            def put(self, *frames):
                for frame in frames:
                    for word in frame:
                        self.chip.fifo.put(word >> 8 & 0xFF)
                        self.chip.fifo.put(word & 0xFF)

            def frames(self, count):
                """Put count frames, no two alike; they."""
                made = [
                    [300, -7, 16000, self.temp, 5000, -2570, self.number + i] for i in range(count)
                ]
                self.number += count
                self.put(*made)
                return made

            def read(self, at_us=None):
                """(status, words, dt_us) of one."""
                if at_us is not None:
                    self.clock.now_us = at_us
                status = self.fifo.read(self.bench.sample)
                return status, list(self.bench.sample), self.fifo.dt_us

        return ByHand

    @pytest.fixture
    def by_hand(self, make):
        return make()

    def test_the_chip_is_told_to_keep_every_word(self, by_hand):
        registers = by_hand.chip.registers
        assert (registers[0x23], registers[0x6A]) == (0xF8, 0x40)
        by_hand.fifo.stop()
        assert (registers[0x23], registers[0x6A]) == (0, 0)

    # the sample before the first is taken to be half a period old, at -5,000 us
    @pytest.mark.parametrize(
        "now_us, count, step_us",
        [
            (5000, 1, 10000),
            (4999, 1, 9999),
            (15000, 1, 10000),
            (15001, 1, 10001),
            (0, 3, 1666),
            (1, 3, 1667),
            (24999, 3, 9999),
            (25000, 3, 10000),
            (40002, 2, 17501),
            (40001, 2, 17500),
            (75000, 8, 10000),
            (74993, 8, 9999),
            (74992, 8, 9999),
            (74991, 8, 9998),
        ],
    )
    def test_the_newest_of_what_waits_is_between_now_and_a_period_ago(
        self, by_hand, now_us, count, step_us
    ):
        for frame in by_hand.frames(count):
            assert by_hand.read(now_us) == (FRESH, frame, step_us)
        assert by_hand.read(now_us)[0] == EMPTY
        by_hand.frames(1)
        newest_us = -5000 + count * step_us
        assert by_hand.read(newest_us + 10000)[2] == 10000

    def test_more_than_a_batch_takes_two_and_the_step_of_all(self, by_hand):
        made = by_hand.frames(11)
        assert [by_hand.read(50000) for _ in made[:8]] == [(FRESH, f, 5000) for f in made[:8]]
        assert [by_hand.read(65000) for _ in made[8:]] == [(FRESH, f, 10000) for f in made[8:]]
        assert by_hand.fifo.frames == 11

    def test_an_odd_period_begins_half_a_period_ago(self, by_hand):
        by_hand.imu.period_us = 9999
        by_hand.fifo._begin(0)
        by_hand.frames(1)
        assert by_hand.read(9999 - 5000)[2] == 9999

    @pytest.mark.parametrize("count, over", [(71, False), (72, True)])
    def test_a_fifo_with_no_room_for_a_frame_has_overflowed(self, by_hand, count, over):
        by_hand.frames(count)
        status, _, _ = by_hand.read(10000 * count)
        assert (status, by_hand.fifo.overflows) == ((EMPTY, 1) if over else (FRESH, 0))
        assert by_hand.chip.fifo.count == (0 if over else 14 * (count - 8))

    def test_the_flag_alone_is_an_overflow_and_its_time_goes_to_the_next(self, by_hand):
        by_hand.frames(2)
        assert [by_hand.read(15000)[2] for _ in range(2)] == [10000, 10000]
        by_hand.frames(3)
        by_hand.chip.registers[0x3A] = 0x10
        assert by_hand.read(59999)[0] == EMPTY  # 44,999 us after the newest: four are gone
        fifo = by_hand.fifo
        assert (fifo.lost, fifo.overflows, fifo.misalignments, fifo.frames) == (4, 1, 0, 2)
        [frame] = by_hand.frames(1)
        assert by_hand.read(64999) == (FRESH, frame, 49999)  # its own time is 64,999 us

    @pytest.mark.parametrize("flag", [0x01, 0x0F, 0xE0])
    def test_other_flags_are_none(self, by_hand, flag):
        by_hand.frames(1)
        by_hand.chip.registers[0x3A] = flag
        assert by_hand.read(5000)[0] == FRESH
        assert by_hand.fifo.overflows == 0

    def test_nothing_lost_is_not_less_than_nothing(self, by_hand):
        by_hand.frames(2)
        by_hand.read(15000)
        by_hand.fifo._lose(4000)  # before the newest delivered
        assert by_hand.fifo.lost == 0

    def test_bytes_over_are_misaligned_when_they_stay(self, by_hand):
        by_hand.frames(2)
        by_hand.chip.fifo.put(1)
        assert by_hand.read(15000)[0] == EMPTY
        fifo = by_hand.fifo
        assert (fifo.lost, fifo.overflows, fifo.misalignments) == (2, 0, 1)
        assert (by_hand.chip.fifo.count, by_hand.chip.registers[0x6A]) == (0, 0x40)

    def test_a_read_back_is_told_with_the_next_frame_though_nothing_waits(self, make):
        by_hand = make(check_every=40)
        told = []
        for load in range(12):
            if load in (5, 6):
                assert by_hand.read()[0] == EMPTY
                continue
            by_hand.frames(1)
            told.append(by_hand.read(10000 * load)[0])
        assert told == [FRESH] * 5 + [VERIFIED] + [FRESH] * 2 + [VERIFIED] + [FRESH]

    def test_only_the_first_frame_of_a_batch_tells_of_the_read_back(self, by_hand):
        by_hand.imu._until_check = 0
        by_hand.frames(3)
        assert [by_hand.read(25000)[0] for _ in range(3)] == [VERIFIED, FRESH, FRESH]

    @pytest.mark.parametrize("sign", [1, -1])
    def test_the_temperature_jumps_from_400_on(self, by_hand, sign):
        by_hand.temp = 100 * sign
        by_hand.frames(1)
        by_hand.temp += 399 * sign
        by_hand.frames(1)
        by_hand.temp += 400 * sign
        by_hand.frames(2)
        assert [by_hand.read(35000)[0] for _ in range(3)] == [FRESH, FRESH, SUSPECT]
        assert (by_hand.fifo.lost, by_hand.fifo.misalignments, by_hand.fifo.dt_us) == (2, 1, 0)
        assert by_hand.imu.suspects == 0  # its settings are in no doubt
        assert by_hand.read(35000)[0] == EMPTY
        [frame] = by_hand.frames(1)  # what came after it is the first again, and none to compare
        assert by_hand.read(40000) == (FRESH, frame, 25000)

    @pytest.mark.parametrize("word", range(7))
    def test_eight_repeats_are_suspect_and_one_word_ends_them(self, by_hand, word):
        same = [300, -7, 16000, 9000, 5000, -2570, 5]
        other = list(same)
        other[word] += 1
        by_hand.put(*[same] * 8)
        assert [by_hand.read(75000)[0] for _ in range(8)] == [FRESH] * 8
        by_hand.put(other, *[same] * 7)
        assert [by_hand.read(155000)[0] for _ in range(8)] == [FRESH] * 8
        by_hand.put(same, same)
        assert [by_hand.read(175000)[0] for _ in range(2)] == [FRESH, SUSPECT]
        assert (by_hand.imu.suspects, by_hand.fifo.frames) == (1, 18)
        by_hand.put(other)
        assert by_hand.read(185000)[0] == RESTARTED

    @pytest.mark.parametrize("word", range(7))
    def test_a_frame_of_one_word_is_suspect_and_needs_no_restart(self, by_hand, word):
        flat = [9000] * 7
        nearly = list(flat)
        nearly[word] -= 1
        by_hand.put(nearly, flat, nearly)
        assert [by_hand.read(25000)[0] for _ in range(3)] == [FRESH, SUSPECT, FRESH]
        by_hand.put(flat)
        by_hand.frames(1)
        assert by_hand.read(45000)[0] == SUSPECT
        [frame] = by_hand.frames(1)
        assert by_hand.read(55000)[0] == FRESH and by_hand.imu.suspects == 2
        assert by_hand.read(55000)[0] == VERIFIED

    @pytest.mark.parametrize("late_us, said", [(0, EMPTY), (1, RESTARTED)])
    def test_silence_of_more_than_sixteen_periods_restarts_the_chip(self, by_hand, late_us, said):
        by_hand.frames(1)
        by_hand.read(5000)
        assert by_hand.read(5000 + 160000 + late_us)[0] == EMPTY
        assert by_hand.read(5000 + 160000)[0] == said
        assert by_hand.imu.restarts == late_us

    def test_a_frame_that_waits_is_no_silence(self, by_hand):
        by_hand.frames(1)
        assert by_hand.read(200000)[0] == FRESH
        assert by_hand.imu.suspects == 0

    def test_a_batch_is_never_read_twice(self, by_hand):
        by_hand.frames(3)
        by_hand.bench.bus.fault("gone", skip=2, at_byte=20)
        assert by_hand.read(25000)[0] == EMPTY
        assert (by_hand.imu.bus_errors, by_hand.fifo.lost, by_hand.chip.fifo.count) == (1, 3, 0)
        [frame] = by_hand.frames(1)
        assert by_hand.read(30000) == (VERIFIED, frame, 35000)
