"""Effect slots in integers do what the float reference of the loop does, over hours."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st
from zerorate.effects import effects
from zerorate_tools.layout import EFFECTS, STATE
from zerorate_tools.model import Slot
from zerorate_tools.model.term import Term, evaluate

from .checked import Words, checked
from .simulated_sources import A_TICK, last_samples, loaded, on_firmware

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


@pytest.mark.parametrize(
    ("source", "name"),
    [*(("temp", n) for n in BASES), *(("acc_x", n) for n in ("cube", "kink squared", "lag"))],
)
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
@settings(max_examples=8, deadline=None, suppress_health_check=[HealthCheck.too_slow])
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


HARSH = [-32768, 32767, 0]


@given(
    chosen=st.lists(ANY_TERM, min_size=1, max_size=8),
    ends=st.lists(st.sampled_from(HARSH), min_size=3, max_size=3),
)
@settings(max_examples=15, deadline=None, suppress_health_check=[HealthCheck.too_slow])
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
