"""Each kernel of the effects by hand: exact numbers, at every limit and one beside it."""

import random
from array import array

import pytest
from zerorate.effects import effect_basis, effect_plays, effects
from zerorate.model import EffectModel
from zerorate_tools.layout import (
    EFFECTS,
    INPUT,
    INPUT_KIND,
    LIMITS,
    MARKS,
    PLAY,
    SLOT,
    STATE,
    slot_at,
)

ONE = 1 << 24
NO_VALUE = MARKS.NO_VALUE
MOST = 0x1FFFFFFF
FRAME = array("i", [-5, 7, 16384, -900, 131, -262, 393])


@pytest.fixture
def e():
    return array("i", [0] * EFFECTS.size)


def inputs(e, *kinds):
    """Inputs of these kinds; where each begins."""
    e[EFFECTS.INPUT_COUNT] = len(kinds)
    places = [EFFECTS.INPUTS + INPUT.size * i for i in range(len(kinds))]
    for a, kind in zip(places, kinds):
        e[a + INPUT.INPUT_KIND] = kind
    return places


TICK = dict.fromkeys(("TICK_ELAPSED_US", "TICKS_DUE"), 0) | {"RUNNING": 1, "HALF_TICKS": 1}


@pytest.mark.parametrize("before, dt_us, after", [
    ({"RUNNING": 0}, 5000, {"RUNNING": 1}),
    ({}, 0, {}), ({}, -1, {}), ({}, 1, {"TICK_ELAPSED_US": 1}),
    ({}, 999, {"TICK_ELAPSED_US": 999}), ({}, 1000, {"TICKS_DUE": 1}),
    ({"TICK_ELAPSED_US": 400}, 599, {"TICK_ELAPSED_US": 999}),
    ({"TICK_ELAPSED_US": 400}, 601, {"TICK_ELAPSED_US": 1, "TICKS_DUE": 1}),
    ({"TICKS_DUE": 2}, 3500, {"TICK_ELAPSED_US": 500, "TICKS_DUE": 5}),
    ({}, 4_096_000, {"TICKS_DUE": 4096}),
    ({}, 4_097_000, {"TICKS_DUE": 4096, "HALF_TICKS": 3}),
    ({"TICKS_DUE": 4000}, 200_001, {"TICKS_DUE": 4096, "TICK_ELAPSED_US": 1, "HALF_TICKS": 209}),
])  # fmt: skip
def test_time_passes_by_whole_ticks_and_no_more_wait_than_4096(e, before, dt_us, after):
    e[EFFECTS.TICK_US] = 1000
    [a] = inputs(e, INPUT_KIND.KIND_TEMP)
    e[a + INPUT.INPUT_SUM], e[a + INPUT.INPUT_N] = 10, 2
    for name, value in (TICK | before).items():
        e[getattr(EFFECTS, name)] = value
    effects.pass_time(e, dt_us)
    assert {name: e[getattr(EFFECTS, name)] for name in TICK} == TICK | before | after
    ended = "TICKS_DUE" in after
    assert e[a + INPUT.INPUT_VALUE_Q8] == (5 * 256 if ended else 0)


def test_the_early_tick_is_forgotten_by_every_slot_and_play_operator(e):
    e[EFFECTS.SLOT_COUNT], e[EFFECTS.PLAY_COUNT] = 3, 2
    slots = [slot_at(i) + SLOT.SLOT_STARTED for i in range(4)]
    plays = [EFFECTS.PLAYS + PLAY.size * i + PLAY.PLAY_STARTED for i in range(3)]
    for i in range(EFFECTS.size):
        if i not in (EFFECTS.SLOT_COUNT, EFFECTS.PLAY_COUNT):
            e[i] = 9
    effects.begin_again(e)
    changed = {i: e[i] for i in range(EFFECTS.size) if e[i] != 9}
    wanted = dict.fromkeys([*slots[:3], *plays[:2]], 0)
    wanted |= {EFFECTS.RUNNING: 3, EFFECTS.HALF_TICKS: 1}
    assert changed == wanted | {EFFECTS.SLOT_COUNT: 3, EFFECTS.PLAY_COUNT: 2}


