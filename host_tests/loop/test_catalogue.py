"""What the bias of some sessions may follow: every effect in its places, over the ranges seen."""

from dataclasses import replace

import numpy as np
import pytest
from zerorate_tools.loop.search import catalogue
from zerorate_tools.loop.search.catalogue import candidates, ranges, varies
from zerorate_tools.model.term import Term

from .selections import warm


def test_a_source_s_range_leaves_out_extremes_that_no_several_blocks_share():
    session = warm(blocks=200)
    session.sources["load"][[3, 50, 90]] = [99.0, 98.0, 97.0]
    span, load = ranges([session]), np.sort(session.sources["load"])
    few = 3  # one, and a hundredth of all
    assert span["load"] == (load[few], load[-1 - few], pytest.approx(load.mean()))
    assert span["temp"] == (20.0, 30.0, pytest.approx(25.0))
    assert span["time"] == (10.0, 3990.0, pytest.approx(2000.0))
    unseen = replace(session, weight=(np.arange(200) < 100).astype(float))
    assert ranges([unseen])["temp"][1] == session.sources["temp"][99]
    two = ranges([session, warm(blocks=2, seed=1)])
    assert two["temp"][:2] == (20.0, 30.0) and set(two) == set(span)
    tiny = ranges([warm(blocks=2)])["load"]
    assert tiny[0] <= tiny[1]


def of_kind(found, kind):
    return [c for c in found if c.kind == kind]


@pytest.fixture(scope="module")
def every():
    return candidates([warm()])


@pytest.fixture(scope="module")
def span():
    return ranges([warm()])


def test_effects_of_temperature_are_over_half_as_much_again_as_was_seen(every, span):
    mean = span["temp"][2]
    [bend] = of_kind(every, "temperature-quadratic")
    assert bend.terms == (Term("temp", 15.0, 35.0, mean, power=2),) and not bend.refine
    cubic, kinks = (of_kind(every, f"temperature-{kind}") for kind in ("cubic", "kink"))
    assert [c.terms[0].centre for c in cubic] == [mean, 20.0, 30.0]
    at = 20 + 10 * np.arange(0.15, 0.9, 0.1) - mean
    assert [c.terms[0].knot for c in kinks] == pytest.approx(at)
    assert (cubic[0].refine, kinks[0].refine) == (("centre",), ("knot",))
    assert not of_kind(every, "temperature-peak")  # it only ever rises here: no memory of anything


def test_what_follows_time_begins_with_the_power_on(every):
    [drift], decay = of_kind(every, "time-drift"), of_kind(every, "power-on-transient")
    assert drift.terms[0].centre == 0.0 and drift.sources == ["time"]
    assert len(decay) == 7 and decay[0].sources == [] and decay[0].terms[0].lo == -np.inf


def test_effects_of_sensors_are_over_what_their_sources_reach(every, span):
    [volts], [squared] = of_kind(every, "supply-voltage"), of_kind(every, "squared-acceleration")
    assert volts.sources == ["vdd_mv"] and volts.slots == volts.terms and not volts.is_free
    assert volts.label == "supply-voltage"
    both = of_kind(every, "supply-temperature")
    assert len({(c.terms[0].centre, c.terms[0].second_centre) for c in both}) == len(both) == 9
    assert (both[0].terms[0].second_lo, both[0].terms[0].second_hi) == (15.0, 35.0)
    assert squared.sources == ["acc_x"], "the others did not move"
    first, reach = squared.terms[0], max(-span["acc_x"][0], span["acc_x"][1])
    assert (first.lo, first.hi, first.centre) == (-reach, reach, 0.0)
    assert not of_kind(every, "vibration") and not of_kind(every, "rate-scale")


def test_any_channel_has_curves_and_products_with_those_behind_it(every):
    pairs = {(c.terms[0].source, c.terms[0].second) for c in of_kind(every, "channel-product")}
    assert pairs == {("load", "temp"), ("vdd_mv", "temp"), ("vdd_mv", "load")}
    curves = of_kind(every, "channel-curve")
    assert {(c.family, c.is_free, len(c.slots)) for c in curves} == {("generic", True, 1)}
    assert {c.label for c in curves} == {"channel-curve(vdd_mv)", "channel-curve(load)"}


@pytest.mark.parametrize(
    ("name", "least"), [("temp", 0.3), ("acc_x", 0.1), ("rate_y", 2.0), ("load", 1e-12)]
)
def test_a_source_that_hardly_moves_shows_nothing(name, least):
    for times in (0.97, 1.03):
        moves = warm(**{name: np.linspace(0.0, times * least, 50)})
        still = replace(moves, weight=(np.arange(50) < 5).astype(float))
        assert bool(varies(name, [warm(**{name: np.zeros(50)}), moves])) is (times > 1)
        assert not varies(name, [still]) or name == "load", "where no rate is known it says nothing"
    assert varies("time", [moves])


@pytest.mark.parametrize("name", ["vdd_mv", "VBAT", "Supply 5V", "my_volts", "vcc"])
def test_a_supply_is_told_by_its_name(name):
    assert catalogue.is_supply(name) and not catalogue.is_supply("load")
    assert catalogue.extra_channels(warm()) == ("vdd_mv", "load")


def test_what_does_not_vary_or_was_not_recorded_is_no_candidate():
    found = candidates([warm(temp=np.full(50, 20.0), acc_x=np.zeros(50))])
    assert not [c for c in found if "temp" in c.sources or "acc_x" in c.sources]
    bare = candidates([replace(warm(), sources={})])
    assert {c.kind for c in bare} == {"time-drift", "power-on-transient"}
    assert of_kind(candidates([warm(vib=np.linspace(0.0, 1.0, 50))]), "vibration")


@pytest.mark.parametrize(
    ("moves_s", "delay", "told"), [(30, [], False), (50, [], True), (50, None, False)]
)
def test_what_motion_tells_by_samples_beside_a_reference_is_no_effect(moves_s, delay, told):
    turning = warm(**{f"rate_{a}": np.linspace(0.0, 9.0, 50) for a in "xyz"})
    at_rest = np.where(np.arange(50) * turning.tick_s < moves_s, np.nan, 0.0)
    known = replace(turning, delay=delay, ticks_dps=np.tile(at_rest[:, None], 3))
    assert bool(of_kind(candidates([known, turning]), "rate-scale")) is not told


def test_a_late_part_adds_lags_or_the_rate_of_temperature_times_its_slope():
    late, lags = catalogue.late([warm()]), catalogue.lags([warm()])
    assert [[t.lag_s for t in c.terms] for c in late] == [[5.0, 5.0]]
    assert {c.terms[1].second_centre for c in late} == {lags[0].centre} == {25.0}
    every = [(s, k, k == 2) for s in (5, 15, 45, 135, 405, 1215) for k in (1, 2)]
    assert [(t.lag_s, t.power, t.power_first) for t in lags] == every
    bare = replace(warm(), sources={})
    assert catalogue.late([bare]) == [] == catalogue.lags([bare])
