"""Coefficients that learn on the board: a second unit of the part, whose effects differ."""

from array import array
from pathlib import Path

import numpy as np
import pytest
from zerorate.effects import effect_inputs, effect_refine, effects
from zerorate_tools.layout import EFFECTS, INPUT, INPUT_KIND, SLOT, STATE, slot_at
from zerorate_tools.model import Slot, build_model, encoded
from zerorate_tools.model.term import Term, evaluate

from .checked import Words
from .simulated_sources import SCALES, columns, loaded, tick_means
from .test_effect_kernels import FRAME, MOST, NO_VALUE, inputs

LAG = Term("temp", 5.0, 60.0, 30.0, lag_mode="difference", lag_s=640.0)
SUPPLY = Term("vdd_mv", 4900.0, 5100.0, 5000.0)
MODEL = ((0.02, -0.01, 0.004), (0.0008, 0.0004, -0.0002))
TWO = [Slot(LAG, MODEL[0]), Slot(SUPPLY, MODEL[1])]
SEGMENT = 4  # samples: two ticks
LSB = 131
EFFECT = STATE.EFFECT_Q8
OWN, NOW = SLOT.SLOT_OWN, SLOT.SLOT_COEFFICIENT


class Unit:
    """A device whose coefficients are `share` times the model's, with its own line and offset."""

    def __init__(self, model, share, seed=3, noise_dps=0.003):
        self.model, self.noise_dps = model, noise_dps
        self.rng = np.random.default_rng(seed)
        self.raw = columns(seed)
        sources = tick_means(self.raw)
        bases = [evaluate(term, sources, 1.0) for term in (LAG, SUPPLY)]
        own = np.array(MODEL) * share
        self.effect = np.column_stack(bases) @ own
        self.bias = 1.3 + 0.02 * (sources("temp")[:, None] - 25) * np.array([1, -1, 0.5])

    def live(self, hours_again=1):
        """Segments of stillness, each learned from; returns what of the effects was left, dps."""
        left = []
        for _ in range(hours_again):
            state, frame = array("i", [0] * STATE.FIT_SUM_T), array("i", [0] * 7)
            self.model.power_on()
            for n in range(0, len(self.raw["temp"]), SEGMENT):
                left.append(self._segment(n, state, frame))
        return np.array(left)

    def _segment(self, n, state, frame):
        total = np.zeros(3)
        for k in range(n, n + SEGMENT):
            frame[:] = array(
                "i", [int(self.raw[c][k]) for c in ("ax", "ay", "az", "temp")] + [0] * 3
            )
            self.model.channel("vdd_mv", int(self.raw["vdd_mv"][k]))
            effects.sense(state, self.model.e, frame, 500000, 1)
            total += self.effect[k // 2] - np.array(state[EFFECT : EFFECT + 3]) / 256 / LSB
        noise = self.rng.normal(0, self.noise_dps, 3)
        rate = total / SEGMENT + self.bias[n // 2] + noise
        for axis in range(3):
            state[STATE.SEGMENT_TOTAL + axis] = round(float(rate[axis]) * LSB * 64)
        state[STATE.TEMP] = int(self.raw["temp"][n])
        effect_refine.observe(state, self.model.e, 64)
        while self.model.e[EFFECTS.REFINE_WORK]:
            effect_refine.refine(self.model.e)
        return total / SEGMENT


@pytest.fixture
def model():
    found = loaded(TWO)
    found.refine()
    return found


def spread(left):
    """Deviation of what was left from its mean: the offset is the estimators' work."""
    return left.std(axis=0)


def test_a_unit_like_the_model_is_not_made_worse_by_as_much_as_a_floor_of_3_mdps(model):
    left = Unit(model, share=1.0).live(2)
    half = len(left) // 2
    assert spread(left).max() < 0.003
    assert spread(left[half:]).max() < 0.002


def test_no_coefficient_leaves_its_bound(model):
    Unit(model, share=4.0).live()
    for slot in range(2):
        a = slot_at(slot)
        own, now = (np.array(model.e[a + at :][:3]) for at in (OWN, NOW))
        assert np.abs(now - own).max() <= np.abs(own).max() / 2
        assert np.abs(now - own).max() > np.abs(own).max() / 3


def test_refinement_is_off_until_it_is_asked_for():
    model = loaded(TWO)
    before = list(model.e[slot_at(0) + NOW :][:9])
    unit = Unit(model, share=2.0)
    unit.raw = {name: values[:2000] for name, values in unit.raw.items()}
    unit.live()
    assert list(model.e[slot_at(0) + NOW :][:9]) == before


def test_no_intermediate_leaves_31_bits(model):
    e = Words(model.e)
    for n in range(400):
        for slot in range(2):
            e[slot_at(slot) + SLOT.SLOT_VALUE] = [1 << 25, -(1 << 25), 0][n // 5 % 3]
        state = Words([0] * STATE.FIT_WEIGHTS)
        for axis in range(3):
            state[STATE.SEGMENT_TOTAL + axis] = [(1 << 29), -(1 << 29), 77][(n // 7 + axis) % 3]
        state[STATE.TEMP] = [32767, -32768][n // 3 % 2]
        effect_refine.observe(state, e, 1 if n % 2 else 512)
        while e[EFFECTS.REFINE_WORK]:
            effect_refine.refine(e)
    assert e[EFFECTS.SEEN] == 400


@pytest.fixture(scope="module")
def on_interpreter(repository):
    def run(runtime):
        result = runtime.run(
            Path(__file__).parent / "on_micropython" / "refine_without_heap.py",
            modules=[repository / "firmware"],
            files_in={"model.bin": encoded(build_model(TWO, SCALES))},
            files_out=["out.bin"],
            check=True,
        )
        return np.frombuffer(result.files["out.bin"], "<i4")

    return run


@pytest.fixture(scope="module")
def on_host():
    model = loaded(TWO)
    model.refine()
    e, state = model.e, array("i", [0] * STATE.FIT_WEIGHTS)
    for n in range(120):
        for slot in range(2):
            e[slot_at(slot) + SLOT.SLOT_VALUE] = (
                n * (slot + 3) * 7919 >> 2
            ) % 40001 * 400 - 8000000
        for axis in range(3):
            state[STATE.SEGMENT_TOTAL + axis] = n * (axis + 5) * 104729 % 60013 - 20000
        state[STATE.TEMP] = n * 31 - 2000
        effect_refine.observe(state, e, 64)
        while e[EFFECTS.REFINE_WORK]:
            effect_refine.refine(e)
    assert list(e[slot_at(0) + NOW :][:3]) != list(e[slot_at(0) + OWN :][:3])
    return np.array(e)


def test_bytecode_refines_as_cpython_does(micropython, on_interpreter, on_host):
    np.testing.assert_array_equal(on_interpreter(micropython), on_host)


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
