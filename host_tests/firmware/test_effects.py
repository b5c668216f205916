"""Effect slots in integers do what the float reference of the loop does, over hours."""

import math
from array import array
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st
from zerorate import Sensor
from zerorate.effects import effect_inputs, effects
from zerorate.layout import EFFECTS, STATE
from zerorate_tools.model import Slot
from zerorate_tools.model.term import Term, evaluate

from .checked import Words, checked
from .simulated_sources import A_TICK, columns, last_samples, loaded, on_firmware, tick_means

TENTH_OF_THE_FLOOR_DPS = 0.0003
LARGEST_DPS = 0.5
CENTRES = {
    "temp": (5.0, 45.0),
    "acc_x": (-0.3, 0.3),
    "acc_z": (0.5, 1.5),
    "vdd_mv": (4900.0, 5100.0),
    "pressure_pa": (100800.0, 101800.0),
    "time": (0.0, 9000.0),
}
BASES = {
    "square": {"power": 2},
    "cube": {"power": 3},
    "kink": {"knot": 0.1},
    "kink squared": {"knot": -0.2, "power": 2},
    "lag": {"lag_mode": "lag", "lag_s": 180.0},
    "longest lag": {"lag_mode": "difference", "lag_s": 7200.0},
    "rate": {"lag_mode": "rate", "lag_s": 20.0},
    "shortest rate": {"lag_mode": "rate", "lag_s": 8.0},
    "square lagged": {"lag_mode": "lag", "lag_s": 540.0, "power": 2, "power_first": True},
    "lag squared": {"lag_mode": "lag", "lag_s": 540.0, "power": 2},
    "backlash": {"memory": "backlash", "width": 0.15},
    "peak": {"memory": "peak"},
    "decay": {"decay_s": 240.0},
    "short delay": {"delay_s": 37.0},
}


@pytest.fixture(scope="module")
def warm_up():
    raw = columns()
    return raw, tick_means(raw)


def term_over(source, basis, lo, hi):
    """The basis with its knot and width, shares of the range, over lo..hi."""
    fields = dict(basis)
    for name in {"knot", "width"} & set(fields):
        share = fields[name] * (hi - lo)
        fields[name] = share ** fields.get("power", 1) if fields.get("power_first") else share
    return Term(source, lo, hi, (lo + hi) / 2, **fields)


def worst(term, warm_up):
    """(largest difference between firmware and reference, largest effect), dps."""
    raw, sources = warm_up
    if Slot(term, (0.0, 0.0, 0.0)).is_of_the_sample:
        wanted = evaluate(term, last_samples(raw, sources), 1.0)
    else:  # a tick's value is held through the tick behind it
        wanted = evaluate(term, sources, 1.0)[:-1]
    size = np.abs(wanted).max()
    if size == 0:
        return 0.0, 0.0
    coefficients = LARGEST_DPS / size * np.array([1.0, -0.3, 0.01])
    got = on_firmware(loaded([Slot(term, tuple(coefficients))]), raw)
    last_of_each = got[A_TICK - 1 :: A_TICK][1:]
    return np.abs(last_of_each - wanted[:, None] * coefficients).max(), size * coefficients[0]


@pytest.mark.parametrize("name", BASES)
@pytest.mark.parametrize("source", ["temp", "acc_x"])
def test_a_basis_is_that_of_the_reference(source, name, warm_up):
    error, size = worst(term_over(source, BASES[name], *CENTRES[source]), warm_up)
    assert size > 0.49
    assert error < TENTH_OF_THE_FLOOR_DPS


@pytest.mark.parametrize(
    "term",
    [
        Term("one", decay_s=60.0),
        Term("one", decay_s=7200.0),
        Term("time", 0.0, 7200.0),
        Term("time", 0.0, 3000.0, power=2),
        Term("vib", 0.0, 0.01, power=1),
        Term("vdd_mv", 4930.0, 5050.0, 5000.0),
        Term("pressure_pa", 101000.0, 101700.0, 101325.0, power=2),
        Term("vdd_mv", 4930.0, 5050.0, 5000.0, second="temp", second_lo=10.0, second_hi=50.0),
        Term(
            *("acc_z", 0.5, 1.5, 1.0),
            second="pressure_pa",
            second_lo=100800.0,
            second_hi=101800.0,
            second_centre=101325.0,
        ),
        Term("rate_y", lag_mode="lag", lag_s=60.0),
        Term("temp", power_first=True, power=3, centre=25.0, memory="peak", lo=0.0, hi=60.0),
    ],
    ids=lambda t: f"{t.source}-{t.power}-{t.second}",
)
def test_every_kind_of_source_serves(term, warm_up):
    error, size = worst(term, warm_up)
    assert size > 0.49
    assert error < TENTH_OF_THE_FLOOR_DPS


