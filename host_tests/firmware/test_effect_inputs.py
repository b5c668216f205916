"""Each kernel of the inputs by hand: time, channels, means and vibration, exact at every limit."""

from array import array

import pytest
from zerorate.effects import effect_inputs
from zerorate_tools.layout import EFFECTS, INPUT, INPUT_KIND

from .test_effect_kernels import FRAME, MOST, NO_VALUE, inputs


@pytest.fixture
def e():
    return array("i", [0] * EFFECTS.size)


@pytest.mark.parametrize("shift", range(16))
@pytest.mark.parametrize("half_ticks", [1, 255, 32767, 32768, (1 << 23) - 1, 1 << 23, 0x1FFFF000])
def test_time_is_half_ticks_in_q8_after_the_shift_and_held_at_16_bits(e, shift, half_ticks):
    before, a, behind = inputs(e, INPUT_KIND.KIND_ONE, INPUT_KIND.KIND_TIME, INPUT_KIND.KIND_TEMP)
    e[EFFECTS.HALF_TICKS], e[a + INPUT.INPUT_SHIFT] = half_ticks, shift
    effect_inputs.tell_time(e)
    wanted = 0x7FFFFF if half_ticks >> shift > 32767 else half_ticks * 256 >> shift
    values = [e[place + INPUT.INPUT_VALUE_Q8] for place in (before, a, behind)]
    assert values == [0, wanted, 0]


@pytest.mark.parametrize("shift", [-8, -7, -1, 0, 1, 15])
@pytest.mark.parametrize("offset", [0, 100000, -3])
def test_a_channel_is_16_bits_after_its_offset_and_shift(e, shift, offset):
    _, a = inputs(e, INPUT_KIND.KIND_CHANNEL, INPUT_KIND.KIND_CHANNEL + 3)
    e[a + INPUT.INPUT_SHIFT], e[a + INPUT.INPUT_OFFSET] = shift, offset
    said = EFFECTS.CHANNELS + 3
    e[said] = NO_VALUE
    assert effect_inputs.extra(e, a) == NO_VALUE
    edge = (32768 << max(shift, 0)) >> max(-shift, 0)
    near = [offset + sign * edge + by for sign in (1, -1) for by in (-2, -1, 0, 1, 2)]
    for value in {0, 1, 32767, MOST - 1, MOST, MOST + 1, -MOST, -MOST - 1, *near} - {NO_VALUE}:
        e[said] = value
        held = max(-MOST, min(MOST, value)) - offset
        if shift >= 0:
            wanted = max(-32768, min(32767, held >> shift))
        else:
            wanted = max(-(32768 >> -shift), min(32767 >> -shift, held)) << -shift
        assert effect_inputs.extra(e, a) == wanted


