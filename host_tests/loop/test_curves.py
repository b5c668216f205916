"""The rival and the floor of `zerorate bench real`."""

from types import SimpleNamespace

import numpy as np
import pytest
from zerorate_bench.loop.curves import best_curve_rms_dps, cubic_left
from zerorate_bench.loop.simulated import simulate
from zerorate_tools.loop.search.select import straight_line


def alone(session, line):
    selection = SimpleNamespace(line=line)
    return SimpleNamespace(single=True, sessions=[session], train=[session], selection=selection)


@pytest.fixture(scope="module")
def bent():
    (session,) = simulate(5, [("temperature-kink", 20.0)], sessions=1, bare=True).sessions
    return session


def test_the_best_of_many_curves_leaves_less_than_a_cubic_of_a_kink_and_more_than_nothing(bent):
    analysis = alone(bent, straight_line([bent]))
    (left,) = cubic_left(analysis)
    cubic, best = np.sqrt(np.nanmean(left**2)), best_curve_rms_dps(analysis)
    noise = np.sqrt((np.diff(bent.rate_dps[bent.available], n=2, axis=0) ** 2).mean() / 6)
    assert 0.9 * noise < best < 0.8 * cubic


def test_without_temperature_there_is_neither(bent):
    analysis = alone(bent, ())
    assert (cubic_left(analysis), best_curve_rms_dps(analysis)) == (None, None)