ANY_TERM = st.fixed_dictionaries(
    {
        "source": st.sampled_from(sorted(CENTRES)),
        "basis": st.sampled_from(sorted(BASES)),
        "share": st.tuples(st.floats(0.05, 1.0), st.floats(0.0, 1.0)),
        "second": st.sampled_from([None, "temp", "vdd_mv", "acc_x"]),
        "scale_s": st.floats(0.2, 20.0),
    }
)


NARROW = {
    **{"source": "vdd_mv", "basis": "backlash", "second": None, "scale_s": 1.0},
    "share": (0.14145443813121708, 0.25),
}
SELDOM = {
    **{"source": "temp", "basis": "shortest rate", "second": "temp", "scale_s": 2.0},
    "share": (1.0, 0.0),
}


@given(chosen=ANY_TERM)
@example(chosen=NARROW)
@example(chosen=SELDOM)
@settings(max_examples=15, deadline=None, suppress_health_check=[HealthCheck.too_slow])
def test_any_slot_stays_below_a_tenth_of_the_floor(chosen, warm_up):
    low, high = CENTRES[chosen["source"]]
    width = chosen["share"][0] * (high - low)
    low += chosen["share"][1] * (high - low - width)
    term = term_over(chosen["source"], BASES[chosen["basis"]], low, low + width)
    seconds = {n: min(7200.0, getattr(term, n) * chosen["scale_s"]) for n in ("lag_s", "decay_s")}
    term = replace(term, **seconds)
    if chosen["second"]:
        limits = dict(zip(("second_lo", "second_hi"), CENTRES[chosen["second"]]))
        term = replace(
            term, second=chosen["second"], second_centre=sum(limits.values()) / 2, **limits
        )
    _, sources = warm_up
    # what a range shows a fiftieth of is no effect that its fit could have found
    if np.abs(evaluate(term, sources, 1.0)).max() > 0.02 * _scale(term):
        assert worst(term, warm_up)[0] < TENTH_OF_THE_FLOOR_DPS


def _scale(term):
    scale = ((term.hi - term.lo) / 2) ** term.power
    if term.lag_mode == "rate":
        scale /= term.lag_s
    return scale * ((term.second_hi - term.second_lo) / 2 if term.second else 1.0)


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


def test_play_operators_alone_make_a_model(warm_up):
    raw = {name: values[:400] for name, values in warm_up[0].items()}
    model = loaded(PLAYS[:1])
    assert (model.e[EFFECTS.SLOT_COUNT], np.abs(on_firmware(model, raw)[-1]).max() > 0.01) == (
        0,
        True,
    )


def test_a_small_table_is_straight_lines_between_nine_points(warm_up):
    table = (0.0, 0.3, -0.2, 1.0, 0.9, 0.1, -1.0, 0.0, 0.5)
    error, size = worst(Term("temp", 10.0, 50.0, 30.0, table=table), warm_up)
    assert size > 0.49
    assert error < TENTH_OF_THE_FLOOR_DPS


def test_a_long_delay_is_straight_lines_between_what_was_kept():
    ramp = {n: np.zeros(8000, int) for n in ("ax", "ay", "az", "gx", "gy", "gz")}
    ramp["temp"] = np.arange(8000)
    got = on_firmware(loaded([Slot(Term("temp", delay_s=600.0), (0.01, 0.0, 0.0))]), ramp)[:, 0]
    # a tick's mean is used in the tick behind it, and was that of 600 ticks before
    n = np.arange(700 * A_TICK, 8000)
    tick = n // A_TICK - 1
    wanted = 0.01 * ((A_TICK * (tick - 600) + (A_TICK - 1) / 2) / 340 + 36.53)
    later = n % A_TICK == A_TICK - 1
    assert np.abs(got[n] - wanted)[later].max() < 0.0001
    assert np.ptp(got[50 : 600 * A_TICK]) == 0.0


