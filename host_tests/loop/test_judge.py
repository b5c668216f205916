"""What judges effects by data that no fit has seen, and takes those out that it speaks against."""

from dataclasses import replace

import numpy as np
import pytest
from zerorate_tools.loop.fit.regression import floor_dps
from zerorate_tools.loop.verify import analysis as analysing
from zerorate_tools.loop.verify import prune_by_holdout as prune
from zerorate_tools.loop.verify.analysis import deployable
from zerorate_tools.loop.verify.judge import Judgement, ResidualTest, judge, scored
from zerorate_tools.model import CannotDeploy
from zerorate_tools.model.term import Term

from . import dense
from .dense import A, B, C
from .power_ons import MPU
from .selections import analysed, found, selected


@pytest.mark.parametrize(
    ("after", "gain", "p", "said"),
    [
        *(([1.0, 1.0, 1.0], 3.1, 1.0, "confirmed"), ([1.0, 1.0, 1.0], 3.0, 1.0, "tentative")),
        ([0.9, 0.9, 0.9], 2.9, 1.0, "tentative"),
        *(([1.0, 1.0, 1.01], 9.0, 1.0, "tentative"), ([0.5, 0.5, 0.5], 9.0, 1e-9, "tentative")),
    ],
)
def test_an_effect_is_confirmed_where_it_gains_and_the_error_does_not_grow(after, gain, p, said):
    test = ResidualTest(p, 0.0, np.zeros(3))
    told = Judgement(np.ones(3), np.array(after), np.array([gain]), test, [], [], [], None)
    assert told.confidence(0) == said


def test_the_first_still_minute_gives_the_offset_and_is_not_scored():
    session = dense.made(1, 12, gap=(1, 8))
    model = np.outer(session.sources["a"], [1.0, 0.0, -1.0])
    left, offset = scored(session, model)
    first = [0, 2, 3]  # three still blocks of 20 s
    expected = (session.rate_dps - model)[first].mean(axis=0)
    assert offset == pytest.approx(expected)
    assert np.isnan(left[:4]).all() and np.isnan(left[8]).all()
    assert left[4] == pytest.approx(session.rate_dps[4] - model[4] - expected)


@pytest.fixture(scope="module")
def sessions():
    return [dense.following(dense.made(seed, 24)) for seed in (1, 2, 3, 4)]


def test_an_effect_gains_what_the_session_held_out_loses_without_it(sessions):
    train, held = sessions[:3], sessions[3]
    told = judge(selected(train, found(A), found(B)), [held])
    whole = told.whole
    full = whole.fit([A, B]).base
    clean = [replace(s, rate_dps=r) for s, r in zip(whole.sessions, whole.rate)]

    def misfit(*terms):
        """Squares of the last session, by coefficients of the others, in units of the noise."""
        total = 0.0
        for a in range(3):
            p = dense.problem(clean, terms, whole.scale[:, a])
            to, at = np.linalg.inv(p.v[full.best[a]]), p.rows[3]
            fit = slice(0, at.start)
            v, x = to[fit, fit], p.x[fit]
            b = np.linalg.solve(x.T @ v @ x, x.T @ v @ p.y[fit, a])
            left = p.y[at, a] - p.x[at] @ b
            total += left @ to[at, at] @ left / full.variance[a]
        return total

    gains = 0.5 * (np.array([misfit(B), misfit(A)]) - misfit(A, B))
    assert told.gains == pytest.approx(gains, rel=1e-4)
    twice = judge(selected(train, found(A), found(B)), [held, replace(held, name="again")])
    assert twice.gains[0] > told.gains[0] > 10


# --- how sure it is, and what can be deployed ---


VOLTS = Term("vdd_mv", 4900.0, 5100.0, 5000.0)
WARM = Term("temp", -20.0, 30.0, 5.0, power=2)


@pytest.fixture
def sure(supplied):
    """An analysis whose one effect is confirmed."""
    test = ResidualTest(1.0, 0.0, np.zeros(3))
    judgement = Judgement(np.ones(3), np.full(3, 0.5), np.array([9.0]), test, [], [], [], None)
    return replace(analysed(supplied, found(VOLTS)), judgement=judgement)


def of_time(analysis, sessions):
    """The same of an effect of time, over these sessions."""
    selection = replace(analysis.selection, found=[found(Term("time"))])
    return replace(analysis, selection=selection, sessions=sessions)


@pytest.mark.parametrize("at", [0, 1, 2])
def test_the_effect_that_cannot_be_deployed_is_left_out_judged_anew_and_noted(supplied, at):
    effects = [found(VOLTS), found(WARM)]
    assert deployable(analysis := analysed(supplied, *effects), MPU) is analysis
    beyond = found(replace(VOLTS, lag_mode="lag", lag_s=1e9), kind="thermal-lag")
    less = deployable(analysed(supplied, *effects[:at], beyond, *effects[at:]), MPU)
    assert less.selection.found == effects
    assert len(less.judgement.gains) == 2 and "found but left out: " in less.gate.notes[0]
    both = [*less.selection.straight, *less.selection.terms]
    assert less.floor_dps == pytest.approx(floor_dps(less.judgement.whole, both))


