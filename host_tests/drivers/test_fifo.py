"""Samples out of the FIFO come whole, in order, with the right time, and losses are counted.

By hand, frame by frame, unless a test says otherwise: the period is 10 ms, the FIFO of 1008 bytes.
"""

import pytest
from zerorate_i2c.fifo import EMPTY, Fifo
from zerorate_i2c.mpu6050 import FRESH, RESTARTED, SUSPECT, VERIFIED


@pytest.fixture
def make(make_bench):
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
            made = [[300, -7, 16000, self.temp, 5000, -2570, self.number + i] for i in range(count)]
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
def by_hand(make):
    return make()


def test_the_chip_is_told_to_keep_every_word_and_stop_holds_through_restarts(by_hand):
    registers = by_hand.chip.registers
    assert (registers[0x23], registers[0x6A]) == (0xF8, 0x40)
    by_hand.fifo.stop()
    assert (registers[0x23], registers[0x6A]) == (0, 0)
    by_hand.imu.restart()
    assert by_hand.chip.registers[0x23] == by_hand.chip.registers[0x6A] == 0


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
def test_the_newest_of_what_waits_is_between_now_and_a_period_ago(by_hand, now_us, count, step_us):
    for frame in by_hand.frames(count):
        assert by_hand.read(now_us) == (FRESH, frame, step_us)
    assert by_hand.read(now_us)[0] == EMPTY
    by_hand.frames(1)
    newest_us = -5000 + count * step_us
    assert by_hand.read(newest_us + 10000)[2] == 10000


def test_more_than_a_batch_takes_two_and_the_step_of_all(by_hand):
    made, transfers = by_hand.frames(11), by_hand.bench.bus.transfers
    assert [by_hand.read(50000) for _ in made[:8]] == [(FRESH, f, 5000) for f in made[:8]]
    assert [by_hand.read(65000) for _ in made[8:]] == [(FRESH, f, 10000) for f in made[8:]]
    assert by_hand.fifo.frames == 11
    assert by_hand.bench.bus.transfers - transfers == 6  # the flags, the count, the frames


@pytest.mark.parametrize("count, over", [(71, False), (72, True)])
def test_a_fifo_with_no_room_for_a_frame_has_overflowed(by_hand, count, over):
    by_hand.frames(count)
    status, _, _ = by_hand.read(10000 * count)
    assert (status, by_hand.fifo.overflows) == ((EMPTY, 1) if over else (FRESH, 0))
    assert by_hand.chip.fifo.count == (0 if over else 14 * (count - 8))


def test_the_flag_alone_is_an_overflow_and_its_time_goes_to_the_next(by_hand):
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
def test_other_flags_are_none(by_hand, flag):
    by_hand.frames(1)
    by_hand.chip.registers[0x3A] = flag
    assert by_hand.read(5000)[0] == FRESH
    assert by_hand.fifo.overflows == 0


def test_ten_minutes_are_ten_minutes_by_a_clock_that_wraps(by_hand):
    by_hand.frames(1)
    by_hand.read(15000)
    by_hand.fifo._lose(by_hand.fifo.newest_us + 600_000_000 - (1 << 30))
    assert (by_hand.fifo.lost, by_hand.fifo._gap_us) == (60_000, 599_995_000)


def test_a_read_back_is_told_with_the_next_frame_though_nothing_waits(make):
    by_hand = make(check_every=40)
    told = []
    for load in range(12):
        if load in (5, 6):
            assert by_hand.read()[0] == EMPTY
            continue
        by_hand.frames(1)
        told.append(by_hand.read(10000 * load)[0])
    assert told == [FRESH] * 5 + [VERIFIED] + [FRESH] * 2 + [VERIFIED] + [FRESH]


@pytest.mark.parametrize("sign", [1, -1])
def test_the_temperature_jumps_from_400_on(by_hand, sign):
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
def test_eight_repeats_are_suspect_and_one_word_ends_them(by_hand, word):
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
def test_a_frame_of_one_word_is_suspect_and_needs_no_restart(by_hand, word):
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
def test_silence_of_more_than_sixteen_periods_restarts_the_chip(by_hand, late_us, said):
    by_hand.frames(1)
    by_hand.read(5000)
    assert by_hand.read(5000 + 160000 + late_us)[0] == EMPTY
    assert by_hand.read(5000 + 160000)[0] == said
    assert by_hand.imu.restarts == late_us


def test_an_odd_period_begins_half_a_period_ago(by_hand):
    by_hand.imu.period_us = 9999
    by_hand.fifo._begin(0)
    by_hand.frames(1)
    assert by_hand.read(9999 - 5000)[2] == 9999


def test_bytes_over_are_misaligned_when_they_stay(by_hand):
    by_hand.frames(2)
    by_hand.chip.fifo.put(1)
    assert by_hand.read(15000)[0] == EMPTY
    fifo = by_hand.fifo
    assert (fifo.lost, fifo.overflows, fifo.misalignments) == (2, 0, 1)
    assert (by_hand.chip.fifo.count, by_hand.chip.registers[0x6A]) == (0, 0x40)


def test_only_the_first_frame_of_a_batch_tells_of_the_read_back(by_hand):
    by_hand.imu._until_check = 0
    by_hand.frames(3)
    assert [by_hand.read(25000)[0] for _ in range(3)] == [VERIFIED, FRESH, FRESH]


