"""A window of frames, and the rest it is of, beside the same in floats."""

import math
from array import array

import numpy as np
import pytest
from zerorate import Corrector
from zerorate.rest import stillness
from zerorate_tools.layout import SETTINGS, STATE, STILLNESS

N, SHIFT, SEGMENT = 32, 5, 8


@pytest.fixture
def rest():
    """(state, settings) of a new corrector of rests alone."""
    corrector = Corrector(motion=False, gravity=False)
    c = corrector.settings
    assert [c[at] for at in (SETTINGS.WINDOW, SETTINGS.WINDOW_SHIFT, SETTINGS.SEGMENT)] == [
        *(N, SHIFT, SEGMENT)
    ]
    return corrector.state, c


def fill(s, c, frames):
    """Gather the frames, (32, 7); whether the window is full with the last of them alone."""
    full = [stillness.gather(s, c, array("i", row)) for row in np.rint(frames).astype(int).tolist()]
    assert full == [0] * (N - 1) + [1]


def still(draw, gyro_lsb=3.0, accel_lsb=20.0, rates=(100, -200, 50), up=(0, 0, 16384), temp=1000):
    mean = np.array([*up, temp, *rates])
    return mean + draw.normal(0, [accel_lsb] * 3 + [4] + [gyro_lsb] * 3, (N, 7))


def judged(s, c, frames):
    fill(s, c, frames)
    windows = stillness.judge(s, c)
    return s[STATE.STILLNESS], windows


def test_a_windows_variance_is_numpys(rest, draw):
    s, c = rest
    frames = np.rint(still(draw, 30, 100))
    fill(s, c, frames)
    of_gyro = stillness.spread_q8(s, STATE.WINDOW_SUM + 4, s[STATE.SQUARE_GYRO], SHIFT)
    assert of_gyro / 256 == pytest.approx(frames[:, 4:].var(axis=0).sum(), rel=0.01)
    of_accel = stillness.spread_q8(s, STATE.WINDOW_SUM, s[STATE.SQUARE_ACCEL], SHIFT)
    assert of_accel / 256 == pytest.approx(frames[:, :3].var(axis=0).sum(), rel=0.01)
    from_first = np.diff(frames[:, 4:] - frames[0, 4:], axis=0)
    assert s[STATE.SQUARE_STEP] == np.square(from_first).sum()
    assert (
        list(s[STATE.WINDOW_SUM : STATE.WINDOW_SUM + 7])
        == (frames - frames[0]).sum(axis=0).tolist()
    )


@pytest.mark.parametrize("channel", [0, 1, 2, 4, 5, 6])
@pytest.mark.parametrize(("by", "is_far"), [(-513, 1), (-512, 0), (511, 0), (512, 1)])
def test_a_reading_far_from_the_first_makes_a_window_dirty(rest, channel, by, is_far):
    s, c = rest
    frames = np.zeros((N, 7))
    frames[9, channel] = by
    fill(s, c, frames)
    assert s[STATE.DIRTY] == is_far * (channel + 1)
    stillness.judge(s, c)
    moving = STILLNESS.MOVING if channel > 3 else STILLNESS.SHAKEN
    assert not is_far or s[STATE.STILLNESS] == moving


def test_the_thermometer_is_read_in_motion_as_well(rest):
    s, c = rest
    frames = np.zeros((N, 7))
    frames[5:, 0] = 4000
    frames[:, 3] = np.arange(N)
    fill(s, c, frames)
    assert s[STATE.WINDOW_SUM + 3] == sum(range(N))


@pytest.mark.parametrize(
    ("ratio", "is_white"), [(1.3, 0), (1.37, 0), (1.38, 1), (2.0, 1), (2.74, 1), (2.76, 0)]
)
def test_steps_of_about_twice_the_variance_are_noise(rest, ratio, is_white):
    s, c = rest
    spread = 1 << 20
    s[STATE.SQUARE_STEP] = round(ratio * spread * N / 256)
    assert stillness.white(s, c, spread) == is_white


def test_a_rest_is_still_and_its_segment_ends_after_eight_windows(rest, draw):
    s, c = rest
    total = np.zeros(3)
    for number in range(2 * SEGMENT):
        frames = np.rint(still(draw))
        total += frames[:, 4:].sum(axis=0)
        ended = number % SEGMENT == SEGMENT - 1
        assert judged(s, c, frames) == (STILLNESS.STILL, SEGMENT if ended else 0)
        assert list(s[STATE.SEGMENT_TOTAL : STATE.SEGMENT_TOTAL + 3]) == total.tolist()
        assert s[STATE.REST] == 1 + number // SEGMENT
        total *= not ended


