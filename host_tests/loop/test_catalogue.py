"""What the bias of some sessions may follow: every effect in its places, over the ranges seen."""

from dataclasses import replace

import numpy as np
import pytest
from zerorate_tools.loop.search import catalogue
from zerorate_tools.loop.search.catalogue import candidates, ranges, varies

from .selections import warm


def test_a_source_s_range_leaves_out_extremes_that_no_several_blocks_share():
    session = warm(blocks=200)
    session.sources["load"][[3, 50, 90]] = [99.0, 98.0, 97.0]
    span, load = ranges([session]), np.sort(session.sources["load"])
    few = 2  # a hundredth of all
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


def test_a_late_part_adds_lags_or_the_rate_of_temperature_times_its_slope():
    late, lags = catalogue.late([warm()]), catalogue.lags([warm()])
    assert [[t.lag_s for t in c.terms] for c in late] == [[5.0, 5.0]]
    assert {c.terms[1].second_centre for c in late} == {lags[0].centre} == {25.0}
    every = [(s, k, k == 2) for s in (5, 15, 45, 135, 405, 1215) for k in (1, 2)]
    assert [(t.lag_s, t.power, t.power_first) for t in lags] == every
    bare = replace(warm(), sources={})
    assert catalogue.late([bare]) == [] == catalogue.lags([bare])
