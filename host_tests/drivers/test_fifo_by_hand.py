"""The FIFO's frames put into the chip by hand, and the times: one by one, to the microsecond.

The period is 10 ms, the FIFO of 1008 bytes.
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


def test_the_chip_is_told_to_keep_every_word(by_hand):
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
def test_the_newest_of_what_waits_is_between_now_and_a_period_ago(by_hand, now_us, count, step_us):
    for frame in by_hand.frames(count):
        assert by_hand.read(now_us) == (FRESH, frame, step_us)
    assert by_hand.read(now_us)[0] == EMPTY
    by_hand.frames(1)
    newest_us = -5000 + count * step_us
    assert by_hand.read(newest_us + 10000)[2] == 10000


def test_more_than_a_batch_takes_two_and_the_step_of_all(by_hand):
    made = by_hand.frames(11)
    assert [by_hand.read(50000) for _ in made[:8]] == [(FRESH, f, 5000) for f in made[:8]]
    assert [by_hand.read(65000) for _ in made[8:]] == [(FRESH, f, 10000) for f in made[8:]]
    assert by_hand.fifo.frames == 11


def test_an_odd_period_begins_half_a_period_ago(by_hand):
    by_hand.imu.period_us = 9999
    by_hand.fifo._begin(0)
    by_hand.frames(1)
    assert by_hand.read(9999 - 5000)[2] == 9999


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


def test_nothing_lost_is_not_less_than_nothing(by_hand):
    by_hand.frames(2)
    by_hand.read(15000)
    by_hand.fifo._lose(4000)  # before the newest delivered
    assert by_hand.fifo.lost == 0


def test_bytes_over_are_misaligned_when_they_stay(by_hand):
    by_hand.frames(2)
    by_hand.chip.fifo.put(1)
    assert by_hand.read(15000)[0] == EMPTY
    fifo = by_hand.fifo
    assert (fifo.lost, fifo.overflows, fifo.misalignments) == (2, 0, 1)
    assert (by_hand.chip.fifo.count, by_hand.chip.registers[0x6A]) == (0, 0x40)


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


def test_only_the_first_frame_of_a_batch_tells_of_the_read_back(by_hand):
    by_hand.imu._until_check = 0
    by_hand.frames(3)
    assert [by_hand.read(25000)[0] for _ in range(3)] == [VERIFIED, FRESH, FRESH]


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