def test_a_frame_that_waits_is_no_silence(by_hand):
    by_hand.frames(1)
    assert by_hand.read(200000)[0] == FRESH
    assert by_hand.imu.suspects == 0


def test_a_batch_is_never_read_twice(by_hand):
    by_hand.frames(3)
    by_hand.bench.bus.fault("gone", skip=2, at_byte=20)
    assert by_hand.read(25000)[0] == EMPTY
    assert (by_hand.imu.bus_errors, by_hand.fifo.lost, by_hand.chip.fifo.count) == (1, 3, 0)
    [frame] = by_hand.frames(1)
    assert by_hand.read(30000) == (VERIFIED, frame, 35000)


PERIOD_US = 10000


@pytest.fixture
def live(make_bench):
    """A bench whose chip samples as time passes, its temperature calm, its samples numbered."""
    rows = [[300, -7, 16000, 9000 + n % 50, 5000, -2570, n] for n in range(6000)]
    bench = make_bench(source=rows, linked=True)
    bench.fifo = Fifo(bench.imu)
    return bench


def drained(live, after_us=0):
    """Numbers of the samples that come out some time later, and the time that they take."""
    live.clock.advance_us(after_us)
    numbers, passed_us = [], 0
    while (status := live.fifo.read(live.sample)) != EMPTY:
        if status in (FRESH, VERIFIED):
            numbers.append(live.sample[6])
            passed_us += live.fifo.dt_us
    return numbers, passed_us


@pytest.mark.parametrize("lost_bytes", [1, 7, 13])
def test_lost_alignment_is_found_before_a_frame_of_it_is_delivered(live, lost_bytes):
    before, _ = drained(live, 100000)
    live.clock.advance_us(100000)
    for _ in range(lost_bytes):
        live.chip.fifo.get()
    assert drained(live) == ([], 0) and live.fifo.misalignments == 1
    after, passed_us = drained(live, 100000)
    gone = after[0] - before[-1] - 1
    assert after == sorted(after) and after[-1] == live.chip.samples_made - 1
    assert live.fifo.lost == pytest.approx(gone, abs=1)
    assert passed_us == pytest.approx((len(after) + gone) * PERIOD_US, abs=PERIOD_US)


def test_a_frame_half_written_when_counted_is_no_loss(live):
    drained(live, 100000)
    live.clock.advance_us(50000)
    frame, reads = live.chip.registers[0x3B:0x49], []
    for byte in frame[:6]:
        live.chip.fifo.put(byte)

    def finish(i):
        reads.append(i)
        for byte in frame[6:] if len(reads) == 3 else ():
            live.chip.fifo.put(byte)

    live.bus.between_bytes = finish
    drained(live)
    assert live.fifo.misalignments == live.fifo.lost == 0


@pytest.mark.parametrize("kind", ["all_ff", "all_00"])
def test_a_dead_bus_ends_in_an_error_and_never_in_a_sample(live, kind):
    drained(live, 100000)
    live.bus.fault(kind, times=None)
    with pytest.raises(OSError):
        for _ in range(30):
            assert drained(live, 50000) == ([], 0)


@pytest.mark.parametrize(
    "max_burst, asked, batch",
    [(None, 8, 8), (0, 8, 8), (28, 8, 2), (27, 8, 1), (14, 8, 1), (500, 3, 3), (0, 1, 1)],
)
def test_a_bus_of_short_transfers_gets_short_batches(make_bench, max_burst, asked, batch):
    bench = make_bench()
    if max_burst is not None:
        bench.bus.max_burst = max_burst
    sizes = [len(view) for view in Fifo(bench.imu, asked)._views]
    assert sizes == [14 * (count + 1) for count in range(batch)]
    assert len(Fifo(bench.imu)._views) == (batch if max_burst in (14, 27, 28) else 8)


@pytest.mark.parametrize("max_burst, asked", [(13, 8), (1, 8), (0, 0), (0, -1)])
def test_a_batch_without_a_frame_is_a_value_error(make_bench, max_burst, asked):
    bench = make_bench()
    bench.bus.max_burst = max_burst
    with pytest.raises(ValueError, match="at least one frame of 14 bytes"):
        Fifo(bench.imu, asked)


def test_the_time_that_a_program_adds_up_is_the_chips_over_restarts(live):
    """As examples/main.py does it: dt_us is added for every status but EMPTY."""
    taken_us, step = {}, live.chip.step

    def noted():
        taken_us[live.chip.samples_made] = live.clock.now_us
        return step()

    live.chip.step = noted
    passed_us, restarts, ends = 0, 0, []
    for _ in range(10):
        for _ in range(300):
            live.clock.advance_us(PERIOD_US // 10)
            status = live.fifo.read(live.sample)
            restarts += status == RESTARTED
            assert status != RESTARTED or live.fifo.dt_us == 0
            if status != EMPTY:
                passed_us += live.fifo.dt_us
            if status in (FRESH, VERIFIED):
                ends.append((passed_us, taken_us[live.sample[6]]))
        live.chip.power_up()
        live.imu.doubt(False)
    (first_us, first_taken_us), *_, (last_us, last_taken_us) = ends
    assert restarts == 9
    assert last_us - first_us == pytest.approx(last_taken_us - first_taken_us, abs=PERIOD_US)
