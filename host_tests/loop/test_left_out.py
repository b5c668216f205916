"""How a fit predicts sessions left out, how large its weights are, and what all axes share."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import chi2
from zerorate_tools.loop.fit import shrunk as shrinking
from zerorate_tools.loop.fit.common_cause import coherence, turned_axes
from zerorate_tools.loop.fit.left_out import gains, of_plays
from zerorate_tools.loop.fit.regression import Regression
from zerorate_tools.model.term import Term, play

from . import dense
from .dense import SCALE, A, B


def test_a_session_left_out_is_predicted_by_the_others_alone(regression, with_gap):
    full = regression.fit([A, B]).base
    wide = full.variance / (full.fitted[:, 1] ** 2).mean()

    def lost(s, terms):
        """Squares of a session, by coefficients of the others, in units of the noise."""
        total = 0.0
        for a in range(3):
            p = dense.problem(with_gap, terms, SCALE[:, a])
            to, own = np.linalg.inv(p.v[full.best[a]]), p.rows[s]
            rest = np.delete(np.arange(len(p.y)), own)
            x, y, v = p.x[rest], p.y[rest, a], to[np.ix_(rest, rest)]
            # normal about zero, as wide as it is on all axes
            zz = x.T @ v @ x + np.diag([0.0, wide[a]][: len(terms)])
            left = p.y[own, a] - p.x[own] @ np.linalg.solve(zz, x.T @ v @ y)
            total += left @ to[own, own] @ left / full.variance[a]
        return total

    expected = [0.5 * (lost(s, [A]) - lost(s, [A, B])) for s in range(3)]
    assert gains(regression, [A], [B]) == pytest.approx(expected, rel=1e-4, abs=1e-7)


PLAYS = {
    "p": replace(A, memory="play", width=1.0),
    "q": replace(A, memory="play", width=2.5),
    "r": replace(A, memory="play", width=1.0, power=2),
}


ALONE = [(size,) for size in dense.SIZES]


WITH_SQUARES = [(size, size * of) for size in dense.SIZES for of in (1e-3, 0.1, 10**-0.5, 1.0)]


def played(session):
    """The session with what the play operators make of its source as sources of their own."""
    made = {n: play(session.sources["a"], t.width) ** t.power for n, t in PLAYS.items()}
    return replace(session, sources={**session.sources, **made})


@pytest.mark.parametrize(
    ("names", "groups", "sizes", "white", "how"),
    [
        ("bpq", [[1, 2]], ALONE, True, {}),
        ("bpq", [[1, 2]], ALONE, True, {"alike": False}),
        ("bprq", [[1, 3], [2]], WITH_SQUARES, False, {}),  # squares have a size of their own
        ("pr", [[0], [1]], WITH_SQUARES, True, {}),  # with nothing beside them
        ("dbc", [[1, 2]], ALONE, False, {"own": slice(1, 3), "alike": False}),
    ],
)
def test_weights_are_the_mean_of_their_distribution(names, groups, sizes, white, how):
    sessions = [dense.made(11, 14), dense.made(12, 18, gap=range(6, 12))]
    shapes = dense.WHITE if white else dense.SHAPES
    p = dense.problem([*map(played, sessions)], [Term(n) for n in names], shapes_=shapes)
    nats, mean = dense.shrunk(p, groups, sizes, **{"alike": how.get("alike", True)})
    terms, regression = [PLAYS.get(n, Term(n)) for n in names], Regression(sessions, white=white)
    g = regression.cross_products(terms)
    told = shrinking.shrink(g, regression.scale, terms, **how)
    assert told.coefficients == pytest.approx(mean, rel=1e-4, abs=1e-7)
    assert told.nats == pytest.approx(nats, abs=1e-5)
    held = np.isin(np.arange(len(names)), sum(groups, []))
    assert ((told.precision > 0) == held).all()
    if not how:
        assert (of_plays(g, regression.scale, terms) == told.precision).all()
        assert (of_plays(g, regression.scale, [B] * len(terms)) == 0).all()


def test_the_chance_of_a_common_cause_is_bartletts(with_gap):
    regression = Regression(with_gap[:2])
    fit = regression.fit([A])
    left, chances = regression.left([A], fit), {}
    for lowest in (3, 6, 12, 24):
        rows = []
        for own, s in zip(left, with_gap):
            colour = [dense.spectrum(dense.SHAPES[g], s.blocks) for g in fit.base.best]
            rows.append((own / np.sqrt(colour).T)[:lowest])
        rows = np.vstack(rows)
        logdet = np.log(np.linalg.det(np.corrcoef(rows.T)))
        chances[lowest] = 4 * chi2.sf(-(len(rows) - 1 - 11 / 6) * logdet, 3)
    p, covariance = coherence(regression, [A])
    assert p == pytest.approx(min(1.0, *chances.values()), rel=1e-4)
    at = min(chances, key=chances.get) if p < 1 else 3
    low = np.vstack([r[:at] for r in left])
    assert covariance == pytest.approx(low.T @ low / len(low))


def test_turned_axes_have_equal_white_noise_and_the_first_is_along_what_is_common(with_gap):
    regression = Regression(with_gap[:2])
    axes = turned_axes(regression, [A])
    white = np.diag(regression.fit([A]).base.variance)
    assert axes @ white @ axes.T == pytest.approx(np.eye(3), abs=1e-9)
    _, covariance = coherence(regression, [A])
    spread = np.diag(axes @ covariance @ axes.T)
    assert spread[0] >= spread[1] >= spread[2] > 0
    alike = replace(with_gap[0], rate_dps=np.zeros_like(with_gap[0].rate_dps))
    assert (turned_axes(Regression([alike]), [A]) == np.eye(3)).all()