@pytest.mark.parametrize("n", [1, 2, 3, 7, 100, 16383])
def test_a_mean_is_rounded_away_from_zero_by_half(n):
    for total in (0, 1, 2, 3, 50, 32767, 32767 * n, 5 * n + n // 2, 123456):
        wanted = (256 * total + n // 2) // n
        assert effect_inputs.mean_q8(total, n) == wanted
        assert effect_inputs.mean_q8(-total, n) == -wanted


@pytest.mark.parametrize("shift", [0, 1, 7, 8, 9, 15])
@pytest.mark.parametrize("n", [1, 3, 1000, 16383])
def test_a_mean_of_squares_is_exact_held_and_begins_anew(e, shift, n):
    edge = (32768 << shift) * n
    for total in (0, 1, 12345, 70000 * n + n - 1, edge - 1, edge, 3 * edge):
        if total >> 15 >= 1 << 29:
            continue
        e[EFFECTS.SQUARES], e[EFFECTS.SQUARES + 1] = total & 0x7FFF, total >> 15
        mean, rest = divmod(total, n)
        wanted = mean * 256 >> shift
        if shift < 8:
            wanted = (mean << 8 - shift) + (rest * 256 // n >> shift)
        if mean >> shift > 32767:
            wanted = 0x7FFFFF
        assert effect_inputs.mean_square_q8(e, n, shift) == wanted
        assert list(e[EFFECTS.SQUARES : EFFECTS.SQUARES + 2]) == [0, 0]


def test_vibration_is_what_is_off_the_slow_part_of_each_axis(e):
    slow, total = None, 0
    rest = [100, -200, 16384, 0, 0, 0, 0]
    pushes = [[0, 0, 0], [9, 0, 0], [0, -9, 0], [0, 0, 9], [19600, 0, 0], [0, -19600, 0]]
    pushes += [[0, 0, edge] for edge in (19510, -19510, 19515, -19515, 18900, 40000, -40000)]
    for push in pushes:
        x = array("i", [r + p for r, p in zip(rest, [*push, 0, 0, 0, 0])])
        effect_inputs.shake(e, x)
        slow = slow or [256 * v for v in x[:3]]
        for axis in range(3):
            slow[axis] += (256 * x[axis] - slow[axis] + 16) >> 5
            off = (256 * x[axis] - slow[axis] + 128) >> 8
            total += min(18900, abs(off)) ** 2
        assert list(e[EFFECTS.SLOW_Q8 : EFFECTS.SLOW_Q8 + 3]) == slow
        assert e[EFFECTS.SQUARES] + (e[EFFECTS.SQUARES + 1] << 15) == total
        assert e[EFFECTS.SLOW_BEGUN] == 1


def test_every_kind_of_input_takes_its_own_word(e):
    kinds = [0, 3, 4, 6, INPUT_KIND.KIND_TIME, INPUT_KIND.KIND_ONE, 10, 11, 12, 13, 14, 15]
    places = inputs(e, *kinds)
    behind = EFFECTS.INPUTS + INPUT.size * len(kinds)
    for _ in range(2):
        effect_inputs.accumulate(e, FRAME)
    read = [(e[a + INPUT.INPUT_SUM], e[a + INPUT.INPUT_N]) for a in places]
    assert read == [(2 * v, 2) for v in (-5, -900, 131, 393)] + [(0, 0)] * 8
    instant = [e[a + INPUT.INPUT_VALUE_Q8] for a in places]
    assert instant == [0] * 6 + [256 * v for v in (131, -262, 393, -5, 7, 16384)]
    assert not any(e[behind : EFFECTS.CHANNELS])
    effect_inputs.close_tick(e)
    means = [e[a + INPUT.INPUT_VALUE_Q8] for a in places]
    assert means == [256 * v for v in (-5, -900, 131, 393)] + [0, 0] + instant[6:]
    assert not any(e[a + INPUT.INPUT_SUM] or e[a + INPUT.INPUT_N] for a in places)
    effect_inputs.close_tick(e)  # without samples they stay
    assert [e[a + INPUT.INPUT_VALUE_Q8] for a in places] == means


@pytest.mark.parametrize("n, taken", [(16381, True), (16382, True), (16383, False)])
def test_a_tick_takes_16383_samples(e, n, taken):
    [a] = inputs(e, INPUT_KIND.KIND_TEMP)
    e[a + INPUT.INPUT_N] = n
    effect_inputs.accumulate(e, FRAME)
    assert (e[a + INPUT.INPUT_N], e[a + INPUT.INPUT_SUM]) == ((n + 1, -900) if taken else (n, 0))


def test_vibration_and_a_channel_that_is_given_are_counted_too(e):
    shaken, given, none = inputs(e, INPUT_KIND.KIND_VIBRATION, *[INPUT_KIND.KIND_CHANNEL] * 2)
    e[none + INPUT.INPUT_KIND] += 1
    e[EFFECTS.CHANNELS], e[EFFECTS.CHANNELS + 1] = 77, NO_VALUE
    for push in (0, 100):
        effect_inputs.accumulate(e, array("i", [push, *FRAME[1:]]))
    read = [(e[a + INPUT.INPUT_SUM], e[a + INPUT.INPUT_N]) for a in (shaken, given, none)]
    assert read == [(0, 2), (154, 2), (0, 0)]
    effect_inputs.close_tick(e)
    assert e[shaken + INPUT.INPUT_VALUE_Q8] == 256 * 97**2 // 2