def test_two_delays_keep_what_was_apart():
    raw = {n: np.zeros(3000, int) for n in ("ax", "ay", "az", "gx", "gy", "gz")}
    raw["temp"] = np.arange(3000)
    slots = [
        Slot(Term("temp", delay_s=40.0), (0.01, 0.0, 0.0)),
        Slot(Term("temp", delay_s=110.0), (0.0, 0.01, 0.0)),
    ]
    together = on_firmware(loaded(slots), raw)
    for axis, slot in enumerate(slots):
        assert (together[:, axis] == on_firmware(loaded([slot]), raw)[:, axis]).all()


def test_only_the_effects_own_words_of_the_state_change(warm_up):
    model = loaded([Slot(Term("temp", 10.0, 50.0), (0.01, 0.02, 0.03))])
    state = array("i", [1234] * 100)
    for _ in range(3):
        effects.sense(state, model.e, array("i", [1, 2, 16384, 900, 3, 4, 5]), 10000, 1)
    changed = [i for i, word in enumerate(state) if word != 1234]
    assert changed == [STATE.EFFECT_Q8 + axis for axis in range(3)]


def test_outside_the_fitted_range_a_slot_is_held_at_the_edge():
    term = Term("temp", 20.0, 40.0, 30.0, power=2)
    raw = {n: np.zeros(40, int) for n in ("ax", "ay", "az", "gx", "gy", "gz")}
    raw["temp"] = np.full(40, round((55.0 - 36.53) * 340))
    got = on_firmware(loaded([Slot(term, (0.002, 0.0, 0.0))]), raw)
    assert got[-1, 0] == pytest.approx(0.002 * 10.0**2, abs=3e-5)


def test_a_scale_error_is_of_the_very_sample(warm_up):
    raw = {name: values[:400] for name, values in warm_up[0].items()}
    slots = [
        Slot(Term("rate_x", -200.0, 200.0), (0.02, 0.005, 0.0)),
        Slot(
            Term("rate_x", -200.0, 200.0, second="temp", second_lo=0.0, second_hi=60.0),
            (0.001, 0, 0),
        ),
    ]
    got = on_firmware(loaded(slots), raw)
    rate, tick = raw["gx"] / 131, tick_means(warm_up[0])("temp")
    held = np.repeat(tick, A_TICK)[: 400 - A_TICK]
    wanted = 0.02 * rate[A_TICK:] + 0.001 * rate[A_TICK:] * held
    assert np.abs(got[A_TICK:, 0] - wanted).max() < 1e-4
    assert np.abs(got[:, 1] - 0.005 * rate).max() < 5e-5


def test_acceleration_counts_in_the_very_sample(warm_up):
    raw = {name: values[:400] for name, values in warm_up[0].items()}
    slots = [
        Slot(Term("acc_x", -2.0, 2.0), (0.1, 0.02, 0.0)),
        Slot(Term("acc_z", -2.0, 2.0, power=2), (0.0, 0.0, 0.05)),
    ]
    got = on_firmware(loaded(slots), raw)
    x, z = raw["ax"] / 16384, raw["az"] / 16384
    wanted = np.column_stack([0.1 * x, 0.02 * x, 0.05 * z**2])
    assert np.abs(got - wanted).max() < 5e-5


def test_a_frame_that_is_no_reading_leaves_acceleration_as_it_was():
    slots = [Slot(Term("acc_z", -2.0, 2.0), (0.1, 0, 0)), Slot(Term("rate_x", -9, 9), (0, 0.1, 0))]
    state, model = array("i", [0] * STATE.FIT_WEIGHTS), loaded(slots)
    turning = array("i", [0, 0, 16384, 0, 131, 0, 0])
    for frame, good in ((turning, 1), (array("i", [-1] * 7), 0)):
        effects.sense(state, model.e, frame, 250000, good)
    assert state[STATE.EFFECT_Q8] / 256 / 131 == pytest.approx(0.1, abs=1e-4)
    assert state[STATE.EFFECT_Q8 + 1] == 0


