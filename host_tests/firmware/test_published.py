"""What is published of one axis, beside floats; and what other sources find, until a rest does."""

import math
from array import array

import pytest
from zerorate.rest import recent, step
from zerorate_tools.layout import SETTINGS, SOURCE, STATE, STILLNESS

from .test_offsets import SEGMENT, Axis


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
