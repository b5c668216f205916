"""Coefficients that learn on the board: a second unit of the part, whose effects differ."""

from array import array
from pathlib import Path

import numpy as np
import pytest
from zerorate.effects import effect_refine, effects
from zerorate_tools.layout import EFFECTS, SLOT, STATE, slot_at
from zerorate_tools.model import Slot, build_model, encoded
from zerorate_tools.model.term import Term, evaluate

from .checked import Words
from .simulated_sources import SCALES, columns, loaded, tick_means

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
            state, frame = array("i", [0] * STATE.FIT_WEIGHTS), array("i", [0] * 7)
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


def test_bytecode_refines_as_cpython_does(micropython, repository):
    result = micropython.run(
        Path(__file__).parent / "on_micropython" / "parts_without_heap.py",
        ["refinement"],
        modules=[repository / "firmware"],
        files_in={"model.bin": encoded(build_model(TWO, SCALES))},
        files_out=["out.bin"],
        check=True,
    )
    model = loaded(TWO)
    model.refine()
    e, state = model.e, array("i", [0] * STATE.FIT_WEIGHTS)
    for n in range(120):
        for slot in range(2):
            value = (n * (slot + 3) * 7919 >> 2) % 40001 * 400 - 8000000
            e[slot_at(slot) + SLOT.SLOT_VALUE] = value
        for axis in range(3):
            state[STATE.SEGMENT_TOTAL + axis] = n * (axis + 5) * 104729 % 60013 - 20000
        state[STATE.TEMP] = n * 31 - 2000
        effect_refine.observe(state, e, 64)
        while e[EFFECTS.REFINE_WORK]:
            effect_refine.refine(e)
    assert list(e[slot_at(0) + NOW :][:3]) != list(e[slot_at(0) + OWN :][:3])
    np.testing.assert_array_equal(np.frombuffer(result.files["out.bin"], "<i4"), e)
