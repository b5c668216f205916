"""What effect slots do sample by sample: plays, tables, delays, gaps, channels, power-ons."""

from array import array
from dataclasses import replace

import numpy as np
import pytest
from zerorate import Sensor
from zerorate.effects import effects
from zerorate.effects.model_file import LOADED
from zerorate.model import EffectModel
from zerorate_tools.layout import EFFECTS, SLOT, STATE, slot_at
from zerorate_tools.model import Slot, build_model, encoded
from zerorate_tools.model.term import Term, evaluate

from .simulated_sources import (
    A_TICK,
    EVERY_SLOT,
    SCALES,
    columns,
    loaded,
    on_firmware,
)
from .test_effects import TENTH_OF_THE_FLOOR_DPS

PLAYS = [
    Slot(Term("temp", 5.0, 45.0, 25.0, power, memory="play", width=width), coefficients)
    for width, power, coefficients in (
        (0.5, 1, (0.01, -0.02, 0.0)),
        (0.5, 2, (0.0005, 0.0001, 0.001)),
        (6.0, 1, (0.02, 0.01, -0.02)),
        (20.0, 2, (0.0, 0.001, -0.0005)),
    )
]


def test_play_operators_and_their_squares_are_those_of_the_reference(warm_up):
    raw, sources = warm_up
    square = Slot(Term("temp", 5.0, 45.0, 25.0, power=2), (0.001, 0.0, -0.001))
    model = loaded([*PLAYS, square])
    got = on_firmware(model, raw)[A_TICK - 1 :: A_TICK][1:]
    wanted = sum(
        np.outer(evaluate(s.term, sources, 1.0), s.coefficient_dps) for s in [*PLAYS, square]
    )
    assert np.abs(got - wanted[:-1]).max() < TENTH_OF_THE_FLOOR_DPS
    model.power_on()
    assert (on_firmware(model, raw)[A_TICK - 1 :: A_TICK][1:] == got).all()


def radio(n=400):
    """Raw rows at rest whose supply drops by 60 mV for each sample at which a radio sends."""
    raw = {name: np.zeros(n, int) for name in ("ax", "ay", "az", "temp", "gx", "gy", "gz")}
    return raw | {"vdd_mv": 5000 - 60 * (np.random.default_rng(1).random(n) < 0.3)}


SUPPLY = Term("vdd_mv", 4930.0, 5050.0, 5000.0)


def test_a_channel_acts_at_the_pace_at_which_it_is_set():
    raw = radio()
    slots = [Slot(SUPPLY, (0.001, 0.0, -0.002)), Slot(replace(SUPPLY, power=2), (0.0, 1e-5, 0.0))]
    d = raw["vdd_mv"] - 5000
    wanted = np.column_stack([0.001 * d, 1e-5 * d**2, -0.002 * d])
    assert np.abs(on_firmware(loaded(slots), raw) - wanted).max() < 5e-5


def test_what_remembers_the_channel_has_its_means_of_a_tick_beside_it():
    raw, late = radio(), Slot(replace(SUPPLY, lag_mode="lag", lag_s=60.0), (0.0, 0.002, 0.0))
    both = loaded([Slot(SUPPLY, (0.001, 0.0, 0.0)), late])
    assert both.channels == ("vdd_mv",)
    got = on_firmware(both, raw)
    assert (got[:, 0] == on_firmware(loaded([Slot(SUPPLY, (0.001, 0.0, 0.0))]), raw)[:, 0]).all()
    assert (got[:, 1] == on_firmware(loaded([late]), raw)[:, 1]).all()


def test_a_model_of_before_follows_its_channel_once_a_tick():
    model = build_model([Slot(SUPPLY, (0.001, 0.0, 0.0))], SCALES)
    old = replace(model, inputs=(replace(model.inputs[0], of_the_sample=False),))
    effect_model = EffectModel()
    assert effect_model.load(encoded(old), Sensor(2.0)) == LOADED
    raw = radio()
    got, by_tick = on_firmware(effect_model, raw), (raw["vdd_mv"] - 5000).reshape(-1, A_TICK)
    # a tick's mean is used in the tick behind it
    wanted = 0.001 * by_tick.mean(axis=1)[:-1]
    assert np.abs(got[A_TICK - 1 :: A_TICK, 0][1:] - wanted).max() < 5e-5


def test_the_first_sample_speaks_until_the_first_tick_ends():
    slots = [Slot(Term("temp", 0, 60, 20), (0.1, 0, 0)), Slot(Term("time", 0, 100), (0, 0.1, 0))]
    model = loaded(slots, sensor=Sensor(100.0))
    ten_above = still_frame(round((30.0 - 36.53) * 340))
    state = array("i", [0] * STATE.FIT_WEIGHTS)
    for _ in range(3):
        effects.sense(state, model.e, ten_above, 10000, 1)
    assert state[STATE.EFFECT_Q8] / 256 / 131 == pytest.approx(1.0, abs=0.001)
    assert state[STATE.EFFECT_Q8 + 1] / 256 / 131 == pytest.approx(0.1 * 0.5, abs=0.001)


