"""What follows time must be more than the noise's walk, and come again at every power-on."""

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.stats import chi2, f
from zerorate_tools.loop.fit.left_out import gains
from zerorate_tools.loop.fit.regression import Regression
from zerorate_tools.loop.search import drift_test
from zerorate_tools.model.term import Term

from . import dense
from .dense import SCALE, A, B
from .selections import candidate

FOLLOWS = candidate(A)


def test_chances_taken_together_are_fishers():
    assert drift_test.together(0.2) == pytest.approx(0.2)
    assert drift_test.together(0.2, 0.3) == pytest.approx(chi2.sf(-2 * np.log(0.06), 4))
    assert 0 < drift_test.together(0.0, 1.0) < 1e-290


@pytest.mark.parametrize(
    ("term", "follows"),
    [
        (Term("time"), True),
        (Term("one", decay_s=9.0), True),
        (A, False),
        (Term("time", second="a"), False),
    ],
)
def test_what_follows_the_clock_alone(term, follows):
    assert drift_test.follows_time(candidate(term)) is follows
    assert not drift_test.follows_time(candidate(term, A))


@pytest.fixture
def regression(sessions):
    """Three sessions whose bias follows a source, of noises of different sizes."""
    regression = Regression([dense.following(s) for s in sessions])
    regression.scale = SCALE
    return regression


def test_a_mean_and_a_spread_are_of_the_sessions_own_coefficients(regression):
    base, expected = regression.fit([B, A]).base, np.zeros(2)
    for a, colour in enumerate(base.best):
        p = dense.problem(regression.sessions, [B, A], SCALE[:, a])
        to = np.linalg.inv(p.v[colour])
        z, x, y = p.x[:, :1], p.x[:, 1], p.y[:, a]
        take = np.linalg.solve(z.T @ to @ z, z.T @ to)
        x, y = x - z @ (take @ x), y - z @ (take @ y)
        along = np.array([x[r] @ to[r, r] @ y[r] for r in p.rows])
        size = np.array([x[r] @ to[r, r] @ x[r] for r in p.rows])
        common = along.sum() / size.sum()
        squares = common**2 * size.sum(), ((along - common * size) ** 2 / size).sum()
        expected += np.array(squares) / base.variance[a]
    assert drift_test.repeats(regression, [B], [A]) == pytest.approx(tuple(expected), rel=1e-5)


def test_the_chance_is_that_of_its_size_and_of_its_coming_again(regression):
    mean, spread = drift_test.repeats(regression, [B], [A])
    ratio, free = drift_test.ratio_with_common_colour(regression, [B], [A]), 3 * (3 - 1)
    between = (spread + 4) / (free + 4)
    both = chi2.sf(ratio, 3), f.sf(mean / 3 / between, 3, free + 4)
    expected = np.log(chi2.sf(-2 * np.log(both).sum(), 4))
    told = np.log(drift_test.chance(regression, [B], [A]))
    assert told == pytest.approx(expected) and -600 < expected < 0


@pytest.mark.parametrize(
    ("paid", "accepted", "again"),
    [(0.99e-6, True, True), (1.01e-6, True, False), (1.01e-3, False, False), (9.0, False, False)],
)
def test_a_drift_passes_at_a_thousandth_and_comes_again_at_its_square(
    regression, paid, accepted, again
):
    tried = paid / drift_test.chance(regression, [B], [A])
    told = drift_test.considered(regression, [B], FOLLOWS, 50.0, tried)
    assert (told.p_value, told.tried) == (pytest.approx(min(paid, 1.0)), tried)
    assert (told.accepted, told.ratio, told.inflation) == (accepted, 50.0, 1.0)
    assert ("walk" in told.reason) is not accepted
    assert told.session_gains == pytest.approx(gains(regression, [B], [A]))
    assert drift_test.comes_again(regression, [B], FOLLOWS, tried) is again


def test_a_colour_that_three_axes_share_costs_what_student_s_t_says():
    low = np.array([0.0, 1.0, 2.0])
    likely = np.array([[0.0, -50.0, -50.0], [-50.0, -50.0, -1.0]])
    off = (low - np.linspace(0.0, 2.0, 31)[:, None]) / 0.7
    costs = (likely[:, None] - 2.5 * np.log1p(off**2 / 4)).max(axis=2).sum(axis=0)
    assert drift_test.common_colour(likely, low) == pytest.approx(costs.max())
    spectrum = np.exp(np.array([[4.0, 2.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0]]))
    assert drift_test.lowness(spectrum) == pytest.approx([3.0 - 1.5, 0.0])


@pytest.mark.parametrize(("tried", "sessions"), [(1.0, 2), (20.0, 3)])
def test_the_smallest_square_passes_now_and_with_one_power_on_more(tried, sessions):
    def least(level, count):
        free = 3 * (count - 1) + 4
        both = lambda x: drift_test.together(chi2.sf(x, 3), f.sf(x / 3, 3, free))  # noqa: E731
        return brentq(lambda x: np.log(both(x) * tried / level), 1.0, 500.0)

    squares = least(1e-3, sessions), least(1e-6, sessions + 1) * sessions / (sessions + 1)
    assert drift_test.smallest_square(tried, 3, sessions) == pytest.approx(max(squares))