def a_slot(e, slot=0, value_q8=0, **words):
    """A slot that follows word 25 as it is; where it begins."""
    a, source = slot_at(slot), EFFECTS.CHANNELS
    e[source] = value_q8
    usual = {"SOURCE": source, "LOWEST_Q8": -MOST, "HIGHEST_Q8": MOST, "POWER": 1}
    usual |= {"KNOT": NO_VALUE, "COEFFICIENT_SHIFT": 24}
    for name, value in (usual | words).items():
        e[a + getattr(SLOT, "SLOT_" + name)] = value
    return a


@pytest.mark.parametrize("value_q8, wanted", [
    (999, -500), (1000, -500), (1001, -499), (1500, 0), (1999, 499), (2000, 500), (2001, 500),
    (NO_VALUE, None),
])  # fmt: skip
@pytest.mark.parametrize("shift", [-3, -1, 0, 1, 5])
def test_a_source_is_held_within_its_range_and_centred(e, value_q8, wanted, shift):
    a = a_slot(e, 1, value_q8, LOWEST_Q8=1000, HIGHEST_Q8=2000, CENTRE_Q8=1500, SHIFT=shift)
    if wanted is not None:
        wanted = wanted << shift if shift >= 0 else wanted >> -shift
    assert effect_basis.centred(e, a) == (NO_VALUE if wanted is None else wanted)