def still_frame(temp=0):
    return array("i", [0, 0, 16384, temp, 0, 0, 0])


def test_a_channel_that_was_never_given_has_no_effect():
    slot = Slot(Term("load", 0.0, 100.0, 50.0), (0.01, 0.0, 0.0))
    state, model = array("i", [0] * STATE.FIT_WEIGHTS), loaded([slot])
    for n in range(60):
        if n == 30:
            assert state[STATE.EFFECT_Q8] == 0
            assert model.channel("load", 90)
        effects.sense(state, model.e, still_frame(), 250000, 1)
    assert state[STATE.EFFECT_Q8] / 256 / 131 == pytest.approx(0.4, abs=1e-4)


def test_frames_that_are_no_readings_let_time_pass_and_nothing_else():
    slots = [Slot(Term("temp", 0.0, 60.0), (0.01, 0, 0)), Slot(Term("time", 0, 100), (0, 0.01, 0))]
    state, model = array("i", [0] * STATE.FIT_WEIGHTS), loaded(slots)
    for n in range(80):
        effects.sense(state, model.e, still_frame(-1 if n >= 40 else 3400), 250000, int(n < 40))
    assert state[STATE.EFFECT_Q8] / 256 / 131 == pytest.approx(0.01 * 46.53, abs=1e-4)
    assert state[STATE.EFFECT_Q8 + 1] / 256 / 131 == pytest.approx(0.01 * 18.5, abs=1e-4)


def test_a_power_on_begins_every_memory_anew(warm_up):
    raw = {name: values[:2000] for name, values in warm_up[0].items()}
    decays = Slot(Term("one", decay_s=100.0), (0.01, -0.02, 0.03))
    model = loaded([decays, *EVERY_SLOT[1:], *PLAYS])
    first = on_firmware(model, raw)
    on_firmware(model, {name: values[:3001] for name, values in columns(seed=5).items()})
    model.power_on()
    assert (on_firmware(model, raw) == first).all()


def test_what_is_sensed_is_the_frame_less_the_effects_of_which_nothing_is_lost():
    rng, e = np.random.default_rng(1), EffectModel().e
    state, asked, given = array("i", [0] * STATE.FIT_WEIGHTS), 0, 0
    for _ in range(40):
        frame, effect = rng.integers(-9000, 9000, 7), rng.integers(-5000, 5000, 3)
        state[STATE.EFFECT_Q8 : STATE.EFFECT_Q8 + 3] = array("i", effect.tolist())
        effects.lessen(state, e, array("i", frame.tolist()))
        sensed, carry_q8 = np.array(e[EFFECTS.SENSED :][:7]), e[EFFECTS.SENSED_CARRY_Q8 :][:3]
        assert (sensed[:4] == frame[:4]).all() and np.abs(carry_q8).max() <= 128
        asked, given = asked + 256 * frame[4:] - effect, given + 256 * sensed[4:]
        assert (given + carry_q8 == asked).all()


def test_a_sample_as_long_as_a_tick_is_corrected_by_its_own_temperature():
    raw = {n: np.zeros(20, int) for n in ("ax", "ay", "az", "gx", "gy", "gz")}
    raw["temp"] = np.arange(0, 6800, 340)  # a degree each
    slow = loaded([Slot(Term("temp", centre=36.53), (0.01, 0.0, 0.0))], tick_s=15.0)
    got = on_firmware(slow, raw, dt_us=15_000_000)[:, 0]
    # the second tick has the first reading, too, which spoke before any tick had ended
    assert np.abs(got - 0.01 * np.arange(20))[2:].max() < 1e-4


@pytest.mark.parametrize(("bound", "eighths"), [(0, 0), (0.05, 0), (0.0625, 1), (0.55, 4), (1, 8)])
def test_coefficients_refine_within_eighths_from_the_model_s_own(bound, eighths):
    model = loaded([Slot(SUPPLY, (0.001, -0.002, 0.003))])
    own, now = (slot_at(0) + at for at in (SLOT.SLOT_OWN, SLOT.SLOT_COEFFICIENT))
    model.e[now] = 7
    model.refine(bound)
    assert (model.e[EFFECTS.BOUND_EIGHTHS], model.e[EFFECTS.REFINE_ON]) == (eighths, eighths > 0)
    assert (model.attend is not None) == (eighths > 0)
    assert model.e[now : now + 3] == model.e[own : own + 3]
    for wrong in (-0.001, 1.001):
        with pytest.raises(ValueError, match=r"bound is 0\.\.1"):
            model.refine(wrong)


def test_a_channel_is_named_or_numbered():
    model = EffectModel()
    model.channels = ("vdd_mv", "load")
    told = [model.channel(name, 5 + i) for i, name in enumerate(("load", 0, "vdd", 2, -1))]
    assert told == [True, True, False, False, False]
    assert list(model.e[EFFECTS.CHANNELS : EFFECTS.CHANNELS + 3]) == [6, 5, 0]
