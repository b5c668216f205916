"""Lines, curves, pieces and intervals of the fit, beside what plain sums and matrices give."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from scipy.stats import chi2
from zerorate_tools.loop.fit import line, single
from zerorate_tools.loop.fit.free_curve import draw, is_curve, of_any_form, parts
from zerorate_tools.loop.fit.intervals import block_bootstrap, rms
from zerorate_tools.loop.fit.left_out import precision_of
from zerorate_tools.loop.fit.noise import floor_dps, noise_of
from zerorate_tools.loop.fit.regression import Regression
from zerorate_tools.loop.fit.smooth import curve_of, matern, smooth
from zerorate_tools.loop.fit.surrogates import NullRatios, null_ratios
from zerorate_tools.loop.search.steps import Step
from zerorate_tools.model.term import Term, play

from . import dense
from .dense import A, B, C

TEMP = Term("temp", 10.0, 40.0, 20.0)
LINE = Term("temp", centre=25.0)
STEP = (Step(0, 12, np.zeros(3), 240.0, 0.0),)


@pytest.fixture(scope="module")
def sessions():
    """Two with a temperature, the second with a gap and a step that was taken out."""
    made = [
        dense.made(1, 30, names=("temp", "a")),
        dense.made(2, 36, range(4, 9), names=("temp", "a")),
    ]
    for s in made:
        s.sources["temp"] = 25 + 3 * s.sources["temp"]
    return [made[0], replace(made[1], steps=STEP)]


def with_offsets(sessions, columns, rates):
    """(x, y) of what is there, each stretch of each session less its mean."""
    x, y = [], []
    for s, c, r in zip(sessions, columns, rates):
        stretch = np.zeros(s.blocks, int)
        for step in s.steps:
            stretch[step.block :] += 1
        for k in range(stretch.max() + 1):
            own = s.available & (stretch == k)
            x.append(c[own] - c[own].mean(axis=0))
            y.append(r[own] - r[own].mean(axis=0))
    return np.vstack(x), np.vstack(y)


def test_the_line_is_that_of_least_squares_with_an_offset_a_stretch(sessions):
    columns = [np.column_stack([s.sources["temp"] - 25, s.sources["a"]]) for s in sessions]
    x, y = with_offsets(sessions, columns, [s.rate_dps for s in sessions])
    expected = np.linalg.lstsq(x, y, rcond=None)[0]
    assert line.ordinary([LINE, A], sessions) == pytest.approx(expected, rel=1e-9)
    still = [replace(s, sources={**s.sources, "b": np.ones(s.blocks)}) for s in sessions]
    with_none = np.vstack([expected, np.zeros(3)])
    assert line.ordinary([LINE, A, B], still) == pytest.approx(with_none, rel=1e-9)
    given = np.array([[0.5, -1.0, 2.0]])
    less = [s.rate_dps - np.outer(s.sources["a"], given) for s in sessions]
    x, y = with_offsets(sessions, [c[:, :1] for c in columns], less)
    expected = np.linalg.lstsq(x, y, rcond=None)[0]
    assert line.ordinary([LINE], sessions, [A], given) == pytest.approx(expected, rel=1e-9)


def test_play_operators_are_held_back_by_a_twentythousandth_of_their_own_size(sessions):
    sessions = [replace(s, sources={**s.sources, "a": s.sources["a"] / 10}) for s in sessions]
    widths = 0.1, 0.11
    terms = [LINE, *(replace(A, memory="play", width=w) for w in widths)]
    columns = [
        np.column_stack([s.sources["temp"] - 25, *(play(s.sources["a"], w) for w in widths)])
        for s in sessions
    ]
    x, y = with_offsets(sessions, columns, [s.rate_dps for s in sessions])
    held = np.diag([0.0, *(5e-5 * len(x) * x[:, 1:].var(axis=0))])
    expected = np.linalg.solve(x.T @ x + held, x.T @ y)
    assert line.ordinary(terms, sessions) == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize(
    "change",
    [
        *({"source": "a"}, {"lo": -np.inf}, {"power": 2}, {"memory": "play"}, {"second": "a"}),
        *({"lag_mode": "lag", "lag_s": 9.0}, {"knot": 1.0}, {"delay_s": 1.0}, {"decay_s": 1.0}),
    ],
)
def test_only_the_plain_line_over_temperature_is_the_slope(change):
    assert line.is_slope(TEMP)
    assert not line.is_slope(replace(TEMP, **change))
    assert line.less_slope((LINE,), [A, TEMP]) == ()
    assert line.less_slope((LINE,), [A, replace(TEMP, **change)]) == (LINE,)


def test_the_line_is_applied_where_no_slope_is():
    one = line.with_line([LINE, LINE], [A, TEMP], np.array([[1, 1, 1], [0, 1, 0.0]]))
    assert one.tolist() == [[1, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 0]]
    assert line.with_line([], [A], np.ones((1, 3))).tolist() == [[1, 1, 1]]
    assert line.with_line([LINE], [], np.ones((0, 3))).tolist() == [[1, 1, 1]]


def selected(sessions, terms, straight=(LINE,), **more):
    plain = {"alone": False, "stands_alone": False, "applied": np.ones((len(terms), 3))}
    chosen = {"straight": straight, "terms": terms, "regression": Regression(sessions)}
    return SimpleNamespace(**{**chosen, **plain, **more})


def test_what_is_deployed_is_the_fit_and_beside_it_the_line_as_the_firmware_learns_it(sessions):
    selection = selected(sessions, [A])
    terms, told = line.deployed(selection)
    assert terms == [LINE, A]
    assert told[1] == pytest.approx(selection.regression.fit([LINE, A]).coefficients[1])
    assert told[0] == pytest.approx(line.ordinary([LINE], sessions, [A], told[1:])[0])
    terms, told = line.deployed(selection, effects=False)
    assert terms == [LINE] and told == pytest.approx(line.ordinary([LINE], sessions))
    terms, told = line.deployed(selected(sessions, [A], alone=True))
    assert told[1] == pytest.approx(line.ordinary([LINE, A], sessions)[1])
    terms, told = line.deployed(selected(sessions, [TEMP], ()))
    assert terms == [TEMP] and told == pytest.approx(selection.regression.fit([TEMP]).coefficients)
    terms, told = line.deployed(selected(sessions, [], ()))
    assert terms == [] and told.shape == (0, 3)
    spared = np.array([[1.0, 0.0, 1.0]])
    assert line.deployed(selected(sessions, [A], applied=spared))[1][1, 1] == 0


# --- smooth curves ---


def bends(lo=15.0, apart=4.0, number=4):
    slope = Term("temp", lo, lo + apart * (number + 1), lo)
    return [slope, *(replace(slope, knot=apart * (k + 1.0)) for k in range(number))]


@pytest.mark.parametrize("beside", [[], [A]])
def test_a_line_that_bends_often_is_the_mean_of_all_curves_by_their_likelihood(sessions, beside):
    terms = [*beside, *bends()]
    corners = 15.0 + 4.0 * np.arange(6)
    at = np.linspace(corners[0], corners[-1], 16)
    columns, plain = [], 1 + len(beside)
    for s in sessions:
        shares = np.column_stack([np.interp(s.sources["temp"], at, u) for u in np.eye(16)])
        others = [s.sources[t.source] for t in beside]
        columns.append(np.column_stack([s.sources["temp"], *others, shares]))
    x, y = with_offsets(sessions, columns, [s.rate_dps for s in sessions])
    straight, w = x[:, :plain], x[:, plain:]
    p = straight @ np.linalg.pinv(straight)
    left, waves = y - p @ y, w - p @ w
    free = len(y) - plain - 3  # offsets: one session, and two stretches
    told, curves = [], []
    for length in (0.05, 0.1, 0.2, 0.4, 0.8):
        d = np.sqrt(5) * np.abs(at[:, None] - at) / (length * (at[-1] - at[0]))
        k = (1 + d + d**2 / 3) * np.exp(-d) + 1e-10 * np.eye(16)
        assert matern(at, length) == pytest.approx(k)
        for size in [1e-3, *(10.0**e for e in np.arange(-1, 4.1, 0.5))]:
            v = np.eye(len(y)) + size * waves @ k @ waves.T
            to = np.linalg.inv(v)
            squares = np.einsum("na,nm,ma->a", left, to, left)
            likely = -0.5 * np.linalg.slogdet(v)[1] - 0.5 * free * np.log(squares)
            told.append(likely.sum())
            curves.append(size * k @ waves.T @ to @ left)
    weight = np.exp(np.array(told) - max(told))
    deviation = np.tensordot(weight / weight.sum(), curves, 1)
    fitted = np.linalg.pinv(straight) @ (y - w @ deviation)
    curve = deviation + at[:, None] * fitted[0]
    nearest = np.column_stack([np.interp(at, corners, u) for u in np.eye(6)])
    heights = np.linalg.lstsq(nearest, curve, rcond=None)[0]
    slopes = np.diff(heights, axis=0) / 4.0
    expected = np.vstack([fitted[1:], slopes[:1], np.diff(slopes, axis=0)])
    assert smooth(terms, curve_of(terms), sessions) == pytest.approx(expected, rel=1e-4, abs=1e-7)
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
    told, curves = [], []
    at = np.linspace(-1, 1, 9)
    for length in (0.05, 0.1, 0.2, 0.4, 0.8):
        root = np.column_stack([at, np.linalg.cholesky(matern(at, length))])
        both = []
        for s, share in zip(sessions, shares):
            own = {f"x{k}": c for k, c in enumerate((share @ root).T)}
            both.append(replace(s, sources={"t": s.sources["temp"], **own}))
        names = ["t", *(f"x{k}" for k in range(10))]
        p = dense.problem(both, [Term(n) for n in names])
        sizes = [(1e-3,), *((10.0**e,) for e in np.arange(-1, 4.1, 0.5))]
        nats, mean = dense.shrunk(p, [list(range(2, 11))], sizes, alike=False)
        told.append(nats)
        curves.append(root @ mean[1:11])
    weight = np.exp(np.array(told) - max(told))
    values = np.tensordot(weight / weight.sum(), curves, 1)
    x, _ = with_offsets(sessions, shares, [s.rate_dps for s in sessions])
    squares, axes = np.linalg.eigh(values.T @ x.T @ x @ values)
    form = values @ axes[:, -1]
    table = 2 * (form - form.min()) / np.ptp(form) - 1
    drawn, lost = draw(Regression(sessions), [Term("temp")], term)
    assert np.abs(drawn.table) == pytest.approx(np.abs(table), abs=1e-4)
    assert drawn.table == pytest.approx(table, abs=1e-4) or drawn.table == pytest.approx(
        -table, abs=1e-4
    )
    assert lost == pytest.approx(squares[:2].sum() / squares.sum(), rel=1e-3)
    assert replace(drawn, table=None) == term


def test_a_rate_of_nothing_has_no_curve():
    still = dense.made(1, 15, names=("temp", "a"))
    still.rate_dps[:] = 0.0
    term = Term("a", -4.0, 5.0, 0.0)
    drawn, lost = draw(Regression([still]), [], term)
    assert drawn == term and lost == 0.0


def test_parts_carry_nine_tenths_of_what_curves_vary_by_in_ten_or_fewer_forms():
    tables = np.array([t.table for t in parts(Term("a", 0.0, 1.0))]).T
    at = np.linspace(-1, 1, 9)
    waves = np.mean([matern(at, length) for length in (0.05, 0.1, 0.2, 0.4, 0.8)], axis=0)
    centred = np.eye(9) - 1 / 9
    whole = centred @ (np.outer(at, at) + waves) @ centred
    held = tables @ tables.T
    most = np.sort(np.linalg.eigvalsh(whole))[::-1]
    fewest = int(np.searchsorted(np.cumsum(most) / most.sum(), 0.9)) + 1
    assert tables.shape[1] == fewest
    assert np.linalg.eigvalsh(held)[-fewest:][::-1] == pytest.approx(most[:fewest])
    assert tables.T @ tables == pytest.approx(np.diag(most[:fewest][::-1]), abs=1e-9)
    assert whole @ tables == pytest.approx(tables * most[:fewest][::-1], abs=1e-9)
    several = parts(Term("a", 0.0, 1.0))
    points = np.array([t.table for t in of_any_form(several)])
    assert np.linalg.matrix_rank(np.vstack([points, np.ones(9)])) == 9  # but for an offset
    assert of_any_form(several[:1]) == several[:1]
    assert is_curve(several) and not is_curve(several[:1]) and not is_curve([*several, A])


def test_what_is_known_of_coefficients_before_a_session_left_out(sessions):
    regression = Regression(sessions)
    terms = [LINE, A, Term("temp", power=2)]
    g, base = regression.cross_products(terms), regression.fit(terms).base
    known = precision_of(regression, g, base, terms, slice(1, 3))
    size = np.sqrt((base.fitted[:, 1:3] ** 2).mean(axis=0))
    assert known[:, 1:3] == pytest.approx(base.variance[:, None] / (3 * size) ** 2)
    assert (known[:, 0] == 0).all() and known.shape == base.fitted.shape
    plays = [LINE, A, *(replace(A, memory="play", width=w) for w in (1.0, 2.0))]
    g, base = regression.cross_products(plays), regression.fit(plays).base
    known = precision_of(regression, g, base, plays, slice(1, 2))
    assert (known[:, 1:4] > 0).all() and np.ptp(known[:, 2]) == 0
    curve = [LINE, *parts(Term("a", -5.0, 5.0))]
    g, base = regression.cross_products(curve), regression.fit(curve).base
    known = precision_of(regression, g, base, curve, slice(1, len(curve)))
    assert (known[:, 0] == 0).all() and np.ptp(known[0, 1 : len(curve)]) == 0


# --- pieces of one recording ---


def alone(blocks=400, seed=3, **more):
    made = dense.made(seed, blocks, names=("temp", "a"))
    return replace(made, **more)


@pytest.mark.parametrize("blocks, pieces", [(400, 20), (59, 19), (60, 20), (29, 9), (7, 2), (2, 1)])
def test_pieces_are_twenty_or_as_many_as_three_blocks_each_allow(blocks, pieces):
    session = replace(alone(blocks), sources={})
    fold = single.fold_of(session)
    sizes = np.diff(np.flatnonzero(np.r_[True, np.diff(fold) != 0, True]))
    if pieces > 1:
        assert len(sizes) == pieces and sizes.max() - sizes.min() <= 1
    assert fold[0] == 0 and fold.max() == min(10, pieces) - 1
    turns = fold[np.flatnonzero(np.r_[True, np.diff(fold) != 0])]
    assert turns.tolist() == [k % min(10, pieces) for k in range(len(turns))]


def test_a_piece_is_short_where_temperature_runs_fast():
    session = alone(400)
    degc = np.r_[np.linspace(20, 20.001, 200), np.linspace(20.001, 40, 200)]
    session.sources["temp"] = degc
    fold = single.fold_of(session)
    starts = np.flatnonzero(np.r_[True, np.diff(fold) != 0])
    # half of the way is time and half is temperature: a quarter of the pieces in the still half
    assert (starts < 200).sum() == 5 and len(starts) == 20
    # no piece has less than three blocks, however fast it runs there
    session.sources["temp"] = np.where(np.arange(400) < 397, 20.0, 90.0)
    fold = single.fold_of(session)
    sizes = np.diff(np.flatnonzero(np.r_[True, np.diff(fold) != 0, True]))
    assert sizes.min() >= 3


def test_a_block_without_a_rate_goes_with_its_neighbour():
    session = alone(100)
    session.rate_dps[40:43], session.rate_dps[97:] = np.nan, np.nan
    fold = single.fold_of(replace(session, sources={}))
    assert fold[40] in (fold[39], fold[43]) and fold[98] == fold[96]
    assert len(fold) == 100


@pytest.mark.parametrize(
    ("degc", "passes"),
    [
        ([20, 30, 40, 50, 50, 49, 48, 40, 30, 20, 20], [0] * 6 + [1] * 5),
        ([20, 30, 40, 50, 48.6, 48.4, 20, 21.4, 40, 50], [0] * 5 + [1] * 3 + [2] * 2),
        ([20, 30, 40, 50, 44, 50, 43, 50, 42, 50], [0] * 8 + [1, 2]),  # by less than a quarter
        ([50, 40, 30, 20, 21, 22, 50], [0] * 5 + [1] * 2),
        ([20, 30, 40, 50], [0] * 4),
    ],
)
def test_a_pass_ends_where_temperature_turns_back_after_what_it_holds(degc, passes):
    session = replace(dense.made(1, len(degc)), sources={"temp": np.array(degc, float)})
    assert single.pass_of(session).tolist() == passes
    pieces = single.PiecesByLine(session)
    other = pieces.by_passes()
    assert (other is pieces) is not any(passes)
    assert other.fold.tolist() == (passes if any(passes) else pieces.fold.tolist())
    assert len(other.parts) == max(other.fold) + 1
    bare = single.PiecesByLine(replace(session, sources={}))
    assert bare.by_passes() is bare


@pytest.mark.parametrize("blocks, gap", [(400, 2), (800, 5), (60, 1), (10, 1)])
def test_the_gap_is_an_eighth_of_a_piece_and_a_block_at_least(blocks, gap):
    session = replace(alone(blocks), sources={})
    assert single.gap_blocks(session) == gap
    if blocks < 60:
        return
    judged = single.PiecesByLine(session)
    assert len(judged.parts) == 10
    for k, part in enumerate(judged.parts):
        left = np.flatnonzero(judged.fold == k)
        near = np.abs(left[:, None] - np.arange(blocks)).min(axis=0)
        assert (part.available == (near > gap)).all()
        assert (part.weight > 0).tolist() == part.available.tolist()


def test_what_is_left_of_a_piece_is_by_a_fit_to_the_others():
    session = alone(200)
    judged = single.PiecesByLine(session)
    left = judged.residual([LINE], [A])
    for k, part in enumerate(judged.parts):
        own, there = judged.fold == k, part.available
        x = np.column_stack([session.sources["temp"], session.sources["a"]])
        lo, hi = x[there].min(axis=0), x[there].max(axis=0)
        x[:, 1] = np.clip(x[:, 1], lo[1], hi[1])  # held at the edges of what the fit has seen
        mean = x[there].mean(axis=0)
        b = np.linalg.lstsq(
            x[there] - mean,
            session.rate_dps[there] - session.rate_dps[there].mean(axis=0),
            rcond=None,
        )[0]
        y = session.rate_dps - x @ b
        assert left[own] == pytest.approx(y[own] - y[there].mean(axis=0), rel=1e-6, abs=1e-9)
    reached = single.PiecesByLine(session, hold=False)
    assert not np.allclose(reached.residual([LINE], [A]), left)
    spared = judged.residual([LINE], [A], np.zeros((1, 3)))
    assert spared == pytest.approx(judged.residual([LINE], []))
    assert judged.fitted_to(session, [], [])[0] == []
    assert judged.about_stretches(left) is left
    stepped = single.PiecesByLine(replace(session, steps=STEP))
    about, stretch = stepped.about_stretches(left), np.arange(200) >= 12
    for k, part in enumerate(stepped.parts):
        for own in (stretch, ~stretch):
            known = left[own & part.available].mean(axis=0)
            judged_here = own & (stepped.fold == k)
            assert about[judged_here] == pytest.approx(left[judged_here] - known)
    beside = single.PiecesByLine(session, [alone(200, 9)])
    kept, told = beside.fitted_to(session, [LINE], [])
    assert told == pytest.approx(line.ordinary([LINE], [session, alone(200, 9)]))


def test_a_turn_s_nats_are_a_tenth_of_its_blocks_times_the_log_of_what_its_error_falls_by():
    session = alone(200)
    judged = single.PiecesByLine(session)
    before, after = judged.residual([LINE], []), judged.residual([LINE], [A])
    expected = [
        0.05
        * (judged.fold == k).sum()
        * np.log(
            (before[judged.fold == k] ** 2).sum(axis=0) / (after[judged.fold == k] ** 2).sum(axis=0)
        ).sum()
        for k in range(10)
    ]
    assert judged([LINE], [], [A]) == pytest.approx(expected)
    one = single.nats(np.array([[4.0, 0.0, 1.0]]), np.array([[1.0, 1.0, np.inf]]), [10])
    assert one == pytest.approx([0.5 * 0.1 * 10 * np.log(4)])
    assert single.nats(np.ones((1, 3)), np.zeros((1, 3)), [10]).tolist() == [0.0]
    assert single.nats(np.ones((1, 3)), np.full((1, 3), 0.5), [0]).tolist() == [0.0]


@pytest.mark.parametrize(
    "change, knows_nothing",
    [
        ({}, True),
        ({"lag_mode": "lag"}, False),
        ({"memory": "peak"}, False),
        ({"delay_s": 1.0}, False),
        ({"decay_s": 1.0}, False),
        ({"source": "time"}, False),
        ({"second": "time"}, False),
        ({"second": "a"}, True),
    ],
)
def test_what_knows_nothing_of_before(change, knows_nothing):
    assert single.is_instant(replace(TEMP, **change)) is knows_nothing


def test_a_term_is_held_where_sessions_end_and_as_far_beyond_as_it_reached_beyond_the_source():
    session = alone(50)
    session.sources["a"] = np.linspace(0.0, 10.0, 50)
    part = replace(session, weight=(np.arange(50) < 25).astype(float))
    seen = session.sources["a"][24]
    term = replace(A, lo=-2.0, hi=13.0)
    held = single.held(term, [part])
    assert (held.lo, held.hi) == pytest.approx((-2.0, seen + 3.0))
    held = single.held(A, [part])
    assert (held.lo, held.hi) == pytest.approx((0.0, seen))
    held = single.held(replace(A, lo=2.0, hi=6.0), [part])
    assert (held.lo, held.hi) == pytest.approx((2.0, min(6.0, seen)))
    beyond = single.held(replace(A, lo=8.0, hi=9.0), [part])
    assert beyond.lo == beyond.hi == pytest.approx(seen)
    with_table = replace(A, lo=0.0, hi=1.0, table=(0.0,) * 9)
    assert single.held(with_table, [part]) is with_table


# --- intervals, noise, chance ---


def test_an_interval_of_an_rms_holds_as_much_as_it_says():
    rng = np.random.default_rng(0)
    held = []
    for _ in range(40):
        low, high = block_bootstrap([rng.normal(size=(150, 2)), rng.normal(size=(150, 2))], rms)
        held += ((low < 1) & (high > 1)).tolist()
    assert 0.85 < np.mean(held) < 0.99
    rows = rng.normal(size=(600, 1))
    low, high = block_bootstrap([rows], rms)
    assert high - low == pytest.approx(2 * 1.96 / np.sqrt(2 * 600), rel=0.25)
    slow = np.repeat(rng.normal(size=(40, 1)), 15, axis=0)
    slow_low, slow_high = block_bootstrap([slow], rms)
    assert (slow_high - slow_low) / (high - low) == pytest.approx(np.sqrt(15), rel=0.35)


def test_rows_without_a_number_count_nowhere_and_runs_of_fifteen_are_drawn():
    rows, drawn = np.arange(50.0)[:, None], []
    torn = [np.vstack([rows[:20], [[np.nan]], rows[20:24]]), rows[24:]]
    note = lambda r: drawn.append(r[:, 0]) or 0.0  # noqa: E731
    block_bootstrap(torn, note)
    assert len(drawn) == 400 and all((np.diff(r)[:14] == 1).all() for r in drawn)
    assert {len(r) for r in drawn} == {50} and {r[0] for r in drawn} == set(range(36))
    drawn.clear()
    block_bootstrap([rows[:30]], note)  # of thirty rows a run has a third
    assert all((np.diff(r)[:9] == 1).all() for r in drawn) and any(
        np.diff(r)[9] != 1 for r in drawn
    )
    assert block_bootstrap([np.array([[1.0], [3.0]])], np.mean) == (1.0, 3.0)


def test_the_chance_of_an_irrelevant_candidate_is_chi_squared_s_where_its_ratios_are():
    theory = NullRatios.of(3.0, 6.0, 3)
    assert theory.inflation == 1.0
    for ratio in (1.0, 7.8, 20.0):
        assert theory.survival(ratio) == pytest.approx(chi2.sf(ratio, 3))
        assert theory.survival(ratio, 2) == pytest.approx(chi2.sf(ratio, 6))
    below = NullRatios.of(2.0, 2 / 3, 3)
    assert (below.mean, below.variance) == (3, 6)
    above = NullRatios.of(10.0, 200 / 3, 3)
    assert (above.mean, above.inflation) == (10.0, 10 / 3)
    assert above.variance == pytest.approx(max(200 / 3, 2 * 10**2 / 3))
    wide = NullRatios.of(5.0, 100.0, 2)
    assert wide.variance == 100.0
    draws = np.random.default_rng(0).gamma(5 * 5 / 100, 100 / 5, 200_000)
    assert wide.survival(8.0) == pytest.approx((draws > 8).mean(), rel=0.03)


def test_the_floor_is_the_lowest_deviation_up_to_a_third_of_the_longest_session():
    made = [dense.made(1, 60), dense.made(2, 300)]
    for s in made:
        s.rate_dps[:] = np.random.default_rng(s.blocks).normal(size=(s.blocks, 3))
    regression = Regression(made)
    tau = np.geomspace(20.0, 300 * 20 / 3, 2000)
    lowest = [n.deviation(tau).min() for n in noise_of(regression, [])]
    assert floor_dps(regression, []) == pytest.approx(lowest, rel=1e-3)


def test_surrogates_of_white_noise_reach_what_theory_says_and_a_true_effect_does_not_raise_them():
    made = [dense.made(seed, 60) for seed in (1, 2)]
    for s in made:
        s.rate_dps[:] = np.random.default_rng(s.blocks + int(s.name[1])).normal(size=(60, 3))
    quiet = null_ratios(Regression(made), [], [A], [B, C])
    assert 1.0 <= quiet.inflation < 1.6 and quiet.dof == 3
    moved = [replace(s, rate_dps=s.rate_dps + 50 * s.sources["a"][:, None]) for s in made]
    with_effect = null_ratios(Regression(moved), [], [A], [B, C])
    assert with_effect.mean == pytest.approx(quiet.mean, rel=0.05)
    left_in = null_ratios(Regression(moved), [], [B], [A])
    assert left_in.mean > 1.5 * quiet.mean
