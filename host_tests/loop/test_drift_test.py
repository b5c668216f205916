"""What follows time alone: more than the noise, and again at every power-on."""

import numpy as np
import pytest
from zerorate_bench.loop.simulated import simulate
from zerorate_tools.loop.fit.noise import spectra
from zerorate_tools.loop.fit.regression import Regression
from zerorate_tools.loop.search import drift_test
from zerorate_tools.loop.search.catalogue import Candidate
from zerorate_tools.loop.search.select import Search
from zerorate_tools.model.term import Term

DRIFT = (Term("time"),)
LOW = drift_test.lowness(spectra(180))


def noise(seed, sessions=3):
    """Sessions of nothing but noise."""
    device = simulate(seed, sessions=sessions, bare=True)
    for s, alone in zip(device.sessions, device.noise_dps):
        s.rate_dps = alone
    return device.sessions


def drifting(slopes_dps_an_hour):
    sessions = noise(3)
    for s, slope in zip(sessions, slopes_dps_an_hour):
        hours = np.linspace(0.0, 1.0, s.blocks)
        s.rate_dps = s.rate_dps + np.outer(hours, [slope, -slope, 0.5 * slope])
    return Regression(sessions)


def test_two_chances_together_are_fishers():
    assert drift_test.together(0.03) == pytest.approx(0.03)
    assert drift_test.together(0.05, 0.05) == pytest.approx(0.0175, abs=1e-4)


def test_noises_alike_cost_nothing_and_one_that_is_steeper_than_the_others_does():
    slow, white = LOW.argmax(), LOW.argmin()
    same, other = np.full((3, len(LOW)), -1e6), np.full((3, len(LOW)), -1e6)
    same[:, slow] = 0.0
    other[[0, 1, 2], [slow, white, white]] = 0.0
    assert drift_test.common_colour(same, LOW) == pytest.approx(0.0, abs=0.1)
    assert drift_test.common_colour(other, LOW) < -5.0


def test_a_drift_that_comes_again_has_a_mean_and_one_that_turns_about_has_a_spread():
    mean, spread = drift_test.repeats(drifting([0.01, 0.01, 0.01]), [], DRIFT)
    assert mean > 100 and spread < 25
    mean, spread = drift_test.repeats(drifting([0.01, -0.01, 0.0]), [], DRIFT)
    assert spread > 30 and mean < 5


def test_a_drift_that_turns_about_is_noise():
    assert drift_test.chance(drifting([0.01, 0.01, 0.01]), [], DRIFT) < 1e-6
    assert drift_test.chance(drifting([0.01, -0.01, 0.0]), [], DRIFT) > 0.05


def test_in_noise_alone_the_chance_is_hardly_smaller_than_it_says():
    chances = [drift_test.chance(Regression(noise(seed)), [], DRIFT) for seed in range(120)]
    # Fitted on the same hour, the noise's colour takes some drift of its own for an effect.
    assert np.mean(np.array(chances) < 0.1) < 0.25
    assert min(chances) > drift_test.LEVEL


def test_more_power_ons_show_a_smaller_drift():
    each = [drift_test.smallest_square(4.0, 3, sessions) / sessions for sessions in (2, 3, 6)]
    assert each == sorted(each, reverse=True)
    assert 2 < each[-1] < each[0] < 10


def test_only_what_needs_no_channel_follows_time():
    def follows(**fields):
        return drift_test.follows_time(Candidate("any", (Term(**fields),), "catalogue"))

    assert follows(source="time") and follows(source="one", decay_s=300.0)
    assert not follows(source="temp") and not follows(source="time", second="temp")


@pytest.mark.parametrize("seed", [5000012, 5000024])
def test_a_drift_of_twice_the_floor_is_found_beside_a_walking_noise(seed):
    found = Search(simulate(seed, [("time-drift", 2.0)]).sessions[:-1]).run().found
    assert [f.candidate.kind for f in found] == ["time-drift"]
