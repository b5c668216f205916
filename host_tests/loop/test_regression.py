"""A fit is what the textbook gives, with whole covariance matrices in float64."""

from dataclasses import replace

import numpy as np
import pytest
from zerorate_bench.loop.simulated import simulate
from zerorate_tools.loop.fit.cross_products import GappyWhitener, cross_products, whitener
from zerorate_tools.loop.fit.likelihood import session_scale
from zerorate_tools.loop.fit.regression import Regression
from zerorate_tools.model.term import Term

from . import dense
from .dense import SCALE, A, B, C, D
from .selections import step


def problems(sessions, terms):
    return [dense.problem(sessions, terms, SCALE[:, a]) for a in range(3)]


def test_a_fit_is_that_of_generalised_least_squares_under_every_colour(regression, with_gap):
    fit = regression.fit([A, B])
    for a, p in enumerate(problems(with_gap, [A, B])):
        likely, told, squares, inverse = dense.fitted(p, a)
        constant = fit.base.loglik[a] - likely
        assert constant == pytest.approx(np.zeros(len(likely)), abs=1e-5)
        assert fit.base.rss[a] == pytest.approx(squares, rel=1e-7)
        assert fit.base.coefficients[a] == pytest.approx(told, rel=1e-5, abs=1e-9)
        assert fit.base.inverse[a] == pytest.approx(inverse, rel=1e-6, abs=1e-12)
        best = likely.argmax()
        assert fit.base.best[a] == best and fit.base.count == len(p.y)
        assert fit.coefficients[:, a] == pytest.approx(told[best], rel=1e-5)
        assert fit.base.variance[a] == pytest.approx(squares[best] / len(p.y), rel=1e-7)
        assert fit.base.unscaled[a] == pytest.approx(inverse[best], rel=1e-6)
    assert fit.total == pytest.approx(sum(fit.base.loglik.max(axis=1)))


def test_a_candidate_s_ratio_is_twice_what_the_likelihood_gains(regression, with_gap):
    def likeliest(*terms):
        each = enumerate(problems(with_gap, [A, B, *terms]))
        return np.array([dense.fitted(p, a)[0].max() for a, p in each])

    more = [(C,), (D,), (C, D)]
    found = regression.gains([A, B], [*more, (B,), (A,)], chunk=2)
    expected = [2 * (likeliest(*terms) - likeliest()) for terms in more]
    assert found[:3] == pytest.approx(np.array(expected), rel=1e-4, abs=1e-6)
    assert np.abs(found[3:]).max() < 1e-6  # what is fitted already gains nothing


def test_two_columns_all_but_alike_gain_what_one_of_them_does(regression, with_gap):
    for s in with_gap:
        s.sources["twin"] = s.sources["c"] * (1 + 1e-9)
    one, both = regression.gains([A], [(C,), (C, Term("twin"))])
    assert both == pytest.approx(one, rel=1e-3, abs=1e-6)


def test_a_short_gap_is_a_straight_line_in_every_column():
    bridged = dense.made(4, 40, gap=(7, 8))
    there, at = np.flatnonzero(bridged.available), np.arange(40)
    columns = np.column_stack([bridged.rate_dps, bridged.sources["a"], bridged.sources["b"]])
    drawn = np.column_stack([np.interp(at, there, c[there]) for c in columns.T])
    p = dense.problem([dense.made(4, 40)], [A])
    q = dense.contrasts(dense.made(4, 40))
    w = whitener(bridged.available)
    made = w.prepare(columns)
    g = cross_products([w], [made[:, :3]], [made[:, 3:4]], [made[:, 4:]])
    assert g.count.tolist() == [37]
    for row, v in enumerate(p.v):
        to = np.linalg.inv(v)
        every = (q.T @ drawn).T @ to @ (q.T @ drawn)
        assert g.yy[0, row] == pytest.approx(np.diag(every)[:3], rel=1e-7)
        assert g.zy[0, row, 0] == pytest.approx(every[3, :3], rel=1e-6, abs=1e-9)
        assert g.zz[0, row] == pytest.approx(every[3:4, 3:4], rel=1e-7)
        assert g.xy[0, row, 0, 0] == pytest.approx(every[4, :3], rel=1e-6, abs=1e-9)
        assert g.xz[0, row, 0, 0] == pytest.approx(every[4, 3:4], rel=1e-6, abs=1e-9)
        assert g.xx[0, row, 0] == pytest.approx(every[4:, 4:], rel=1e-7)
        assert g.logdet[0, row] == pytest.approx(np.linalg.slogdet(v)[1], rel=1e-7)
    assert len(g.logdet[0]) == len(dense.SHAPES)
    assert whitener(bridged.available) is w