@pytest.mark.parametrize("v, n, wanted", [
    (ONE // 2, 1, ONE // 2), (ONE // 2, 2, ONE // 4), (ONE // 2, 3, ONE // 8),
    (-ONE // 2, 2, ONE // 4), (-ONE // 2, 3, -ONE // 8), (ONE, 3, ONE), (-ONE, 3, -ONE), (0, 2, 0),
])  # fmt: skip
def test_powers(v, n, wanted):
    assert effect_basis.power(v, n) == wanted


@pytest.mark.parametrize("way", [1, 777, 16384, 32768])
@pytest.mark.parametrize("halvings", [0, 1, 5, 13])
@pytest.mark.parametrize("u", [0, 1, -1, 4095, 4096, ONE, -ONE, 12345678, -7654321])
def test_a_lag_goes_its_share_of_the_way_and_loses_nothing(way, halvings, u):
    e, bits = array("i", [99, 5000, 0, way, halvings, 99]), 15 + halvings
    for _ in range(3):
        whole = (e[1] << bits) + e[2] + (u - e[1]) * way
        effect_basis.approach(e, 1, 3, u)
        assert ((e[1] << bits) + e[2], e[2] >> bits) == (whole, 0)
    assert (list(e[3:]), e[0]) == ([way, halvings, 99], 99)


def test_a_table_is_read_at_and_between_its_nine_points_and_held_at_its_ends(e):
    points = [100 * ONE // 128, 0, -ONE // 2, ONE, ONE, 5, -ONE, 1 << 20, 7 << 20]
    table = EFFECTS.size - 9
    e[table:] = array("i", points)
    words = {"TABLE": table, "TABLE_FIRST": -ONE, "TABLE_SCALE": 1 << 26}
    a = a_slot(e, **words)
    e[a + SLOT.SLOT_TABLE_SCALE + 1] = 24  # a step of the table is a fourth of one
    step = ONE // 4
    for n, point in enumerate(points):
        assert effect_basis.looked_up(e, a, -ONE + n * step) == point
        if n < 8:
            between = effect_basis.looked_up(e, a, -ONE + n * step + step // 4)
            assert abs(between - (3 * point + points[n + 1]) / 4) <= 1
    assert effect_basis.looked_up(e, a, -ONE - 1) == points[0]
    assert (
        effect_basis.looked_up(e, a, ONE + 1) == effect_basis.looked_up(e, a, 2 * ONE) == points[8]
    )


@pytest.mark.parametrize(
    "step, delay", [(1, 0), (1, 1), (1, 63), (2, 5), (4, 60), (4, 252), (7, 20)]
)
def test_a_delay_is_of_so_many_ticks_to_a_straight_line(e, step, delay):
    ring = EFFECTS.size - 80
    a = a_slot(e, RING=ring, DELAY=delay, RING_STEP=step)
    e[ring - 1] = e[ring + 66] = 4321
    line = [(1 << 20) + 4096 * step * tick * (1 if tick < 400 else -1) for tick in range(500)]
    for tick, u in enumerate(line[:400]):
        got = effect_basis.delayed(e, a, u)
        e[a + SLOT.SLOT_STARTED] = 1
        assert got == line[max(0, tick - delay)], tick
    assert (e[ring - 1], e[ring + 66]) == (4321, 4321)


@pytest.mark.parametrize("v", [ONE, -ONE, ONE // 2])
def test_a_value_is_added_by_its_coefficients_to_three_sums_held_within_31_bits(e, v):
    a = a_slot(e, COEFFICIENT=1000, VALUE=v)
    e[a + SLOT.SLOT_COEFFICIENT + 1], e[a + SLOT.SLOT_COEFFICIENT + 2] = -3000, 0
    to = EFFECTS.SUM_Q14
    for before in (0, 17, MOST - 1000, MOST - 999, -MOST + 1000, -MOST + 999, MOST, -MOST):
        e[to - 1 : to + 4] = array("i", [3, before, before, before, 3])
        effect_basis.contribute(e, a, to)
        added = [c * v // ONE for c in (1000, -3000, 0)]
        held = [max(-MOST, min(MOST, before + d)) for d in added]
        assert list(e[to - 1 : to + 4]) == [3, *held, 3]


@pytest.mark.parametrize("started, state, value, now", [
    (0, 5000, 100, 100), (1, 0, 100, 90), (1, 0, 10, 0), (1, 0, 11, 1), (1, 0, -10, 0),
    (1, 0, -11, -1), (1, 0, -100, -90), (1, 95, 100, 95), (1, 90, 100, 90), (1, 111, 100, 110),
])  # fmt: skip
def test_a_play_operator_is_drawn_its_radius_behind(e, started, state, value, now):
    a = EFFECTS.PLAYS + PLAY.size
    e[a], e[EFFECTS.CHANNELS] = EFFECTS.CHANNELS, value
    e[a + SLOT.SLOT_LOWEST_Q8], e[a + SLOT.SLOT_HIGHEST_Q8] = -1000, 1000
    words = {"RADIUS": 10 << 14, "SHIFT": 24, "STARTED": started, "STATE": state << 14}
    for name, word in (words | {"COEFFICIENT": ONE, "OF_SQUARE": ONE}).items():
        e[a + getattr(PLAY, "PLAY_" + name)] = word
    e[a + SLOT.SLOT_SHIFT] = 14
    effect_plays.play(e, a)
    p = now << 14
    assert (e[a + PLAY.PLAY_STARTED], e[a + PLAY.PLAY_STATE]) == (1, p)
    assert list(e[EFFECTS.SUM_Q14 : EFFECTS.SUM_Q14 + 3]) == [p + p * p // ONE, 0, 0]
    e[EFFECTS.CHANNELS] = NO_VALUE
    effect_plays.play(e, a)
    assert (e[a + PLAY.PLAY_STATE], e[EFFECTS.SUM_Q14]) == (p, p + p * p // ONE)


def test_a_power_on_begins_every_word_of_the_run_and_leaves_the_model(e):
    model = EffectModel()
    e = model.e
    for i in range(EFFECTS.size):
        e[i] = 7
    e[EFFECTS.INPUT_COUNT], e[EFFECTS.PLAY_COUNT], e[EFFECTS.REFINE_ON] = 2, 2, 0
    e[EFFECTS.INPUTS + INPUT.INPUT_KIND] = INPUT_KIND.KIND_ONE
    before = array("i", e)
    model.power_on()
    wanted = dict.fromkeys(
        getattr(EFFECTS, name)
        for name in ("TICK_ELAPSED_US", "TICKS_DUE", "NEXT_SLOT", "RUNNING", "SLOW_BEGUN")
    )
    wanted |= dict.fromkeys([EFFECTS.SQUARES, EFFECTS.SQUARES + 1])
    for axis in range(3):
        wanted |= dict.fromkeys([EFFECTS.SUM_Q14 + axis, EFFECTS.HELD_Q14 + axis])
    wanted = dict.fromkeys(wanted, 0) | {EFFECTS.HALF_TICKS: 1}
    for number, value in enumerate((256, NO_VALUE)):
        a = EFFECTS.INPUTS + INPUT.size * number
        wanted |= {a + INPUT.INPUT_SUM: 0, a + INPUT.INPUT_N: 0, a + INPUT.INPUT_VALUE_Q8: value}
    wanted |= dict.fromkeys(range(EFFECTS.CHANNELS, EFFECTS.CHANNELS + 8), NO_VALUE)
    for slot in range(LIMITS.MOST_SLOTS):
        wanted |= dict.fromkeys(
            [slot_at(slot) + w for w in (SLOT.SLOT_STARTED, SLOT.SLOT_VALUE)], 0
        )
    wanted |= {EFFECTS.PLAYS + PLAY.size * i + PLAY.PLAY_STARTED: 0 for i in range(2)}
    assert {i: e[i] for i in range(EFFECTS.size) if e[i] != before[i]} == wanted


@pytest.mark.parametrize(
    "bound, eighths", [(0, 0), (0.05, 0), (0.0625, 1), (0.5, 4), (0.55, 4), (1, 8)]
)
def test_coefficients_refine_within_eighths_from_the_model_s_own(e, bound, eighths):
    model = EffectModel()
    e = model.e
    e[EFFECTS.SLOT_COUNT] = 2
    for slot in range(3):
        for axis in range(3):
            e[slot_at(slot) + SLOT.SLOT_OWN + axis] = 10 * slot + axis + 1
    model.refine(bound)
    assert (e[EFFECTS.BOUND_EIGHTHS], e[EFFECTS.REFINE_ON]) == (eighths, int(eighths > 0))
    assert (model.attend is not None) == (eighths > 0)
    first = [slot_at(slot) + SLOT.SLOT_COEFFICIENT for slot in range(3)]
    assert [list(e[a : a + 3]) for a in first] == [[1, 2, 3], [11, 12, 13], [0, 0, 0]]
    for wrong in (-0.001, 1.001):
        with pytest.raises(ValueError, match=r"bound is 0\.\.1"):
            model.refine(wrong)


def test_a_channel_is_named_or_numbered():
    model = EffectModel()
    model.channels = ("vdd_mv", "load")
    told = [model.channel(name, 5 + i) for i, name in enumerate(("load", 0, "vdd", 2, -1))]
    assert told == [True, True, False, False, False]
    assert list(model.e[EFFECTS.CHANNELS : EFFECTS.CHANNELS + 3]) == [6, 5, 0]


def test_what_other_sources_sense_is_the_frame_less_the_effects_with_nothing_lost(e):
    draw, s, due = random.Random(1), array("i", [0] * STATE.FIT_WEIGHTS), [0, 0, 0]
    for _ in range(100):
        frame = array("i", [draw.randrange(-32768, 32768) for _ in range(7)])
        for i in range(3):
            s[STATE.EFFECT_Q8 + i] = draw.randrange(-(1 << 20), 1 << 20)
            due[i] += 256 * frame[4 + i] - s[STATE.EFFECT_Q8 + i]
        effects.lessen(s, e, frame)
        sensed = e[EFFECTS.SENSED : EFFECTS.SENSED + 7]
        rounded = [(d + 128) // 256 for d in due]
        assert list(sensed) == [*frame[:4], *(max(-0x7FFF, min(d, 0x7FFF)) for d in rounded)]
        due = [d - 256 * r for d, r in zip(due, rounded)]