def test_slots_of_all_kinds_add_up(warm_up):
    raw, sources = warm_up
    terms = [
        term_over("temp", BASES[n], *CENTRES["temp"])
        for n in ("square", "rate", "longest lag", "backlash", "peak", "decay", "short delay")
    ]
    slots = [Slot(t, (0.3 / np.abs(evaluate(t, sources, 1.0)).max(), 0.0, 0.0)) for t in terms]
    got = on_firmware(loaded(slots), raw)[A_TICK - 1 :: A_TICK, 0]
    wanted = sum(s.coefficient_dps[0] * evaluate(s.term, sources, 1.0) for s in slots)
    # twice seven slots fit in the two samples of a tick, so that a gap can be made up for
    assert loaded(slots).e[EFFECTS.SLOTS_A_SAMPLE] == 8
    assert np.abs(got[2:] - wanted[1:-1]).max() < TENTH_OF_THE_FLOOR_DPS


def test_no_sample_computes_more_than_its_share(warm_up, monkeypatch):
    slots = [Slot(Term("temp", 0.0, 60.0, 30.0, power=2), (0.001, 0, 0))] * 8
    model = loaded(slots, sensor=Sensor(100.0))
    counted = []
    plain = effects.basis
    monkeypatch.setattr(effects, "basis", lambda e, a: counted.append(a) or plain(e, a))
    frame, state, most = (
        array("i", [0, 0, 16384, 0, 0, 0, 0]),
        array("i", [0] * STATE.FIT_WEIGHTS),
        0,
    )
    for _ in range(500):
        before = len(counted)
        effects.sense(state, model.e, frame, 10000, 1)
        most = max(most, len(counted) - before)
    # once for the first sample, which speaks for the first tick, and once for each of four ticks
    assert (most, len(counted)) == (1, 8 * 5)


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


def test_a_gap_lets_as_many_ticks_pass_as_it_lasted():
    slot = Slot(Term("one", decay_s=100.0), (1.0, 0.0, 0.0))
    state, model = array("i", [0] * STATE.FIT_WEIGHTS), loaded([slot])
    for dt_us in [250000] * 41 + [50_000_000] + [250000] * 100:
        effects.sense(state, model.e, still_frame(), dt_us, 1)
    # 85 s have passed; the latest whole tick is the one that began at 84 s
    assert state[STATE.EFFECT_Q8] / 256 / 131 == pytest.approx(math.exp(-84 / 100), abs=0.001)


def test_a_channel_that_was_never_given_has_no_effect():
    slot = Slot(Term("load", 0.0, 100.0, 50.0), (0.01, 0.0, 0.0))
    state, model = array("i", [0] * STATE.FIT_WEIGHTS), loaded([slot])
    for n in range(60):
        if n == 30:
            assert state[STATE.EFFECT_Q8] == 0
            assert model.channel("load", 90)
        effects.sense(state, model.e, still_frame(), 250000, 1)
    assert state[STATE.EFFECT_Q8] / 256 / 131 == pytest.approx(0.4, abs=1e-4)


@pytest.mark.parametrize("value", [-1_500_000, -1, 3, 700_000, 3_000_000])
def test_a_channel_of_millions_is_held_to_its_range(value):
    slot = Slot(Term("load", -1e6, 1e6), (1e-6, 0.0, 0.0))
    state, model = array("i", [0] * STATE.FIT_WEIGHTS), loaded([slot])
    assert model.e[EFFECTS.INPUTS + 1] > 0  # its values are shifted right
    model.channel("load", value)
    for _ in range(30):
        effects.sense(state, model.e, still_frame(), 250000, 1)
    wanted = 1e-6 * max(-1e6, min(1e6, value))
    assert state[STATE.EFFECT_Q8] / 256 / 131 == pytest.approx(wanted, abs=1e-4)


@pytest.mark.parametrize("shift", [0, 4, 7, 8, 9, 15])
@pytest.mark.parametrize(("total", "n"), [(0, 1), (70_000, 3), (900_000_001, 1000), (1 << 43, 7)])
def test_the_mean_of_squares_is_right_at_every_shift(total, n, shift):
    e = array("i", [0] * (EFFECTS.SQUARES + 2))
    e[EFFECTS.SQUARES], e[EFFECTS.SQUARES + 1] = total & 0x7FFF, min(total >> 15, (1 << 29) - 1)
    total = e[EFFECTS.SQUARES] + (e[EFFECTS.SQUARES + 1] << 15)
    wanted = 256 * total / n / 2**shift
    got = effect_inputs.mean_square_q8(e, n, shift)
    assert got == pytest.approx(wanted, abs=2) if wanted < 1 << 23 else got == 0x7FFFFF


