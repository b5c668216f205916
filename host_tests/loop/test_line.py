"""The line, smooth curves and free curves of the fit, beside plain least squares."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from zerorate_tools.loop.fit import line
from zerorate_tools.loop.fit.regression import Regression
from zerorate_tools.loop.fit.smooth import curve_of, draw, matern
from zerorate_tools.loop.read.sessions import block_basis
from zerorate_tools.loop.search.selection import deployed as told_by
from zerorate_tools.model.term import Term

from . import dense
from .dense import A, B
from .selections import step

TEMP = Term("temp", 10.0, 40.0, 20.0)
LINE = Term("temp", centre=25.0)


@pytest.fixture(scope="module")
def sessions():
    """Two with a temperature, the second with a gap and a step that was taken out."""
    made = [
        dense.made(1, 30, names=("temp", "a")),
        dense.made(2, 36, range(4, 9), names=("temp", "a")),
    ]
    for s in made:
        s.sources["temp"] = 25 + 3 * s.sources["temp"]
    return [made[0], replace(made[1], steps=(step(12),))]


def with_offsets(sessions, columns, rates):
    """(x, y) of what is there, each stretch of each session less its mean."""
    both = [np.hstack(of) for of in zip(columns, rates)]
    rows = np.vstack([s.less_offsets(v, s.available)[s.available] for s, v in zip(sessions, both)])
    return rows[:, :-3], rows[:, -3:]


def least_squares(sessions, columns, rates):
    return np.linalg.lstsq(*with_offsets(sessions, columns, rates), rcond=None)[0]


def block_columns(terms, session):
    return np.column_stack([block_basis(t, session) for t in terms])


def test_the_line_is_that_of_least_squares_with_an_offset_a_stretch(sessions):
    columns = [np.column_stack([s.sources["temp"] - 25, s.sources["a"]]) for s in sessions]
    expected = least_squares(sessions, columns, [s.rate_dps for s in sessions])
    assert line.ordinary([LINE, A], sessions) == pytest.approx(expected, rel=1e-9)
    still = [replace(s, sources={**s.sources, "b": np.ones(s.blocks)}) for s in sessions]
    with_none = np.vstack([expected, np.zeros(3)])
    assert line.ordinary([LINE, A, B], still) == pytest.approx(with_none, rel=1e-9)


def test_effects_are_taken_from_the_rates_before_the_line_is_fitted(sessions):
    given = np.array([[0.5, -1.0, 2.0]])
    less = [s.rate_dps - np.outer(s.sources["a"], given) for s in sessions]
    expected = least_squares(sessions, [s.sources["temp"][:, None] for s in sessions], less)
    assert line.ordinary([LINE], sessions, [A], given) == pytest.approx(expected, rel=1e-9)


def test_play_operators_are_as_large_as_white_noise_lets_them_be(sessions):
    terms = [LINE, *(replace(A, memory="play", width=w) for w in (0.1, 1.1))]
    told = line.shrunk(Regression(sessions, white=True), terms)
    assert line.ordinary(terms, sessions) == pytest.approx(told)
    columns = [block_columns(terms, s) for s in sessions]
    free = least_squares(sessions, columns, [s.rate_dps for s in sessions])
    assert (np.abs(told[1:]).sum(axis=0) < np.abs(free[1:]).sum(axis=0)).all()


def test_the_line_is_applied_where_no_slope_is():
    one = line.with_line([LINE, LINE], [A, TEMP], np.array([[1, 1, 1], [0, 1, 0.0]]))
    assert one.tolist() == [[1, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 0]]
    assert line.with_line([], [A], np.ones((1, 3))).tolist() == [[1, 1, 1]]
    assert line.with_line([LINE], [], np.ones((0, 3))).tolist() == [[1, 1, 1]]


def deployed(sessions, terms, straight=(LINE,), effects=True, **more):
    """The fit of all sessions, and the terms and coefficients that are deployed."""
    plain = {"alone": False, "stands_alone": False, "applied": np.ones((len(terms), 3)), **more}
    regression = Regression(sessions)
    selection = SimpleNamespace(straight=straight, terms=terms, regression=regression, **plain)
    return regression.fit([*straight, *terms]).coefficients, *told_by(selection, effects)


def test_what_is_deployed_is_the_fit_and_beside_it_the_line_as_the_firmware_learns_it(sessions):
    fitted, terms, told = deployed(sessions, [A])
    assert terms == [LINE, A] and told[1] == pytest.approx(fitted[1])
    assert told[0] == pytest.approx(line.ordinary([LINE], sessions, [A], told[1:])[0])
    _, terms, told = deployed(sessions, [A], effects=False)
    assert terms == [LINE] and told == pytest.approx(line.ordinary([LINE], sessions))
    _, _, told = deployed(sessions, [A], applied=np.array([[1.0, 0.0, 1.0]]))
    assert told[1, 1] == 0


# --- curves of any form ---


def bends(lo=15.0, apart=4.0, number=4):
    slope = Term("temp", lo, lo + apart * (number + 1), lo)
    return [slope, *(replace(slope, knot=apart * (k + 1.0)) for k in range(number))]


@pytest.mark.parametrize("beside", [[], [A]])
def test_a_line_that_bends_often_is_the_mean_of_all_curves_by_their_likelihood(beside):
    sessions = [dense.made(seed, 30, names=("temp", "a")) for seed in (1, 2)]
    for s in sessions:
        s.sources["temp"] = 25 + np.clip(2 * s.sources["temp"], -10.0, 10.0)
    terms, corners, first = [*beside, *bends()], 15.0 + 4.0 * np.arange(6), len(beside)
    shares = [
        np.column_stack([np.interp(s.sources["temp"], corners, u) for u in np.eye(6)])
        for s in sessions
    ]
    told, curves = [], []
    for length in dense.LENGTHS:
        root = np.column_stack([corners, np.linalg.cholesky(matern(corners, length))])
        names = [*(t.source for t in beside), *(f"x{k}" for k in range(7))]
        both = []
        for s, share in zip(sessions, shares):
            own = {f"x{k}": c for k, c in enumerate((share @ root).T)}
            both.append(replace(s, sources={**s.sources, **own}))
        p = dense.problem(both, [Term(n) for n in names], shapes_=dense.WHITE)
        waves = list(range(first + 1, first + 7))
        nats, mean = dense.shrunk(p, [waves], [(size,) for size in dense.SIZES])
        told.append(nats)
        slopes = np.diff(root @ mean[first:], axis=0) / 4.0
        curves.append(np.vstack([mean[:first], slopes[:1], np.diff(slopes, axis=0)]))
    expected = dense.by_likelihood(told, curves)
    # acceleration aside, which data sheets hold back
    assert line.ordinary(terms, sessions) == pytest.approx(expected, rel=1e-4, abs=1e-7)


def test_a_slope_with_two_bends_or_more_is_a_curve_and_nothing_else_is():
    terms = bends()
    assert curve_of(terms) == [0, 1, 2, 3, 4]
    assert curve_of([A, *terms[:3]]) == [1, 2, 3] and curve_of(terms[:2]) == []
    assert curve_of([replace(t, lo=-np.inf) for t in terms]) == []
    assert curve_of([*terms, replace(terms[1], source="a")]) == [0, 1, 2, 3, 4]


def test_a_free_curve_is_the_likeliest_form_over_its_nine_points():
    sessions = [dense.made(1, 15, names=("temp", "a")), dense.made(2, 17, names=("temp", "a"))]
    term = Term("a", -4.0, 5.0, 0.0)
    for s in sessions:
        s.sources["a"] = np.clip(s.sources["a"], -4.0, 5.0)
    points = np.linspace(-4.0, 5.0, 9)
    shares = [
        np.column_stack([np.interp(s.sources["a"], points, u) for u in np.eye(9)]) for s in sessions
    ]
    told, curves, at = [], [], np.linspace(-1, 1, 9)
    for length in dense.LENGTHS:
        root = np.column_stack([at, np.linalg.cholesky(matern(at, length))])
        both = []
        for s, share in zip(sessions, shares):
            own = {f"x{k}": c for k, c in enumerate((share @ root).T)}
            both.append(replace(s, sources={"t": s.sources["temp"], **own}))
        names = ["t", *(f"x{k}" for k in range(10))]
        p = dense.problem(both, [Term(n) for n in names])
        sizes = [(size,) for size in dense.SIZES]
        nats, mean = dense.shrunk(p, [list(range(2, 11))], sizes, alike=False)
        told.append(nats)
        curves.append(root @ mean[1:11])
    values = dense.by_likelihood(told, curves)
    x, _ = with_offsets(sessions, shares, [s.rate_dps for s in sessions])
    squares, axes = np.linalg.eigh(values.T @ x.T @ x @ values)
    form = values @ axes[:, -1]
    table = 2 * (form - form.min()) / np.ptp(form) - 1
    drawn, lost = draw(Regression(sessions), [Term("temp")], term)
    sign = np.sign(drawn.table @ table)
    assert drawn.table == pytest.approx(sign * table, abs=1e-4)
    assert lost == pytest.approx(squares[:2].sum() / squares.sum(), rel=1e-3)
    assert replace(drawn, table=None) == term


def test_a_rate_of_nothing_has_no_curve():
    still = dense.made(1, 15, names=("temp", "a"))
    still.rate_dps[:] = 0.0
    term = Term("a", -4.0, 5.0, 0.0)
    drawn, lost = draw(Regression([still]), [], term)
    assert drawn == term and lost == 0.0
