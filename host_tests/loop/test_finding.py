"""What the search finds on simulated devices, and what it leaves alone. The tables are `zerorate
bench loop`.
"""

from dataclasses import replace

import numpy as np
import pytest
from zerorate_bench.loop.simulated import HOSTILE, simulate
from zerorate_tools.loop.analyse import analyse
from zerorate_tools.loop.read.sessions import block_basis
from zerorate_tools.loop.report.report import report
from zerorate_tools.loop.search.select import select
from zerorate_tools.loop.search.steps_first import remove_steps
from zerorate_tools.loop.verify.judge import judge
from zerorate_tools.loop.verify.prune_by_holdout import (
    prune_by_holdout,
)
from zerorate_tools.model.term import Term


def run_trial(device):
    selection = select(device.sessions[:-1])
    return selection, judge(selection, device.sessions[-1:])


def names(selection):
    return [n for f in selection.found for n in (f.candidate.label, *f.confounded_with)]


@pytest.mark.parametrize("kind", ["plain", *HOSTILE])
def test_nothing_is_found_where_there_is_noise_alone(kind):
    assert names(select(simulate(1, noise_kind=kind).sessions[:-1])) == []


@pytest.mark.parametrize(
    "effect",
    [
        *("temperature-quadratic", "temperature-kink", "thermal-lag", "thermal-hysteresis"),
        *("linear-acceleration", "supply-temperature", "scale-factor"),
    ],
)
def test_an_undeclared_effect_of_three_floors_is_found_named_and_removed(effect):
    selection, judgement = run_trial(simulate(11, [(effect, 3.0)]))
    assert effect in names(selection)
    assert judgement.gains[0] > 10
    assert judgement.after_rms < judgement.before_rms


def test_a_square_of_a_delayed_channel_is_tied_to_that_channel():
    selection, _ = run_trial(simulate(12, [("load-squared-delayed", 3.0)]))
    assert selection.found and selection.found[0].candidate.sources == ["load"]


def test_a_delay_is_found_wherever_it_lies_though_the_channel_switches():
    device, rng = simulate(12), np.random.default_rng(12)
    for s in device.sessions:
        s.sources["load"] = rng.integers(0, 2, s.blocks).repeat(s.ticks_per_block).astype(float)
        late = block_basis(Term("load", delay_s=193.0), s)
        s.rate_dps += np.outer(late, 3.0 * device.floor_dps)
    selection, _ = run_trial(device)
    [found] = selection.found
    assert found.candidate.sources == ["load"]
    assert found.candidate.terms[0].delay_s == pytest.approx(193.0, abs=5.0)


def test_a_product_is_one_effect_wherever_its_factors_are_zero():
    device = simulate(16)
    for s in device.sessions:
        product = Term("vdd_mv", centre=3240.0, second="temp", second_centre=21.0)
        product = replace(product, second_lo=0.0, second_hi=60.0)
        s.rate_dps += np.outer(block_basis(product, s), [6e-6, -4e-6, 3e-6])
    selection, judgement = run_trial(device)
    assert [f.candidate.label for f in selection.found] == ["supply-temperature"]
    # The line over temperature takes what another zero of the voltage would add.
    assert selection.terms[0].second_centre == pytest.approx(21.0, abs=1.5)
    assert judgement.after_rms < 0.7 * judgement.before_rms


def test_a_cause_nobody_recorded_is_never_confirmed_and_said_to_be_left():
    selection, judgement = run_trial(simulate(21, hidden=5.0))
    assert not any(judgement.confidence(i) == "confirmed" for i in range(len(selection.found)))
    assert judgement.residual_test.left


def test_a_path_that_repeats_without_a_temperature_is_told_by_time_and_never_confirmed():
    device = simulate(16, [("power-on-transient", 5.0)])
    for s in device.sessions:
        s.sources.clear()
    analysis = analyse(device.sessions)
    assert analysis.selection.judged_again and not analysis.selection.alone
    [step] = report(analysis)["effects"]
    assert (step["effect"], step["confidence"]) == ("power-on-transient", "tentative")
    assert "cause not identified; no temperature was recorded" in step["said"]


