"""Pieces of one recording that are left out in turn, and what is left of them."""

from dataclasses import replace

import numpy as np
import pytest
from zerorate_tools.loop.fit import line, single
from zerorate_tools.model.term import Term

from . import dense
from .dense import A
from .selections import step

LINE = Term("temp", centre=25.0)


def alone(blocks=400, **sources):
    """A recording whose only sources are these, by default a walking temperature and another."""
    session = dense.made(3, blocks, names=("temp", "a"))
    return replace(session, sources=sources) if sources else session


def in_time(blocks):
    """A recording without temperature."""
    return alone(blocks, one=np.ones(blocks))


def begins(fold):
    """Where each piece begins."""
    return np.flatnonzero(np.r_[True, np.diff(fold) != 0])


@pytest.mark.parametrize(
    ("blocks", "pieces"), [(400, 20), (59, 19), (60, 20), (29, 9), (7, 2), (2, 1)]
)
def test_pieces_are_twenty_or_as_many_as_three_blocks_each_allow(blocks, pieces):
    fold = single.fold_of(in_time(blocks))
    sizes = np.diff([*begins(fold), blocks])
    assert len(sizes) == pieces and np.ptp(sizes) <= 1
    assert fold[begins(fold)].tolist() == [k % min(10, pieces) for k in range(pieces)]


def test_a_piece_is_short_where_temperature_runs_fast():
    degc = np.r_[np.linspace(20, 20.001, 200), np.linspace(20.001, 40, 200)]
    starts = begins(single.fold_of(alone(temp=degc)))
    # half of the way is time and half is temperature: a quarter of the pieces in the still half
    assert (starts < 200).sum() == 5 and len(starts) == 20
    # no piece has less than three blocks, however fast it runs there
    leaps = np.where(np.arange(400) < 397, 20.0, 90.0)
    assert np.diff([*begins(single.fold_of(alone(temp=leaps))), 400]).min() >= 3


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
    session = alone(len(degc), temp=np.array(degc, float))
    assert single.pass_of(session).tolist() == passes
    pieces = single.PiecesByLine(session)
    by_passes = pieces.by_passes()
    assert (by_passes is pieces) is not any(passes)
    assert by_passes.fold.tolist() == (passes if any(passes) else pieces.fold.tolist())
    assert len(by_passes.parts) == max(by_passes.fold) + 1
    bare = single.PiecesByLine(in_time(len(degc)))
    assert bare.by_passes() is bare


@pytest.mark.parametrize("blocks", [400, 60, 10])
def test_a_block_at_either_side_of_a_piece_is_neither_fitted_nor_judged(blocks):
    session = in_time(blocks)
    judged = single.PiecesByLine(session)
    for k, part in enumerate(judged.parts):
        left = np.flatnonzero(judged.fold == k)
        near = np.abs(left[:, None] - np.arange(blocks)).min(axis=0)
        assert (part.available == (near > 1)).all()
        assert (part.weight > 0).tolist() == part.available.tolist()


@pytest.fixture
def judged():
    return single.PiecesByLine(alone(200))


def test_what_is_left_of_a_piece_is_by_a_fit_to_the_others(judged):
    session, left = judged.session, judged.residual([LINE], [A])
    for k, part in enumerate(judged.parts):
        own, there = judged.fold == k, part.available
        x = np.column_stack([session.sources["temp"], session.sources["a"]])
        seen = x[there, 1]
        x[:, 1] = np.clip(x[:, 1], seen.min(), seen.max())  # held where what the fit has seen ends
        x, y = x - x[there].mean(axis=0), session.rate_dps - session.rate_dps[there].mean(axis=0)
        rest = y - x @ np.linalg.lstsq(x[there], y[there], rcond=None)[0]
        assert left[own] == pytest.approx(rest[own], rel=1e-6, abs=1e-9)
    reached = single.PiecesByLine(session, hold=False)
    assert not np.allclose(reached.residual([LINE], [A]), left)
    spared = judged.residual([LINE], [A], np.zeros((1, 3)))
    assert spared == pytest.approx(judged.residual([LINE], []))


def test_each_stretch_between_steps_is_about_its_own_mean(judged):
    left = judged.residual([LINE], [A])
    assert judged.about_stretches(left) is left
    stepped = single.PiecesByLine(replace(judged.session, steps=(step(12),)))
    about, stretch = stepped.about_stretches(left), np.arange(200) >= 12
    for k, part in enumerate(stepped.parts):
        for own in (stretch, ~stretch):
            known = left[own & part.available].mean(axis=0)
            judged_here = own & (stepped.fold == k)
            assert about[judged_here] == pytest.approx(left[judged_here] - known)


def test_what_is_fitted_beside_a_recording_is_fitted_with_it(judged):
    both = [judged.session, dense.made(9, 200, names=("temp", "a"))]
    _, told = single.PiecesByLine(both[0], both[1:]).fitted_to(both[0], [LINE], [])
    assert told == pytest.approx(line.ordinary([LINE], both))
    assert judged.fitted_to(both[0], [], [])[0] == []


@pytest.mark.parametrize(
    ("ends", "held"),  # the source goes from 0 to 10, and was seen up to 4.9
    [
        *(((-2.0, 13.0), (-2.0, 4.9 + 3.0)), ((-np.inf, np.inf), (0.0, 4.9))),
        *(((2.0, 4.0), (2.0, 4.0)), ((2.0, 6.0), (2.0, 4.9)), ((8.0, 9.0), (4.9, 4.9))),
    ],
)
def test_a_term_is_held_where_what_was_seen_ends_and_as_far_beyond_as_it_reached(ends, held):
    at = np.arange(101)
    part = replace(alone(101, a=at / 10.0), weight=(at < 50).astype(float))
    told = single.held(replace(A, lo=ends[0], hi=ends[1]), [part])
    assert (told.lo, told.hi) == pytest.approx(held)
    with_table = replace(A, lo=0.0, hi=1.0, table=(0.0,) * 9)
    assert single.held(with_table, [part]) is with_table