def test_frames_that_are_no_readings_let_time_pass_and_nothing_else():
    slots = [Slot(Term("temp", 0.0, 60.0), (0.01, 0, 0)), Slot(Term("time", 0, 100), (0, 0.01, 0))]
    state, model = array("i", [0] * STATE.FIT_WEIGHTS), loaded(slots)
    for n in range(80):
        effects.sense(state, model.e, still_frame(-1 if n >= 40 else 3400), 250000, int(n < 40))
    assert state[STATE.EFFECT_Q8] / 256 / 131 == pytest.approx(0.01 * 46.53, abs=1e-4)
    assert state[STATE.EFFECT_Q8 + 1] / 256 / 131 == pytest.approx(0.01 * 18.5, abs=1e-4)


def test_time_that_stands_still_or_runs_back_is_passed_over():
    state, model = (
        array("i", [0] * STATE.FIT_WEIGHTS),
        loaded([Slot(Term("time", 0, 100), (0, 0.01, 0))]),
    )
    for n in range(200):
        effects.sense(state, model.e, still_frame(), -(1 << 29) if n % 2 else 250000, 1)
    assert state[STATE.EFFECT_Q8 + 1] / 256 / 131 == pytest.approx(0.01 * 23.5, abs=1e-4)


def test_a_power_on_begins_every_memory_anew(warm_up):
    raw = {name: values[:4000] for name, values in warm_up[0].items()}
    terms = [term_over("temp", BASES[n], *CENTRES["temp"]) for n in ("peak", "lag", "short delay")]
    model = loaded([Slot(t, (0.01, -0.02, 0.03)) for t in (*terms, Term("one", decay_s=100.0))])
    first = on_firmware(model, raw)
    on_firmware(model, columns(seed=5))
    model.power_on()
    assert (on_firmware(model, raw) == first).all()


HARSH = [-32768, 32767, 0]


@given(
    chosen=st.lists(ANY_TERM, min_size=1, max_size=8),
    ends=st.lists(st.sampled_from(HARSH), min_size=3, max_size=3),
)
@settings(max_examples=30, deadline=None, suppress_health_check=[HealthCheck.too_slow])
def test_no_intermediate_leaves_31_bits(chosen, ends):
    """The largest coefficients that a model may have, and readings from rail to rail."""
    slots, delays = [], 0
    for one in chosen:
        term = term_over(one["source"], BASES[one["basis"]], *CENTRES[one["source"]])
        delays += term.delay_s > 0
        if delays > 2 and term.delay_s:
            continue
        if one["second"]:
            lo, hi = CENTRES[one["second"]]
            term = replace(term, second=one["second"], second_lo=lo, second_hi=hi, second_centre=lo)
        largest = 124.0 / _largest(term)
        slots.append(Slot(term, (largest, -largest, largest / 7)))
    slots.append(Slot(Term("rate_x", -250.0, 250.0), (0.49, 0.1, -0.49))) if len(
        slots
    ) < 8 else None
    wide = Term("temp", *CENTRES["temp"], 25.0, memory="play", width=3.0)
    slots += [Slot(wide, (1.5, -1.5, 0.1)), Slot(replace(wide, power=2), (0.07, -0.07, 0.07))]
    model = loaded(slots)
    e, state = Words(model.e), Words([0] * STATE.FIT_WEIGHTS)
    for n in range(160):
        frame = Words([ends[(n // 8 + i) % 3] for i in range(7)])
        for i in range(len(model.channels)):
            e[EFFECTS.CHANNELS + i] = checked((1 << 29) * (1 - n // 9 % 3))
        dt_us = checked([250000, 250000, 1 << 29, 5_000_000][n // 3 % 4])
        effects.sense(state, e, frame, dt_us, 1)
    assert max(map(abs, e)) > 0


def _largest(term):
    """What the basis is where the slot's value is nearly 1 or 2."""
    largest = (2 * (term.hi - term.lo)) ** term.power
    if term.lag_mode == "rate":
        largest /= term.lag_s
    return 2 * largest * ((term.second_hi - term.second_lo) if term.second else 1.0)