def erring(seed):
    """A line over temperature and noise, where the recorded temperature errs by 0.3 degC."""
    device, rng = simulate(seed, bare=True), np.random.default_rng(seed)
    for s, noise in zip(device.sessions, device.noise_dps):
        at_s = s.time_s()
        warm = 18 + 11 * (1 - np.exp(-at_s / 340)) + rng.normal(0, 2)
        warm += rng.uniform(-2, 2) * np.sin(at_s / 3600 * rng.uniform(2, 4) + rng.uniform(0, 6))
        walk = np.cumsum(rng.normal(size=len(at_s)))
        wander = walk - np.convolve(np.r_[np.full(59, walk[0]), walk], np.ones(60) / 60, "valid")
        s.sources["temp"] = warm + 0.3 * wander / wander.std()
        s.rate_dps = noise + np.outer(s.block_mean(warm), [0.035, -0.001, -0.017])
    return device


def test_a_thermometer_that_errs_makes_no_effect_of_the_warm_up_that_makes_it_worse():
    for seed in (1, 5):
        sessions = erring(seed).sessions
        selection, judgement = prune_by_holdout(select(sessions[:-1]), sessions[-1:])
        assert judgement.after_rms <= judgement.before_rms, names(selection)


def test_a_rate_of_change_is_followed_where_another_day_begins_colder():
    device = simulate(15, [("thermal-rate", 5.0)])
    selection = select(device.sessions[:-1])
    [term] = [f.candidate for f in selection.found][0].terms
    seen = [s.block_mean(s.sources["temp"]) for s in device.sessions[:-1]]
    low, high = min(map(np.min, seen)), max(map(np.max, seen))
    assert term.lag_mode in ("rate", "difference")
    assert term.lo < low - 0.4 * (high - low)


def test_a_source_that_one_session_alone_shows_does_not_hide_what_the_others_show():
    device = simulate(5000014, [("squared-acceleration", 5.0)])
    y = [s.block_mean(s.sources["acc_y"]) ** 2 for s in device.sessions[:3]]
    assert np.ptp(y[0]) < 0.1 and np.ptp(y[2]) < 0.1
    assert "squared-acceleration" in names(select(device.sessions[:-1]))


@pytest.mark.parametrize(
    ("seed", "effect", "named"),
    [
        (5000093, "supply-temperature", "channel-product(vdd_mv, temp)"),
        (5000039, "vibration", "vibration"),
    ],
)
def test_bursts_that_an_effect_explains_are_no_outliers(seed, effect, named):
    sessions = remove_steps(simulate(seed, [(effect, 5.0)]).sessions[:-1])
    selection = select(sessions)
    assert names(selection)[0] == named and not any(s.steps for s in sessions)
    assert selection.outliers <= 3  # of some 500 blocks: a burst at an edge may stay one


def kinds(selection):
    return [f.candidate.kind for f in selection.found]


def test_what_noise_steeper_than_a_walk_feigns_is_withdrawn():
    sessions = simulate(6300013, noise_kind="steep").sessions
    selection = select(sessions[:-1])
    assert kinds(selection) == ["time-drift"]
    assert kinds(prune_by_holdout(selection, sessions[-1:])[0]) == []


def test_a_cause_that_rests_in_the_session_held_out_stays():
    sessions = simulate(11, [("vibration", 5.0)]).sessions
    last = sessions[-1]
    last.rate_dps = simulate(11).noise_dps[-1].copy()
    last.sources["vib"] = np.full_like(last.sources["vib"], sessions[0].sources["vib"].mean())
    selection, _ = prune_by_holdout(select(sessions[:-1]), [last])
    assert kinds(selection) == ["vibration"] and not selection.withdrawn