@pytest.mark.parametrize(("windows", "told"), [(1, 0), (2, 2), (5, 5)])
@pytest.mark.parametrize("kind", ["MOVING", "SHAKEN"])
def test_motion_ends_a_segment_of_two_windows_or_more(rest, draw, windows, told, kind):
    s, c = rest
    for _ in range(windows):
        judged(s, c, still(draw))
    wave = np.sin(np.arange(N) / 3)[:, None] * (np.array([0, 0, 0, 0, 1, 1, 1]) * 100)
    frames = still(draw) + wave if kind == "MOVING" else still(draw, accel_lsb=400)
    assert judged(s, c, frames) == (getattr(STILLNESS, kind), told)
    assert (s[STATE.REST], s[STATE.SEGMENT_WINDOWS]) == (0, 0)


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize(("by_lsb", "kind"), [(5, "STILL"), (14, "SHIFTED"), (-14, "SHIFTED")])
def test_a_mean_rate_that_changes_ends_the_rest(rest, draw, axis, by_lsb, kind):
    s, c = rest
    rates = np.array([100, -200, 50])
    judged(s, c, still(draw, 1.0, rates=rates))
    rates[axis] += by_lsb
    assert judged(s, c, still(draw, 1.0, rates=rates)) == (getattr(STILLNESS, kind), 0)
    # what comes after is of a new rest, which begins there
    assert s[STATE.SEGMENT_WINDOWS] == (2 if kind == "STILL" else 1)
    assert s[STATE.FIRST_RATE_Q4 + axis] / 16 == pytest.approx(
        rates[axis] - by_lsb * (kind == "STILL"), abs=1
    )


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize(("by_lsb", "kind"), [(8, "STILL"), (60, "TURNING"), (-60, "TURNING")])
def test_gravity_that_has_moved_ends_the_rest(rest, draw, axis, by_lsb, kind):
    s, c = rest
    up = np.array([3000, -2000, 15000])
    judged(s, c, still(draw, up=up))
    up[axis] += by_lsb
    assert judged(s, c, still(draw, up=up)) == (getattr(STILLNESS, kind), 0)


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize(
    ("tilted", "turns"),
    [("00001111", 1), ("11110000", 1), ("00111100", 0), ("01010101", 0), ("00000011", 0)],
)
def test_gravity_that_leans_one_way_over_a_segment_is_a_turn(rest, draw, axis, tilted, turns):
    s, c = rest
    said = []
    for tilt in tilted:
        up = np.array([0, 0, 16384])
        up[axis] += 17 * int(tilt)
        said.append(judged(s, c, still(draw, 1.0, 3.0, up=up)))
    assert said[:-1] == [(STILLNESS.STILL, 0)] * 7
    assert said[-1] == ((STILLNESS.TURNING, 0) if turns else (STILLNESS.STILL, SEGMENT))
    assert s[STATE.REST] == (0 if turns else 1)


def test_a_temperature_is_the_end_of_a_line_through_up_to_thirty_windows(rest, draw):
    s, c = rest
    noisy = 1000 + 7.5 * np.arange(28) + draw.normal(0, 20, 28)
    for number, temp in enumerate(noisy):
        frames = np.tile([0, 0, 16384, temp, 0, 0, 0], (N, 1))
        fill(s, c, frames)
        stillness.judge(s, c)
        there = np.rint(noisy[: number + 1])
        line = np.polyfit(range(number + 1), there, min(number, 1))
        assert s[STATE.TEMP] == pytest.approx(16 * np.polyval(line, number) / 16, abs=1)


def test_a_temperature_far_off_the_line_begins_a_new_one(rest):
    s, c = rest
    for temp in (1000, 1010, 1020, 4000):
        fill(s, c, np.tile([0, 0, 16384, temp, 0, 0, 0], (N, 1)))
        stillness.judge(s, c)
    assert (s[STATE.TEMP], s[STATE.TEMP_WINDOWS], s[STATE.TEMP_RISE_Q12]) == (4000, 1, 0)


# What of a rest may be a turn


def hidden_lsb(s, c, axis, up_lsb, segments):
    """One sigma of a turn that a rest of so many segments hides on the axis, in floats."""
    biases = np.array(s[STATE.TARGET_Q8 : STATE.TARGET_Q8 + 3]) / 256
    halves = c[SETTINGS.TURN_HALVES]
    g = np.linalg.norm(up_lsb)
    lean = math.sqrt(2 * max(g / 16384 - 1, 0))
    usual = c[SETTINGS.TURNING_LSB]
    turn = math.sqrt(usual**2 * (1 + (9 * lean) ** 2) + (biases**2).sum() / 2)
    turn *= (1 - segments % halves / (2 * halves)) / 2 ** (segments // halves)
    if not g or not segments:
        return turn
    share = abs(up_lsb[axis]) / g + lean
    moved = math.sqrt(s[STATE.TIP_Q8] + c[SETTINGS.TIP_LIMIT_Q8])
    level = moved * c[SETTINGS.TILT_SPEED] / (g / 16) / segments / 16
    return turn * min(share, 1) + level


@pytest.mark.parametrize("segments", [0, 1, 3, 182, 183, 250, 800])
@pytest.mark.parametrize(
    "up", [(0, 0, 16384), (9000, -12000, 5000), (-16384, 0, 0), (9000, 0, 16000), (0, 0, 0)]
)
def test_a_rest_hides_turns_along_gravity_and_slow_ones_across_it(rest, draw, up, segments):
    s, c = rest
    s[STATE.REST], s[STATE.TIP_Q8] = segments, int(draw.integers(0, 90000))
    for i in range(3):
        s[STATE.ANCHOR_Q4 + i] = 16 * up[i]
        s[STATE.TARGET_Q8 + i] = int(draw.normal(0, 200 * 256))
    for axis in range(3):
        expected = hidden_lsb(s, c, axis, np.array(up), segments)
        assert stillness.hidden_q4(s, c, axis) / 16 == pytest.approx(expected, rel=0.02, abs=0.5)
