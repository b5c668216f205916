"""The line over temperature beside what is deployed, axis by axis."""

import numpy as np
import pytest
from zerorate_bench.loop.simulated import simulate
from zerorate_tools.loop.fit.line import by_axis, ordinary, with_line
from zerorate_tools.loop.fit.single import PiecesByLine
from zerorate_tools.model.term import Term

LINE, SLOPE = Term("temp", centre=25.0), Term("temp", 10.0, 50.0, 25.0)
BEND, LAG = Term("temp", 10.0, 50.0, 25.0, 2), Term("temp", lag_s=300.0, lag_mode="difference")


@pytest.fixture(scope="module")
def session():
    return simulate(4, [("thermal-lag", 10.0)], sessions=1, bare=True).sessions[0]


def test_an_axis_without_an_effect_is_fitted_as_if_it_were_not_there(session):
    applied = np.array([[1.0, 1.0, 1.0], [1.0, 0.0, 1.0]])
    _, spared = PiecesByLine(session, hold=False).fitted_to(session, [LINE], [BEND, LAG], applied)
    alone, both = ordinary([LINE, BEND], [session]), ordinary([LINE, BEND, LAG], [session])
    assert np.allclose(spared[:2, 1], alone[:, 1])
    assert not np.allclose(spared[:2, 1], both[:2, 1])
    assert np.allclose(spared[:, [0, 2]], both[:, [0, 2]])
    assert spared[2, 1] == 0


def test_the_line_stands_back_on_the_axes_that_have_a_slope():
    applied = with_line([LINE], [SLOPE, BEND], np.array([[1.0, 0.0, 1.0], [1.0, 1.0, 1.0]]))
    assert applied[0].tolist() == [0.0, 1.0, 0.0]


def test_nothing_applied_is_nothing(session):
    assert not by_axis(lambda terms: ordinary(terms, [session]), [BEND], np.zeros((1, 3))).any()
