"""How far beyond the range it was fitted over a term follows its source."""

from dataclasses import replace

import numpy as np
import pytest
from zerorate_bench.loop.simulated import simulate
from zerorate_tools.loop.fit.regression import Regression
from zerorate_tools.loop.search.catalogue import candidates
from zerorate_tools.model.term import Term


@pytest.mark.parametrize("kind", ["time-drift", "vibration", "linear-acceleration"])
def test_time_and_what_a_hand_takes_far_are_held_where_they_end(kind):
    sessions = simulate(1).sessions[:-1]
    (term, *_) = next(c for c in candidates(sessions) if c.kind == kind).terms
    values = np.concatenate([s.source(term.source) for s in sessions])
    assert values.min() <= term.lo < term.hi <= values.max()


# 6 mdps of noise a block over a hundred poses and more, thrice
FLOOR_DPS_A_G2 = 0.003


@pytest.fixture(scope="module")
def sessions():
    return simulate(4).sessions


def test_the_sum_of_squares_that_gravity_holds_gets_no_coefficient_from_noise(sessions):
    rng = np.random.default_rng(3)
    session = sessions[0]
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