def test_what_cannot_be_deployed_without_an_effect_is_an_error(supplied, monkeypatch):
    def never_fits(*arguments, **named):
        raise CannotDeploy("too much of motion")

    monkeypatch.setattr(analysing, "build_model", never_fits)
    with pytest.raises(CannotDeploy):
        deployable(analysed(supplied), MPU)


def test_confidence_is_tentative_with_few_power_ons_and_beside_earth(sure, supplied):
    assert sure.confidence(0) == "confirmed" and not sure.few and not sure.single
    few = replace(sure, train=supplied[:2])
    assert (
        few.few and few.confidence(0) == "tentative" and not replace(sure, train=supplied * 2).few
    )
    turning = [found(VOLTS, rivals={"earth-rotation": 0.0})]
    beside_earth = replace(sure, selection=replace(sure.selection, found=turning))
    assert beside_earth.confidence(0) == "tentative"
    worse = replace(sure, judgement=replace(sure.judgement, after_dps=np.full(3, 2.0)))
    assert worse.confidence(0) == "tentative"


def test_without_a_thermometer_in_all_recordings_what_follows_time_may_be_heat(sure, supplied):
    assert of_time(sure, supplied).confidence(0) == "confirmed"
    blind = replace(supplied[0], sources={})
    for some in ([blind], [supplied[0], blind], [blind, supplied[0]]):
        assert of_time(sure, some).may_be_heat(0)
        assert of_time(sure, some).confidence(0) == "tentative"
    volts = replace(sure, sessions=[blind])
    assert volts.single and not volts.may_be_heat(0) and volts.confidence(0) == "confirmed"


# --- what held-out data speak against ---


def residuals(*errors):
    """Residuals whose RMS on each axis is what is said, with the first 0, 1, ... effects."""
    return [[np.tile(e, (4, 1)).astype(float)] for e in errors]


@pytest.fixture(scope="module")
def three():
    return selected([dense.made(1, 24)], found(A), found(B), found(C))


def never(i):
    raise AssertionError(f"effect {i} is not in doubt")


ALL, NOT_X = (True, True, True), (False, True, True)


@pytest.mark.parametrize(
    ("after", "alone", "corrected"),
    [
        ([[4, 4, 4], [3, 4, 3], [2, 4, 3], [2, 3, 3]], None, None),
        # of the first, later ones may have made good what it does on x
        ([[4, 4, 4], [5, 4, 3], [4, 6, 3], [4, 6, 4]], [1, 1, 1],
         [NOT_X, (True, False, True), (True, True, False)]),
        # on one axis the worst goes alone
        ([[1, 1, 1], [1.5, 1, 1], [3, 1, 1], [3.2, 1, 1]], None, [ALL, NOT_X, ALL]),
        # with those found later it is better than before, and than without it
        ([[1, 1, 1], [1.5, 1, 1], [0.8, 1, 1], [0.8, 1, 1]], [0.9, 1, 1], None),
        ([[1, 1, 1], [1.5, 1, 1], [0.8, 1, 1], [0.8, 1, 1]], [0.7, 1, 1], [NOT_X, ALL, ALL]),
    ],
)  # fmt: skip
def test_an_effect_goes_from_the_axes_on_which_the_error_grows(three, after, alone, corrected):
    asked = []
    without = lambda i: asked.append(i) or residuals(alone)[0]  # noqa: E731
    less = prune.without_harmful(three, residuals(*after), without if alone else never)
    assert less is three if corrected is None else [f.axes for f in less.found] == corrected
    assert set(asked) <= {0} and [f.axes for f in three.found] == [ALL] * 3


@pytest.mark.parametrize(
    ("better", "stays"),
    [
        *(([1] * 5, True), ([1] * 4, False), ([3] * 6 + [-1] * 2, True), ([1, -2] * 10, False)),
        *(([0.0] * 20, False), ([-1] * 20, False)),
    ],
)
def test_an_effect_that_helps_no_more_pieces_than_chance_is_withdrawn(three, better, stays):
    def left(gained):  # one piece a block: the last in a recording of its own
        dps = np.sqrt(10.0 - np.outer(gained, [1, 0, 0]))
        return [dps[:-1], dps[-1:]]

    pieces = [np.arange(len(better) - 1), np.zeros(1, int)]
    one, after = three.first(1), [left(np.zeros(len(better))), left(better)]
    less = prune.without_unshown(one, after, never, pieces)
    assert (less is one) is stays
    for name, why in less.withdrawn:
        assert not less.found and name == "vibration"
        assert f"{sum(b > 0 for b in better)} of {len(better)} pieces" in why
