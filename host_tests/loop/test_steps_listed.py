"""Where a step of the bias may be, which are listed, and how sure they are."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import chi2
from zerorate_tools.loop.fit.regression import Regression, predicted
from zerorate_tools.loop.read.sessions import Session, block_basis
from zerorate_tools.loop.search import step_places
from zerorate_tools.loop.search import steps as listed
from zerorate_tools.loop.search.catalogue import lags
from zerorate_tools.loop.search.steps import standing, steps_and_lags
from zerorate_tools.model.term import Term

from . import dense
from .dense import A

BLOCKS = 60


def noise(seed, *steps, **sources):
    """A session of noise with steps (block, share of the block before it, sizes)."""
    session = dense.white(seed, BLOCKS, **sources)
    for block, share, size in steps:
        after = np.clip(np.arange(BLOCKS) + 1.0 + share - block, 0, 1)
        session.rate_dps += np.outer(after, size)
    return session


def find_all(*sessions, terms=()):
    """The steps beside the terms."""
    return steps_and_lags(Regression([*sessions]), [*terms])[0]


@pytest.fixture
def sessions():
    """Three, with a step in the second and a larger one in the third."""
    return [
        noise(4),
        noise(5, (31, 0.75, [25.0, -25.0, 0.0])),
        noise(6, (22, 0.0, [30.0, 30.0, 30.0])),
    ]


def quiet(blocks, ticks_per_block=1, **more):
    return Session("x", 20.0, ticks_per_block, np.zeros((blocks, 3)), np.ones(blocks), {}, **more)


# --- places ---


def test_before_a_step_is_nothing_and_of_the_block_with_it_in_the_share_behind_it():
    session = quiet(6, 4)
    told = step_places.heavisides(session, np.array([2.0, 2.25, 5.5, 0.0]))
    assert told[:, 0].tolist() == [0, 0, 1, 1, 1, 1]
    assert told[:, 1].tolist() == [0, 0, 0.75, 1, 1, 1]
    assert told[:, 2].tolist() == [0, 0, 0, 0, 0, 0.5] and (told[:, 3] == 1).all()
    weight = np.ones(24)
    weight[8:10] = 0.0  # the first half of block 2 was no rest
    for at, ticks, share in ((2.25, weight, 1.0), (2.75, weight, 0.5), (2.25, 0 * weight, 0.75)):
        half = replace(session, tick_weight=ticks)
        assert step_places.heavisides(half, np.array([at]))[2, 0] == share


@pytest.mark.parametrize(("blocks", "places"), [(100, 85), (16, 1), (15, 0), (3, 0)])
def test_a_step_is_looked_for_away_from_either_end(blocks, places):
    ground = step_places._ground(quiet(blocks))
    assert step_places.tried(quiet(blocks)) == len(ground) == places
    assert not places or (ground[0], ground[-1]) == (8, blocks - 8)


# --- steps ---


def as_terms(sessions, steps):
    """The sessions with each step as a source, and terms of these."""
    for i, s in enumerate(sessions):
        for k, one in enumerate(steps):
            at = np.clip(np.arange(s.blocks) + 1.0 + one.share - one.block, 0, 1)
            s.sources[f"step{k}"] = at * (i == one.session)
    return [Term(f"step{k}") for k in range(len(steps))]


def test_steps_are_listed_with_place_size_and_time_the_strongest_first(sessions):
    regression = Regression(sessions)
    found, _ = steps_and_lags(regression, [A])
    assert [(s.session, s.block, s.share) for s in found] == [(2, 22, 0.0), (1, 31, 0.75)]
    assert [s.at_s for s in found] == [22 * 20.0, 30.25 * 20.0]
    terms, plain = as_terms(sessions, found), Regression(sessions)
    fit = plain.fit([A, *terms])
    for k, one in enumerate(found):
        assert one.size_dps == pytest.approx(fit.coefficients[1 + k], rel=1e-6)
        variance = fit.base.unscaled[:, 1 + k, 1 + k] * fit.base.variance
        assert one.deviation_dps == pytest.approx(np.sqrt(variance), rel=1e-6)
        gained = 2 * (fit.total - plain.fit([A, *(t for t in terms if t is not terms[k])]).total)
        assert one.ratio == pytest.approx(gained, rel=1e-6)
        assert one.p_value < 1e-9
    assert len(regression.events()) == 2  # they stay as nuisances
    assert regression.fit([A]).base.total == pytest.approx(fit.base.total)


def test_the_chance_of_a_step_pays_for_every_place_and_recording():
    def stands(recordings, dps=1.9):
        regression = Regression([noise(8, (30, 0.0, [dps] * 3))])
        return standing(regression, [A], recordings, [])

    [alone], [many] = stands(1), stands(7)
    assert many.p_value == pytest.approx(7 * alone.p_value)
    [found] = find_all(noise(8, (30, 0.0, [1.9] * 3)), terms=[A])
    assert found.p_value == pytest.approx(alone.p_value)
    assert alone.p_value >= 0.999 * chi2.sf(alone.ratio, 3) * (BLOCKS + 1 - 15)
    assert stands(10**9) == [] == stands(1, dps=0.6)


@pytest.mark.parametrize(
    ("gap", "degc", "unseen"),
    [((30, 32), 9.0, True), ((30, 31), 9.0, False), ((30, 32), 0.1, False), ((30, 32), None, True)],
)
def test_a_change_across_blocks_without_rest_is_none_where_temperature_moved(gap, degc, unseen):
    session = noise(4)
    session.weight[slice(*gap)] = 0.0
    if degc is not None:
        session.sources["temp"] = np.linspace(0.0, degc, BLOCKS) * BLOCKS / 4
    assert bool(listed._is_unseen(session, gap[1])) is unseen
    assert not listed._is_unseen(session, 5) and not listed._is_unseen(session, 0)


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


def test_what_a_recorded_channel_does_is_no_step():
    switched = np.where((np.arange(BLOCKS) // 15) % 2 > 0, 1.0, 0.0)
    session = noise(4, load=switched)
    session.rate_dps += np.outer(switched, [9.0, -9.0, 9.0])
    assert find_all(session) == []
    del session.sources["load"]
    assert len(find_all(session)) > 0