def test_whitened_columns_that_are_known_are_given_again_and_no_more_are_kept_than_may_be():
    there = np.ones(20, bool)
    there[3:15] = False
    plain, w = GappyWhitener(there), GappyWhitener(there)
    w._most = 3
    rng = np.random.default_rng(0)
    x, y = w.prepare(rng.normal(size=(20, 1))), w.prepare(rng.normal(size=(20, 8)))
    for columns in (y[:, :3], y[:, 2:5], y):
        for one, other in zip(w.products(x, columns), plain.products(x, columns)):
            assert one == pytest.approx(other)
        assert len(w._known) <= 3


def test_what_an_earlier_step_took_is_a_nuisance_of_its_session(with_gap):
    stepped = replace(with_gap[1], steps=(step(9),))
    behind = (np.arange(21) >= 9)[:, None]
    plain, moved = (
        Regression([with_gap[0], replace(stepped, rate_dps=stepped.rate_dps + dps * behind)])
        for dps in (0.0, 5.0)
    )
    fit = plain.fit([A])
    assert fit.coefficients == pytest.approx(moved.fit([A]).coefficients, rel=1e-6)
    assert fit.base.fitted.shape == (3, 2) and len(plain.events()) == 1
    plain.set_events([[np.arange(18.0) > 4, np.zeros(21)]])
    assert len(plain.events()) == 2
    plain.set_events([], kept=[])
    assert plain.events() == []
    plain.set_events([])
    assert len(plain.events()) == 1


def test_turned_axes_are_turned_back_and_coefficients_are_of_the_sensor(regression):
    plain = regression.fit([A, B]).coefficients
    turned = np.array([[0.6, 0.8, 0.0], [-0.8, 0.6, 0.0], [0.0, 0.0, 2.0]])
    alike = Regression(regression.sessions)
    straight = alike.fit([A, B]).coefficients
    alike.turn(np.diag([3.0, 0.5, 2.0]))
    assert alike.fit([A, B]).coefficients == pytest.approx(straight, rel=1e-6)
    regression.turn(turned)
    rate = regression.sessions[0].rate_dps @ turned.T
    assert regression.y[0] == pytest.approx(regression.whiteners[0].prepare(rate))
    with regression.in_sensor_axes():
        assert regression.fit([A, B]).coefficients == pytest.approx(plain)
    assert (regression.axes == turned).all()
    assert regression.y[0] == pytest.approx(regression.whiteners[0].prepare(rate))


@pytest.mark.parametrize(("times", "told"), [(1.16, 1.0), (1.23, 1.23**0.5)])
def test_a_session_is_noisier_beyond_two_and_a_half_deviations_of_what_it_may_seem(times, told):
    one = dense.white(1, 400)
    loud = replace(one, rate_dps=times * one.rate_dps)
    scale = session_scale(Regression([one, loud]).cross_products([]))
    assert scale == pytest.approx(np.outer([1 / told, told], np.ones(3)))


def test_a_block_is_an_outlier_beyond_six_robust_deviations_from_nine_neighbours():
    made = dense.white(7, 900)
    made.rate_dps[::45, 1] += np.linspace(-13, 13, 20)
    regression = Regression([made])
    regression.settle([])
    held = 0
    for a in range(3):
        column = made.rate_dps[:, a]
        padded = np.r_[[column[0]] * 4, column, [column[-1]] * 4]
        middle = np.median(np.lib.stride_tricks.sliding_window_view(padded, 9), axis=1)
        off = np.abs(column - middle)
        out = off > 6 * 1.4826 * np.median(off)
        assert regression.rate[0][:, a] == pytest.approx(np.where(out, middle, column))
        held += out.sum()
    assert regression.outliers == held and 2 < held < 15
    few = Regression([dense.made(8, 12, gap=range(2, 8))])
    few.rate[0][0] = 1e6
    few.settle([A])
    assert few.outliers == 0


# 6 mdps of noise a block over a hundred poses and more, thrice
FLOOR_DPS_A_G2 = 0.003


def test_the_sum_of_squares_that_gravity_holds_gets_no_coefficient_from_noise():
    rng = np.random.default_rng(3)
    session = simulate(4).sessions[0]
    poses = rng.normal(size=(session.blocks, 3))
    poses /= np.linalg.norm(poses, axis=1)[:, None]
    read_g = poses + (0.03, -0.02, 0.04) + rng.normal(0.0, 4e-4, poses.shape)
    names = ("acc_x", "acc_y", "acc_z")
    sources = {n: np.repeat(g, session.ticks_per_block) for n, g in zip(names, read_g.T)}
    turned = replace(session, sources=sources, rate_dps=session.rate_dps + 0.08 * poses)
    terms = [Term(n, power=power) for power in (1, 2) for n in names]
    fitted = Regression([turned]).fit(terms).coefficients
    assert np.abs(fitted[3:].sum(axis=0)).max() < 3 * FLOOR_DPS_A_G2
    assert fitted[:3] == pytest.approx(0.08 * np.eye(3), abs=FLOOR_DPS_A_G2)
