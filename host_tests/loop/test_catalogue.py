"""What the bias of some sessions may follow: every effect in its places, over the ranges seen;
the name of what was found, and what else it may be."""

from dataclasses import replace

import numpy as np
import pytest
from zerorate_tools.loop.fit.regression import Regression
from zerorate_tools.loop.read.earth import Earth
from zerorate_tools.loop.search import catalogue, naming
from zerorate_tools.loop.search.catalogue import candidates, ranges, varies
from zerorate_tools.model.term import Term

from . import dense
from .dense import A, B
from .selections import candidate, found, warm


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


LAGGED = Term("a", lag_s=0.1, lag_mode="lag")
LATE = candidate(LAGGED, kind="channel-lag", family="generic")
SHAKEN, SUPPLIED = candidate(A), candidate(B, kind="supply-voltage")


@pytest.fixture
def regression(sessions):
    """Three sessions whose bias follows a source, and another that is all but the same."""
    for s in sessions:
        s.sources["twin"] = s.sources["a"] * 1.0001
    return Regression([dense.following(s) for s in sessions])


def test_groups_alike_share_the_posterior_by_the_levels_of_their_families(regression):
    twin = candidate(Term("twin"), kind="channel", family="generic")

    def posterior(chosen, *every):
        ratios = regression.gains([], [c.terms for c in every]).sum(axis=1)
        return naming.posterior(regression, [], chosen, every, ratios)

    told = posterior(LATE, LATE, twin, SHAKEN, SUPPLIED)
    assert told[0][0] is SHAKEN and SUPPLIED not in [c for c, _ in told]
    nats = {c.label: n for c, n in told}
    assert nats["vibration"] - nats["channel(twin)"] == pytest.approx(np.log(50), abs=0.1)
    # a group of two places has half the weight where one of them alone fits
    again = dict(posterior(twin, SHAKEN, candidate(B), twin))
    assert again[SHAKEN] - again[twin] == pytest.approx(np.log(25), abs=0.1)


def test_the_likeliest_is_named_with_what_else_it_may_be(regression):
    twin = candidate(replace(A, centre=1.0), kind="channel", family="generic")
    pool = [SHAKEN, SUPPLIED]

    def named(effect, pool=pool, bends=0, passes=True):
        may = lambda own, others: passes or own.terms != (A,)  # noqa: E731
        naming.name_found(regression, (), [effect], pool, bends, may)
        return effect.candidate.kind

    late = found(LAGGED, kind="channel-lag", family="generic")
    assert named(late, passes=False) == "channel-lag", "the likelier one does not pass"
    assert named(late) == "vibration" and late.confounded_with == []
    assert late.probabilities["vibration"] > 0.95
    kept = found(LAGGED, kind="channel-lag", family="generic", rivals={"other": 0.0})
    assert named(kept, [*pool, twin], bends=1) == "channel-lag"
    assert set(kept.rivals) == {"other", "vibration"}
    slope = found(Term("temp", 10.0, 40.0), kind="temperature-polynomial")
    assert named(slope) == "temperature-polynomial"


@pytest.mark.parametrize(
    ("kind", "dps", "known", "named"),
    [
        ("linear-acceleration", 0.002, True, ["earth-rotation"]),
        ("squared-acceleration", 0.002, True, ["earth-rotation"]),
        ("linear-acceleration", 50.0, True, []),
        ("vibration", 0.002, True, []),
        ("linear-acceleration", 0.002, False, []),
    ],
)
def test_earth_is_named_beside_what_follows_a_pose_and_is_no_larger(
    sessions, kind, dps, known, named
):
    for s in sessions:
        s.sources["acc_x"] = np.sign(s.sources["a"])
        s.earth = Earth(np.zeros((s.blocks, 3)), 0.004, "") if known else None
    pose = Term("acc_x")
    effect = found(pose, kind=kind)
    deployed = np.array([[9.0] * 3, [dps, 0, 0]])
    naming.name_earth([effect], [B, pose], deployed, Regression(sessions))
    assert effect.confounded_with == named
