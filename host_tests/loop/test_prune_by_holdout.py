"""What the session held out speaks against is taken out again."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
from zerorate_bench.loop.simulated import simulate
from zerorate_tools.loop.analyse import analyse
from zerorate_tools.loop.fit.line import deployed
from zerorate_tools.loop.report.in_words import in_words
from zerorate_tools.loop.report.report import report
from zerorate_tools.loop.search.catalogue import Candidate
from zerorate_tools.loop.search.decide import Decision
from zerorate_tools.loop.search.select import select
from zerorate_tools.loop.search.selection import Found
from zerorate_tools.loop.verify.judge import judge
from zerorate_tools.loop.verify.prune_by_holdout import (
    prune_by_holdout,
    without_harmful,
    without_marginal,
)
from zerorate_tools.model.term import Term


def kinds(selection):
    return [f.candidate.kind for f in selection.found]


def doubting(judge, selection, holdout):
    """The judgement with a likelihood that speaks against everything."""
    judgement = judge(selection, holdout)
    return replace(judgement, gains=np.full_like(judgement.gains, -2.0))


@pytest.fixture(scope="module")
def turning_about():
    """Three power-ons that drift alike and a fourth that drifts back."""
    sessions = simulate(5).sessions
    for s, slope in zip(sessions, (0.01, 0.01, 0.01, -0.01)):
        s.rate_dps += np.outer(np.linspace(0.0, 1.0, s.blocks), [slope, -slope, slope])
    return sessions


def test_a_drift_that_the_last_power_on_does_not_show_is_withdrawn(turning_about):
    selection = select(turning_about[:-1])
    assert kinds(selection) == ["time-drift"]
    left, judgement = prune_by_holdout(selection, turning_about[-1:])
    assert kinds(left) == [] and [name for name, _ in left.withdrawn] == ["time-drift"]
    assert judgement.after_rms == judgement.before_rms


def test_what_was_withdrawn_is_said_with_both_errors(turning_about):
    result = report(analyse(turning_about))
    [(name, why)] = result["gate"]["withdrawn"]
    assert name == "time-drift" and "does not come again" in why
    assert "taken out again: time-drift: " in in_words(result)
    assert result["effects"] == [] and result["before_mdps"] == result["after_mdps"]


def test_what_noise_steeper_than_a_walk_feigns_is_withdrawn():
    sessions = simulate(6300013, noise_kind="steep").sessions
    selection = select(sessions[:-1])
    assert kinds(selection) == ["time-drift"]
    assert kinds(prune_by_holdout(selection, sessions[-1:])[0]) == []


def test_what_makes_the_error_smaller_stays_whatever_its_likelihood(monkeypatch):
    sessions = simulate(11, [("supply-voltage", 5.0)]).sessions
    monkeypatch.setattr(
        "zerorate_tools.loop.verify.prune_by_holdout.judge", partial(doubting, judge)
    )
    left, judgement = prune_by_holdout(select(sessions[:-1]), sessions[-1:])
    assert judgement.gains[0] < -1 and judgement.after_rms < judgement.before_rms
    assert kinds(left) == ["supply-voltage"] and not left.withdrawn


def never_asked(effect):
    raise AssertionError(f"effect {effect} is not in doubt")


def test_what_takes_hardly_anything_goes_where_one_recording_was_fitted():
    selection = select(simulate(11, [("supply-voltage", 5.0)]).sessions[:-1])
    after = [np.full((4, 3), 1.0), np.column_stack([np.full(4, e) for e in (0.97, 0.94, 0.5)])]
    parts = [[residual] for residual in after]
    assert without_harmful(selection, parts, never_asked) is selection
    [one] = without_harmful(replace(selection, alone=True), parts, never_asked).found
    assert one.axes == (False, True, True)
    # a slope takes the place of the firmware's own curve, of which a line shows nothing
    slope = Candidate("temperature-polynomial", (Term("temp", 10.0, 40.0),), "catalogue")
    with_slope = replace(selection, alone=True, found=[Found(slope, selection.found[0].decision)])
    assert without_harmful(with_slope, parts, never_asked) is with_slope


def test_what_takes_less_than_a_tenth_over_the_axes_goes_where_one_recording_was_fitted():
    selection = select(simulate(11, [("supply-voltage", 5.0)]).sessions[:-1])
    bend = Candidate("temperature-quadratic", (Term("temp", 10.0, 40.0, power=2),), "catalogue")
    bent = replace(selection, found=[Found(bend, selection.found[0].decision)])
    before, little, enough = ([np.full((4, 3), [1.0, e, e])] for e in (1.0, 0.9, 0.8))
    [(_, said)] = without_marginal(replace(bent, alone=True), [before, little]).withdrawn
    assert "hardly falls" in said
    for other, after in ((bent, little), (replace(selection, alone=True), little)):
        assert without_marginal(other, [before, after]) is other
    alone = replace(bent, alone=True)
    assert without_marginal(alone, [before, enough]) is alone


def test_what_the_session_held_out_is_the_worse_for_goes():
    sessions = simulate(11, [("supply-voltage", 5.0)]).sessions
    last = sessions[-1]
    last.sources["vdd_mv"] = 6600.0 - last.sources["vdd_mv"]
    left, _ = prune_by_holdout(select(sessions[:-1]), [last])
    [(name, why)] = left.withdrawn
    assert name == "supply-voltage" and "speaks against it by" in why


def test_a_cause_that_rests_in_the_session_held_out_stays():
    sessions = simulate(11, [("vibration", 5.0)]).sessions
    last = sessions[-1]
    last.rate_dps = simulate(11).noise_dps[-1].copy()
    last.sources["vib"] = np.full_like(last.sources["vib"], sessions[0].sources["vib"].mean())
    selection, _ = prune_by_holdout(select(sessions[:-1]), [last])
    assert kinds(selection) == ["vibration"] and not selection.withdrawn


def test_an_axis_whose_error_would_grow_is_left_alone():
    sessions = simulate(11, [("supply-voltage", 5.0)]).sessions
    last, without = sessions[-1], simulate(11).sessions[-1]
    last.rate_dps[:, 0] = (2 * without.rate_dps - last.rate_dps)[:, 0]
    left, judgement = prune_by_holdout(select(sessions[:-1]), [last])
    assert kinds(left) == ["supply-voltage"] and left.found[0].axes == (False, True, True)
    assert (judgement.after_dps <= judgement.before_dps).all()
    assert (deployed(left)[1][-1] != 0).tolist() == [False, True, True]


def test_no_effect_reaches_further_than_blocks_that_judged_it():
    sessions = simulate(11, [("vibration", 5.0)]).sessions
    for s in sessions:
        s.sources["vib"][100 * s.ticks_per_block] = 40.0
    (found,) = select(sessions).found
    assert found.candidate.kind == "vibration" and found.candidate.terms[0].hi < 0.1


@pytest.mark.parametrize(
    "errors, without_it, stays",
    [
        ([1.0, 1.2, 0.5], 0.7, True),  # the second is the worse without the first
        ([1.0, 1.2, 0.5], 0.4, False),  # the second does better alone
        ([1.0, 1.2, 1.1], 1.3, False),  # both together do harm
    ],
)
def test_an_effect_that_a_later_one_needs_stays(errors, without_it, stays):
    kind = Candidate("thermal-lag", (Term("temp", lag_s=60.0, lag_mode="lagged"),), "catalogue")
    both = [Found(kind, Decision(True, 0.0, 0.0, 1.0, np.zeros(1))) for _ in range(2)]
    selection = replace(select(simulate(2, sessions=1, bare=True).sessions), found=both)
    parts = [[np.full((4, 3), e)] for e in errors]
    assert (
        without_harmful(selection, parts, lambda i: [np.full((4, 3), without_it)]) is selection
    ) == stays


@pytest.mark.parametrize("seed", range(3))
def test_each_pass_takes_something_away_until_nothing_is_worse(seed):
    rng = np.random.default_rng(seed)
    kind = Candidate("vibration", (Term("vib"),), "catalogue")
    found = [Found(kind, Decision(True, 0.0, 0.0, 1.0, np.zeros(1))) for _ in range(3)]
    left = replace(select(simulate(2, sessions=1, bare=True).sessions), found=found)
    for _ in range(9):
        after = [[rng.normal(size=(4, 3))] for _ in range(len(left.found) + 1)]
        less = without_harmful(left, after, lambda i: [rng.normal(size=(4, 3))])
        if less is left:
            break
        assert less.applied.sum() < left.applied.sum()
        left = less
    assert without_harmful(replace(left, found=[]), after[:1], never_asked).found == []
