"""Steps of the bias beside fits that have each of them as a column of its own."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.stats import chi2, gamma
from zerorate_tools.loop.fit.free_curve import parts
from zerorate_tools.loop.fit.regression import Regression, predicted
from zerorate_tools.loop.read.sessions import block_basis
from zerorate_tools.loop.search import hysteresis, steps_first
from zerorate_tools.loop.search import steps as listed
from zerorate_tools.loop.search.catalogue import Candidate, lags
from zerorate_tools.loop.search.steps import (
    Step,
    standing,
    steps_and_lags,
)
from zerorate_tools.model.term import Term, play

from . import dense
from .dense import A, B

BLOCKS = 60


def noise(seed, blocks=BLOCKS, **sources):
    made = dense.made(seed, blocks)
    made.rate_dps[:] = np.random.default_rng(100 + seed).normal(size=(blocks, 3))
    return replace(made, sources={**made.sources, **sources})


def stepped(session, *steps):
    """The session with steps (block, share of the block before it, sizes)."""
    rate = session.rate_dps.copy()
    for block, share, size in steps:
        rate += np.outer(np.clip(np.arange(session.blocks) + 1.0 + share - block, 0, 1), size)
    return replace(session, rate_dps=rate)


@pytest.fixture
def sessions():
    """Three, with a step in the second and a larger one in the third."""
    return [
        noise(4),
        stepped(noise(5), (31, 0.75, [25.0, -25.0, 0.0])),
        stepped(noise(6), (22, 0.0, [30.0, 30.0, 30.0])),
    ]


def find_all(regression, terms):
    """The steps beside the terms."""
    return steps_and_lags(regression, terms)[0]


def as_terms(sessions, steps):
    """The sessions with each step as a source, and terms of these."""
    terms = [Term(f"step{k}") for k in range(len(steps))]
    out = []
    for i, s in enumerate(sessions):
        own = {}
        for k, step in enumerate(steps):
            at = np.clip(np.arange(s.blocks) + 1.0 + step.share - step.block, 0, 1)
            own[f"step{k}"] = at * (i == step.session)
        out.append(replace(s, sources={**s.sources, **own}))
    return out, terms


def test_steps_are_listed_with_place_size_and_time_the_strongest_first(sessions):
    regression = Regression(sessions)
    found = find_all(regression, [A])
    assert [(s.session, s.block, s.share) for s in found] == [(2, 22, 0.0), (1, 31, 0.75)]
    assert [s.at_s for s in found] == [22 * 20.0, 30.25 * 20.0]
    made, terms = as_terms(sessions, found)
    plain = Regression(made)
    fit = plain.fit([A, *terms])
    for k, step in enumerate(found):
        assert step.size_dps == pytest.approx(fit.coefficients[1 + k], rel=1e-6)
        spread = [
            np.sqrt(fit.base.unscaled[a][1 + k, 1 + k] * fit.base.variance[a]) for a in range(3)
        ]
        assert step.deviation_dps == pytest.approx(spread, rel=1e-6)
        others = [t for j, t in enumerate(terms) if j != k]
        gained = 2 * (fit.total - plain.fit([A, *others]).total)
        assert step.ratio == pytest.approx(gained, rel=1e-6)
        assert step.p_value < 1e-9
    assert len(regression.events()) == 2  # they stay as nuisances
    assert regression.fit([A]).base.total == pytest.approx(fit.base.total)


def test_the_chance_of_a_step_pays_for_every_place_and_recording(sessions):
    one = stepped(noise(8), (30, 0.0, [1.9, 1.9, 1.9]))
    single = standing(Regression([one]), [A], 1, [])
    many = standing(Regression([one]), [A], 7, [])
    assert len(single) == len(many) == 1
    assert many[0].p_value == pytest.approx(7 * single[0].p_value)
    [found] = find_all(Regression([one]), [A])
    assert found.p_value == pytest.approx(single[0].p_value)
    theory = chi2.sf(single[0].ratio, 3) * (BLOCKS + 1 - 15)
    assert single[0].p_value >= theory * 0.999
    assert standing(Regression([one]), [A], 10**9, []) == []
    weak = Regression([stepped(noise(8), (30, 0.0, [0.6] * 3))])
    assert standing(weak, [A], 1, []) == []


def test_a_chance_is_by_the_places_away_from_steps_where_their_tail_is_longer():
    rng = np.random.default_rng(0)
    assert listed._survival(20.0, np.zeros(0)) == chi2.sf(20.0, 3)
    quiet = rng.chisquare(3, 500) * 0.2
    assert listed._survival(20.0, quiet) == chi2.sf(20.0, 3)
    loud = rng.chisquare(3, 500) * 3
    mean, variance = (3 + loud.mean()) / 2, (6 + loud.var()) / 2
    longer = gamma.sf(20.0, mean**2 / variance, scale=variance / mean)
    assert listed._survival(20.0, loud) == pytest.approx(longer)
    few = loud[:4]
    assert listed._survival(20.0, few) == chi2.sf(20.0, 3)


def test_places_near_a_step_of_the_session_say_nothing_of_chance():
    at, ratios = np.arange(10, 56), np.arange(46.0)
    steps = [Step(0, 30, np.zeros(3), 1.0, 1.0), Step(1, 11, np.zeros(3), 1.0, 1.0)]
    away = listed._away(None, steps, [(0, at, ratios), (2, at, ratios)])
    kept = [r for a, r in zip(at, ratios) if abs(a - 30) > 15] + list(ratios)
    assert away.tolist() == kept
    assert listed._away(None, steps, []).tolist() == []


def test_the_weakest_goes_where_not_all_stand_beside_each_other(sessions, monkeypatch):
    asked = []
    stand = lambda regression, terms, steps, *of: asked.append([*steps]) or len(steps) < 2  # noqa: E731
    monkeypatch.setattr(listed, "_stand", stand)
    regression = Regression(sessions)
    left = standing(regression, [A], 1, [])
    assert left == asked[1] == [max(asked[0], key=lambda s: s.ratio)]
    assert len(regression.events()) == 1
    assert standing(Regression([dense.made(0, 12)]), [A], 1, []) == []


def test_what_bends_slowly_is_no_abrupt_change():
    slow = noise(4)
    slow.rate_dps += np.outer(np.clip((np.arange(BLOCKS) - 20) / 16, 0, 1), [20.0, 20.0, -20.0])
    assert find_all(Regression([slow]), []) == []
    sharp = stepped(noise(4), (28, 0.0, [20.0, 20.0, -20.0]))
    assert [s.block for s in find_all(Regression([sharp]), [])] == [28]


@pytest.mark.parametrize(
    ("gap", "degc", "unseen"),
    [((30, 33), 9.0, True), ((30, 32), 9.0, False), ((30, 33), 0.1, False), ((30, 33), None, True)],
)
def test_a_change_across_blocks_without_rest_is_none_where_temperature_moved(gap, degc, unseen):
    session = noise(4)
    session.weight[slice(*gap)] = 0.0
    if degc is not None:
        session.sources["temp"] = np.linspace(0.0, degc, BLOCKS) * BLOCKS / 4
    assert bool(listed._is_unseen(session, gap[1])) is unseen
    assert not listed._is_unseen(session, 5)
    assert not listed._is_unseen(session, 0)


def test_what_was_taken_beside_a_step_may_make_it_by_its_timing():
    session = noise(4)
    session.sources["j"] = np.where(np.arange(BLOCKS) >= 30, 1.0, 0.0)
    regression = Regression([session])
    step = Step(0, 30, np.array([2.0, 0.0, 0.0]), 9.0, 0.0, np.array([0.7, 1.0, 1.0]))
    assert not Step(0, 5, np.zeros(3), 0.0, 1.0).deviation_dps.any()
    forms = [Term("j")]
    assert listed._is_timing(regression, forms, np.array([[2.1, 0.0, 0.0]]), step)
    assert not listed._is_timing(regression, forms, np.array([[2.0, 9.0, 0.0]]), step)
    assert listed._is_timing(regression, forms, np.array([[-2.1, 0.0, 0.0]]), step)
    sure = replace(
        step, size_dps=np.array([2.0, 2.0, 0.0]), deviation_dps=np.array([1.0, 2.0, 9.0])
    )
    for first in (2.49, 2.51):  # the second counts for a quarter
        both = np.array([[first, 0.04, 99.0]])
        assert listed._is_timing(regression, forms, both, sure) is bool(first > 2.5)
    assert sure.times_in(np.array([[3.0, -1.0, 0.0]])) == pytest.approx([1.1])
    session.sources["j"][:] = np.where(np.arange(BLOCKS) >= BLOCKS - 1, 1.0, 0.0)
    last = replace(step, block=BLOCKS)
    assert not listed._is_timing(regression, forms, np.array([[2.1, 0.0, 0.0]]), last)


@pytest.mark.parametrize("size_dps", [0.0, 9.0])
def test_lags_that_the_recordings_show_stay_and_all_others_are_held_at_zero(size_dps):
    walk = np.cumsum(np.random.default_rng(3).normal(0, 1, BLOCKS))
    session, line = noise(4, temp=25 + walk), Term("temp", centre=25.0)
    late = block_basis(Term("temp", lag_s=135.0, lag_mode="difference"), session)
    late = size_dps * (late - late.mean()) / late.std()
    session.rate_dps += np.outer(late, [1.0, -1.0, 1.0])
    regression = Regression([session])
    shrunk = listed._shrunk_lags(regression, [line])
    assert list(shrunk) == lags([session])
    with regression.shrinking(shrunk):
        told = regression.fit([line, *shrunk]).coefficients
    made = predicted([*shrunk], told[1:], session)
    made -= made.mean(axis=0)
    if size_dps:
        assert np.corrcoef(made[:, 0], late)[0, 1] > 0.999
        assert made.std(axis=0) == pytest.approx([size_dps] * 3, rel=0.1)
    else:
        assert np.abs(made).max() < 0.05


def test_a_form_of_several_terms_pays_for_those_that_a_step_does_not_have(sessions):
    regression = Regression(sessions[:1])
    every = [
        Candidate("x", terms, "catalogue") for terms in ((A,), (A, B), parts(Term("a", -3, 9)))
    ]
    gains = [regression.gains([], [c.terms]).sum() for c in every]
    worth = [gains[0], gains[1] - 6.0, gains[2] - 2.0 * (len(every[2].terms) - 1)]
    for some in (slice(0, 2), slice(2, 3), slice(0, 3)):
        form, gain = listed._best_form(regression, [], every[some])
        assert (
            gain == pytest.approx(max(worth[some])) and form is every[worth.index(max(worth[some]))]
        )
    assert listed._best_form(regression, [], []) == (None, 0.0)


def test_what_a_recorded_channel_does_is_no_step():
    switched = np.where((np.arange(BLOCKS) // 15) % 2 > 0, 1.0, 0.0)
    session = noise(4, load=switched)
    session.rate_dps += np.outer(switched, [9.0, -9.0, 9.0])
    assert find_all(Regression([session]), []) == []
    unrecorded = replace(session, sources={n: v for n, v in session.sources.items() if n != "load"})
    assert len(find_all(Regression([unrecorded]), [])) > 0


@pytest.mark.parametrize(("beyond", "stands"), [(-3.9, True), (-4.0, False)])
def test_a_step_stands_beside_a_ramp_with_those_within_eight_blocks_taken_out(
    monkeypatch, beyond, stands
):
    there = []
    monkeypatch.setattr(listed, "_set", lambda of, steps, kept: there.append(steps))
    monkeypatch.setattr(
        listed, "beyond_ramps", lambda of, terms, session, at: beyond - (at != 29.5)
    )
    places = [(1, 30, 0.5), (1, 38, 0.0), (1, 39, 0.0), (0, 31, 0.0)]
    steps = [Step(i, b, np.ones(3), 9.0, 0.0, share=share) for i, b, share in places]
    assert listed._is_no_ramp(None, [], steps, steps[0], []) is stands
    assert there == [steps[2:]]


def test_two_are_the_same_within_two_blocks_of_one_session_and_more_of_them_are_rarer():
    one, *others = (Step(s, b, np.zeros(3), 1.0, 1.0) for s, b in ((0, 5), (0, 7), (0, 8), (1, 5)))
    assert [listed._is_same(one, other) for other in others] == [True, False, False]
    assert [listed._is_same(other, one) for other in others] == [True, False, False]
    assert (listed._level(0), listed._level(1), listed._level(3)) == (2e-3, 1e-4, 1e-4)


COLD = Term("temp", centre=20.0)


@pytest.mark.parametrize(
    ("term", "per_degc"),
    [
        *((COLD, 1.0), (replace(COLD, power=2), 10.0), (replace(COLD, power=3), 75.0), (A, 0.0)),
        (replace(COLD, lag_s=10.0, lag_mode="lag", power=2), 10.0 * (1 - np.exp(-2.0)) / 2),
        (replace(COLD, lag_s=10.0, lag_mode="rate"), (1 - np.exp(-2.0)) / 20.0),
    ],
)
def test_a_jump_of_temperature_moves_a_term_by_its_slope_less_what_a_lag_forgets(term, per_degc):
    assert steps_first._slope(term, 25.0, 20.0) == pytest.approx(per_degc)


@pytest.mark.parametrize(
    ("degc", "beside", "reading_degc", "explained"),
    [
        *((0.4, 0.99, 0.5, True), (-0.4, 0.99, 0.5, True), (0.4, 1.01, 0.5, False)),
        *((0.4, 0.99, None, False), (0.5 + 0.99, 0.0, 0.5, True), (0.5 + 1.01, 0.0, 0.5, False)),
        *((-0.5 - 0.99, 0.0, 0.5, True), (-0.5 - 1.01, 0.0, 0.5, False)),
    ],
)
@pytest.mark.parametrize("block", [37, BLOCKS])
def test_a_step_that_a_reading_of_the_thermometer_explains_is_none(
    block, degc, beside, reading_degc, explained
):
    temp = 25 + 9 * np.sin(np.arange(BLOCKS) / 9)
    session = replace(noise(4, temp=temp), temp_step_degc=reading_degc)
    session.rate_dps += np.outer(temp, [3.0, -2.0, 1.0])
    regression, late = Regression([session]), {Term("temp", lag_s=45.0, lag_mode="lag"): 9.0}
    line, bend = steps_first.bend_of(session)
    with regression.shrinking(late):
        own, squares, lagged = regression.fit([line, bend, *late]).coefficients
    warm = temp[min(block, BLOCKS - 1)]
    slope = own + 2 * (warm - temp.mean()) * squares
    slope += lagged * 45.0 / 20.0 * (1 - np.exp(-20.0 / 45.0))
    deviation = np.array([0.3, 0.2, 0.5])
    deviation *= np.linalg.norm(slope / deviation) / np.sqrt(chi2.isf(1e-3, 2))  # of 1 degC
    aside = np.array([1.0, 0.0, -slope[0] / deviation[0] / (slope[2] / deviation[2])])
    aside *= deviation * np.sqrt(chi2.isf(1e-3, 2)) / np.linalg.norm(aside)
    step = Step(0, block, degc * slope + beside * aside, 9.0, 0.0, deviation)
    told = steps_first._is_thermometers(regression, [line, bend], late, step)
    assert told is explained
    assert not steps_first._is_thermometers(Regression([noise(4)]), [], {}, step)


@pytest.mark.parametrize(
    ("at", "seen"), [(90, True), (89, False), (129, True), (130, False), (1, False), (110, True)]
)
def test_a_knock_counts_within_ten_ticks_of_a_step(at, seen):
    force = np.zeros(200)
    force[at:] += 0.5
    sources = {"acc_x": force, "acc_y": -force, "acc_z": np.ones(200)}
    told, said = steps_first._by_accelerometer(SimpleNamespace(sources=sources), 100, 120)
    assert (told, "0.71 g" in said) == ((at, True) if seen else (None, False))


def in_ticks(known, jump, size=(1.0, -1.0, 0.0), **sources):
    """12 blocks of 10 ticks of 2 s, of which some are known; after a jump the bias is another."""
    level = np.arange(120.0)[:, None] >= jump
    ticks = np.where(known[:, None], level * np.array(size), np.nan)
    session = replace(noise(4, 12), ticks_per_block=10, ticks_dps=ticks)
    return replace(session, sources=sources)


TICKS = np.arange(120)


@pytest.mark.parametrize(
    ("known", "jump", "tick"),
    [
        (TICKS >= 0, 63, 63.0),
        *((TICKS >= 0, 33, 41.0), (TICKS >= 0, 80, 79.0)),  # two blocks off at most
        ((TICKS < 60) | (TICKS > 66), 63, 63.5),  # in the middle of what is not known
        (TICKS < 50, 99, 49.5),
        (TICKS > 59, 0, 60.5),
    ],
)
def test_a_step_is_in_the_middle_of_the_ticks_where_it_may_have_been(known, jump, tick):
    step = Step(0, 6, np.array([1.0, -1.0, 0.0]), 9.0, 0.0, np.array([0.1, 0.1, 1.0]))
    other = np.outer(TICKS >= 30, [0.0, 5.0, 9.0])
    session = in_ticks(known, jump)
    session.ticks_dps += other
    told = steps_first._timed(session, step, other)
    assert (told.at_s, told.said) == (2.0 * tick, "")
    assert steps_first._timed(replace(session, ticks_dps=None), step, other) is step


def test_a_knock_within_its_ticks_has_the_step_s_moment():
    force = (TICKS > 68) * 0.5
    session = in_ticks((TICKS < 60) | (TICKS > 66), 63, acc_x=force, acc_y=force, acc_z=force)
    step = Step(0, 6, np.array([1.0, -1.0, 0.0]), 9.0, 0.0, np.ones(3))
    told = steps_first._timed(session, step, np.zeros((120, 3)))
    assert told.at_s == 138.0 and "0.87 g" in told.said
    shaken = np.where(TICKS == 64, 0.01, 0.0009)  # squares of what shakes within a tick
    quiet = in_ticks(TICKS >= 0, 63, vib=shaken, **{f"acc_{a}": 0.0 * TICKS for a in "xyz"})
    told = steps_first._timed(quiet, step, np.zeros((120, 3)))
    assert told.at_s == 128.0 and "0.07 g" in told.said


@pytest.mark.parametrize(
    ("second", "undone"),
    [
        ((0, 32, 0.0, -0.1), True),
        ((0, 33, 0.5, -0.1), True),
        ((0, 33, 0.25, -0.1), False),
        ((0, 32, 0.0, 0.1), False),
        ((1, 32, 0.0, -0.1), False),
    ],
)
def test_two_that_undo_each_other_within_two_blocks_are_a_disturbance(second, undone):
    session, block, share, size = second
    first = Step(0, 31, np.ones(3), 9.0, 0.0, share=0.5)
    other = Step(session, block, np.full(3, size), 9.0, 0.0, share=share)
    assert steps_first._undoes(first, other) is undone


@pytest.mark.parametrize(
    ("second", "sign", "listed"), [(31, 1, [2.0]), (31, -1, [1.0, -1.0]), (32, 1, [1.0, 1.0])]
)
def test_a_step_that_two_blocks_in_turn_show_is_one(monkeypatch, second, sign, listed):
    one = Step(0, 30, np.ones(3), 9.0, 0.0, np.full(3, 0.3))
    two = Step(0, second, sign * np.ones(3), 9.0, 0.0, np.full(3, 0.4))
    monkeypatch.setattr(steps_first, "hold_disturbed", lambda *of: None)
    monkeypatch.setattr(steps_first, "steps_and_lags", lambda *of: ([two, one], {}))
    found = steps_first._steps(noise(4), 1)
    assert [s.size_dps.tolist() for s in found] == [[size] * 3 for size in listed]
    assert found[0].block == 30
    assert found[0].deviation_dps == pytest.approx([0.5 if len(listed) == 1 else 0.3] * 3)


def test_errors_of_pieces_are_compared_with_the_best_bend_by_their_geometric_mean():
    left = {
        "whole": [[1.0, 2.0, 4.0]],
        "a": [[3.0, 3.0, 3.0], [np.nan] * 3],
        "b": [[2.0, 4.0, 8.0]],
    }
    pieces = SimpleNamespace(residual=lambda straight, terms: np.array(left[terms]))
    factor = hysteresis._factor([], ["a", "b"], "whole", pieces)
    assert factor == pytest.approx(3.0 / 2.0)


def test_widths_are_tried_as_shares_of_the_range_about_its_middle():
    sessions = [dense.made(seed, 24, names=("temp",)) for seed in (1, 2)]
    for s in sessions:
        s.sources["temp"] = np.linspace(10.0, 27.0, 24)
    fits = hysteresis._Fits(sessions, [COLD])
    assert fits._grid[[0, -1]] == pytest.approx([17 * hysteresis._FINEST, 17 * hysteresis._WIDEST])
    assert (fits._lo, fits._hi, fits._centre) == pytest.approx((10.0, 27.0, 18.5))
    temp = sessions[0].sources["temp"]
    line = np.tile(temp - temp.mean(), 2)
    off = np.vstack([s.rate_dps - s.rate_dps.mean(axis=0) for s in sessions])
    assert fits.rows == 48
    assert fits._y == pytest.approx(off - np.outer(line, line @ off) / (line @ line))
    column = play(temp, 6.0)
    for power in (1, 2):
        off = np.tile(((column - 18.5) / 8.5) ** power, 2)
        off -= off.mean()
        assert fits._column(3.0, power) == pytest.approx(off - line * (line @ off) / (line @ line))
