"""What noise makes of squares whose sum gravity holds."""

from dataclasses import replace

import numpy as np
import pytest
from zerorate_bench.loop.simulated import simulate
from zerorate_tools.loop.fit.regression import Regression
from zerorate_tools.model.term import Term

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
