"""What is published of one axis, how sure of it, and what others find until a rest does."""

import math
from array import array
from copy import deepcopy

import numpy as np
import pytest
from zerorate import Corrector, Sensor
from zerorate.rest import recent, step
from zerorate_tools.layout import AXIS, SETTINGS, SOURCE, STATE, STILLNESS, axis_at
from zerorate_tools.simulate.channels import flicker

from .played import LSB, play
from .played import rest as played_rest
from .test_offsets import SEGMENT, Axis
from .test_stillness import BIAS_DPS, handled, turning


@pytest.fixture
def axis():
    return Axis()


@pytest.mark.parametrize("doubt", [0, 900, 4095, 4096, 5000])
@pytest.mark.parametrize("grown", [100, 90000, 0x3FFFFE, 0x3FFFFF, 1 << 26])
@pytest.mark.parametrize("held", [False, True])
def test_one_sigma_is_of_offset_flicker_noise_and_what_may_be_a_turn(axis, grown, doubt, held):
    axis.put(FLOOR_Q16=400000, GROWN_Q8=grown)
    axis.put(DOUBT_Q4=0 if held else doubt, HELD_Q4=doubt if held else 0)
    flicker = (axis.c[SETTINGS.WINDOW_SHIFT] + 3) * (400000 // 16) // 32
    if doubt < 4096:
        expected = math.sqrt(flicker + grown + doubt**2)
    else:
        expected = doubt + math.sqrt(flicker + grown)
    found = step.sigma_q8(axis.s, axis.c, axis.a)
    assert found == pytest.approx(
        16 * expected, abs=1 + 16 * (flicker + grown + doubt**2 > 0x3FFFFE)
    )


def rested(axis, off_lsb, windows=2, **words):
    """The axis after so many windows of a rest that lies so far off a bias of 3 LSB."""
    readings = windows << axis.c[SETTINGS.WINDOW_SHIFT]
    axis.s[STATE.SEGMENT_WINDOWS], axis.s[STATE.STILLNESS] = windows, STILLNESS.STILL
    axis.s[STATE.SEGMENT_TOTAL + axis.axis] = round((3 + off_lsb) * readings)
    axis.put(NOISE_Q8=3000, FLOOR_Q16=500, TIP_Q8=0, **words)
    return readings


@pytest.mark.parametrize("axis_up", [0, 16384])
@pytest.mark.parametrize(("off_lsb", "grown"), [(2, 9000), (-4, 20000), (9, 20000), (20, 20000)])
def test_a_rest_that_goes_on_moves_the_bias_by_its_share_within_two_sigma(
    axis, off_lsb, grown, axis_up
):
    s, c = axis.s, axis.c
    readings = rested(axis, off_lsb, GROWN_Q8=grown)
    s[STATE.ANCHOR_Q4 + 2] = 16 * axis_up
    s[STATE.TILTING_Q4] = step.tilting_q4(s, c)  # as at the window's end
    noise = recent.mean_noise_q8(s, c, axis.a, readings)
    bias = step.moved_by_rest_q8(s, c, axis.a, 3 * 256)
    if (16 * off_lsb) ** 2 / 4 > grown + noise:
        assert (bias, axis.GROWN_Q8) == (3 * 256, grown)
        return
    share = grown / (grown + noise)
    turn = share * step.tilting_q4(s, c)
    assert bias == pytest.approx(256 * (3 + share * off_lsb), abs=2)
    assert axis.GROWN_Q8 == pytest.approx(share * noise + turn**2, rel=0.01, abs=2 * turn + 2)


@pytest.mark.parametrize("way", [1, -1])
def test_beyond_the_gate_a_rest_does_not_move_the_bias(axis, way):
    gate = axis.c[SETTINGS.GATE_Q4]
    for off_q4, moved in ((gate, True), (gate + 1, False)):
        rested(axis, way * off_q4 / 16, 16, GROWN_Q8=1 << 26)
        assert (step.moved_by_rest_q8(axis.s, axis.c, axis.a, 3 * 256) != 3 * 256) is moved


@pytest.mark.parametrize(
    ("waiting", "moved", "is_stale"), [(0, 0, 0), (1, 0, 1), (0, 1, 1), (0, -1, 1)]
)
def test_a_line_is_drawn_anew_where_something_was_learned_or_temperature_moved(
    axis, waiting, moved, is_stale
):
    temp = 1000 + moved * (axis.c[SETTINGS.STALE_LSB] + 1)
    axis.put(WAITING_N=waiting, TEMP=temp, LINE_TEMP=1000)
    assert step.stale(axis.s, axis.c, axis.a) == is_stale
    assert axis.LINE_TEMP == (temp if is_stale else 1000)
    axis.put(WAITING_N=0, TEMP=1000 + moved * axis.c[SETTINGS.STALE_LSB], LINE_TEMP=1000)
    assert step.stale(axis.s, axis.c, axis.a) == 0


@pytest.mark.parametrize(
    ("windows", "counts", "source", "state", "published"),
    [
        *((1, 31, 0, STILLNESS.STILL, 1), (1, 32, 0, STILLNESS.STILL, 0)),
        *((2, 32, 0, STILLNESS.STILL, 1), (2, 32, 1, STILLNESS.MOVING, 0)),
        *((2, 32, 2, STILLNESS.STILL, 2), (2, 32, 2, STILLNESS.MOVING, 2)),
    ],
)
def test_a_first_rest_is_published_at_two_windows_or_at_once_after_power_on(
    axis, windows, counts, source, state, published
):
    s, c = axis.s, axis.c
    rested(axis, 4, windows)
    s[STATE.STILLNESS], s[STATE.COUNTS], s[STATE.SOURCE + 1] = state, 4 * counts, source
    step.publish_first_rest(s, c, 1)
    assert s[STATE.SOURCE + 1] == published
    if published == 1:
        assert s[STATE.TARGET_Q8 + 1] == s[STATE.OUT_Q8 + 1] == 7 * 256
        hidden = recent.hidden_q4(s, c, 1) * 16
        assert s[STATE.QUALITY_Q8 + 1] == c[SETTINGS.PROVISIONAL_Q8] + hidden
    else:
        assert s[STATE.TARGET_Q8 + 1] == s[STATE.OUT_Q8 + 1] == s[STATE.QUALITY_Q8 + 1] == 0


# What other sources find


def offered(axis, bias_q8, sigma_q8, source=SOURCE.GRAVITY):
    found = array("i", [0] * 9 + [bias_q8] * 3 + [sigma_q8] * 3)
    axis.s[STATE.OFFERED_SOURCE] = source
    step.publish_offer(axis.s, axis.c, found, 9, axis.axis)
    step.offer(axis.s, axis.c, found, 9, axis.axis)
    at = [STATE.TARGET_Q8, STATE.OUT_Q8, STATE.QUALITY_Q8, STATE.SOURCE]
    return [axis.s[word + axis.axis] for word in at]


def test_what_another_source_found_is_published_until_a_rest_is_learned(axis):
    limit = 32 * axis.c[SETTINGS.MOST_SIGMA_Q6]
    assert offered(axis, 900, limit) == [0, 0, 0, 0]
    assert offered(axis, 900, limit - 1) == [900, 900, limit - 1, SOURCE.GRAVITY]
    assert offered(axis, 800, limit - 1) == [800, 900, limit - 1, SOURCE.GRAVITY]  # it slews there
    motion = SOURCE.IN_MOTION
    assert offered(axis, 700, limit - 1, motion) == [800, 900, limit - 1, SOURCE.GRAVITY]
    assert offered(axis, 700, limit - 2, motion) == [700, 900, limit - 2, motion]
    axis.put(KIND=1)
    assert offered(axis, 600, 5) == [700, 900, limit - 2, motion]


def test_what_another_source_found_is_learned_as_so_many_readings(axis):
    most = axis.c[SETTINGS.MOST_SIGMA_Q6]
    worth = axis.c[SETTINGS.FULL_WEIGHT_Q12]
    for sigma in (0, 1, 20, most - 1, most, most + 1):
        axis.put(WAITING_N=0, WAITING_SUM=0, OFFER=0)
        offered(axis, -51234, 4 * sigma + 3)
        n = min(worth // (sigma * sigma + 1), 256) if sigma <= most else 0
        assert n == axis.WAITING_N and axis.WAITING_SUM == (-51234 // 16 * n // 16 if n else 0)
        assert axis.OFFER == (sigma * sigma // 16 * 8 + SOURCE.GRAVITY if n else 0)
    axis.put(WAITING_N=SEGMENT, WAITING_SUM=7)
    offered(axis, 900, 4)
    assert (axis.WAITING_N, axis.WAITING_SUM) == (SEGMENT, 7)  # a segment waits


def quality_dps(corrector, axis=0):
    return corrector.quality_lsb(axis) / LSB


def first_quality_dps(corrector):
    """One sigma at the very first sample of another power-on."""
    corrector = deepcopy(corrector)
    corrector.power_on()
    play(played_rest(0.01), corrector)
    return quality_dps(corrector)


@pytest.mark.parametrize("spread_dps", [0.0, 0.06])
def test_a_power_on_begins_as_sure_as_this_part_repeats(spread_dps):
    corrector, _ = play(played_rest(60))
    assert first_quality_dps(corrector) == pytest.approx(0.02, rel=0.1)  # that of any part
    for seed in range(1, 11):
        corrector.power_on()
        play(played_rest(30, seed, spread_dps * (-1) ** seed * np.ones(3)), corrector)
    if spread_dps:  # half of the last one's offset is kept, so it is off by one and a half times
        assert 0.06 < first_quality_dps(corrector) < 0.12
    else:
        assert first_quality_dps(corrector) < 0.007


def test_what_a_restarted_program_knew_of_a_chip_under_power_is_as_sure_as_it_was():
    corrector, _ = play(played_rest(30))
    before = quality_dps(corrector)
    corrector.power_on(same=True)
    play(played_rest(0.01), corrector)
    assert quality_dps(corrector) < before + 0.001


def test_a_part_whose_bias_wanders_at_rest_is_less_sure_than_one_with_white_noise_alone():
    frames = played_rest(600, bias_dps=BIAS_DPS)
    white, _ = play(frames)
    halves = np.repeat(np.random.default_rng(1).normal(0, 0.006, (len(frames) // 200, 3)), 200, 0)
    frames[:, 4:] += halves * LSB
    wandering, _ = play(frames)
    for axis in range(2):  # no turn about them stays hidden
        assert quality_dps(white, axis) < 0.005
        assert 0.006 < quality_dps(wandering, axis) < 0.014


def with_flicker_noise(frames, dps):
    noisy = frames.copy()
    noisy[:, 4:] += LSB * flicker(np.random.default_rng(1), len(frames), 0.01, np.full(3, dps))
    return noisy


def without_doubt(frames, corrector=None):
    """The corrector after the frames, told at last that none of it was a turn."""
    corrector, _ = play(frames, corrector)
    for axis in range(3):
        corrector.state[axis_at(corrector.settings, axis) + AXIS.DOUBT_Q4] = 0
    return play(frames[-30:], corrector)[0]


def mean_quality_dps(frames):
    corrector = without_doubt(frames)
    return np.mean([quality_dps(corrector, axis) for axis in range(3)])


def test_a_minute_of_rest_shows_whether_there_is_flicker_noise():
    frames = played_rest(60, bias_dps=BIAS_DPS)
    assert mean_quality_dps(frames) < 0.0038
    assert mean_quality_dps(with_flicker_noise(frames, 0.006)) > 0.0085


def test_rests_of_a_second_too_short_for_two_segments_show_it_as_well():
    parts = [f for n in range(40) for f in (handled(9, n), played_rest(1.1, 99 + n, BIAS_DPS))]
    frames = np.concatenate([played_rest(2.6, bias_dps=BIAS_DPS), *parts])
    assert mean_quality_dps(frames) < 0.007
    assert mean_quality_dps(with_flicker_noise(frames, 0.006)) > 0.0085


@pytest.mark.parametrize(("hz", "octaves"), [(25.0, 6), (100.0, 8), (400.0, 10)])
def test_each_octave_of_flicker_noise_within_a_segment_adds_half_of_what_segments_show(hz, octaves):
    flickering, without = (
        without_doubt(played_rest(4, odr_hz=hz), Corrector(Sensor(odr_hz=hz), floor_dps=floor))
        for floor in (0.02, 0.0)
    )
    added = quality_dps(flickering) ** 2 - quality_dps(without) ** 2
    assert 0.02**2 * octaves / 2 < added < 0.02**2 * (octaves / 2 + 1)


def test_a_bias_that_insisted_may_be_a_turn_until_a_rest_of_ten_minutes_shows_none():
    corrector, _ = play(turning(0, 30, axis=2))
    play(turning(1, 120, axis=2, seed=2), corrector)
    assert corrector.bias_lsb(2) == pytest.approx(1.2 * LSB, abs=2)
    assert quality_dps(corrector, 2) > 0.5  # all of the turn is within two sigma
    play(turning(1, 600, axis=2, seed=3), corrector)
    assert quality_dps(corrector, 2) < 0.02


def posed(axis, seconds, seed):
    """A played_rest with that axis up."""
    frames = played_rest(seconds, seed, BIAS_DPS)
    frames[:, [axis, 2]] = frames[:, [2, axis]]
    return frames


def test_a_cold_part_is_unsure_along_gravity_until_it_has_rested_in_two_poses():
    corrector, _ = play(played_rest(5, bias_dps=BIAS_DPS))
    assert quality_dps(corrector, 2) > 0.9 > 0.06 > quality_dps(corrector, 0)
    play(np.concatenate([handled(4, 1), posed(0, 30, 2)]), corrector)
    assert quality_dps(corrector, 2) < 0.02


def test_a_rest_that_agrees_after_a_power_off_was_no_turn():
    corrector, _ = play(played_rest(60, bias_dps=BIAS_DPS))
    corrector.power_on()
    play(played_rest(10, 2, BIAS_DPS), corrector)
    assert quality_dps(corrector, 2) < 0.02
