"""What a candidate must reach: every lock must open, and each pays for all that are tried."""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.stats import chi2
from zerorate_tools.loop.fit.regression import Regression
from zerorate_tools.loop.search import decide
from zerorate_tools.loop.search.multiple_testing import MultipleTesting
from zerorate_tools.model.term import Term

from .dense import A, B, C, D
from .selections import candidate


@pytest.mark.parametrize(
    ("family", "level"), [("catalogue", 2.5e-3), ("generic", 5e-5), ("step", 2e-3)]
)
def test_a_family_s_chance_is_that_of_one_times_all_that_were_tried(family, level):
    assert decide.family_p(20.0, 3, 5.0) == pytest.approx(5 * chi2.sf(20.0, 3))
    assert decide.family_p(1.0, 3, 5.0) == 1.0
    least = decide.smallest_ratio(family, 3, 7.0)
    assert decide.family_p(least, 3, 7.0) == pytest.approx(level)


@pytest.mark.parametrize(
    ("columns", "tests"),
    [
        (np.zeros((5, 3)), 1.0),
        (np.ones((5, 1)), 1.0),
        (np.eye(5)[:, :3] * [1.0, 9.0, 0.1], 3.0),
        (np.array([[1.0, 0.6, 0.0], [0.0, 0.8, 0.0]]), np.sqrt([1.6, 0.4]).sum() ** 2 / 2),
    ],
)
def test_columns_count_as_many_tests_as_they_are_apart(columns, tests):
    assert decide.effective(columns) == pytest.approx(tests)


def test_one_recording_has_no_other_to_predict_it(sessions, answers):
    answers(decide, null_ratios=SimpleNamespace(survival=lambda *of: 1e-6, inflation=1.0))
    told = decide.decide(Regression(sessions[:1]), [], candidate(A), 40.0, 2.0, [B])
    assert told.accepted and len(told.session_gains) == 0


DRIFT, BOTH = candidate(Term("time"), kind="time-drift"), candidate(A, B, kind="two")
POOL = [
    *(candidate(t, kind="thermal-lag") for t in (A, B)),
    *(candidate(C, kind="time-drift"), candidate(D), BOTH),
    candidate(B, kind="channel", family="generic"),
]


def test_a_candidate_needs_what_its_family_s_level_asks_of_all_tried(sessions):
    testing = MultipleTesting(Regression(sessions), [*POOL, DRIFT], (), ())
    tried, of_two = testing.tried(DRIFT), testing.tried(BOTH)
    one = decide.smallest_ratio("catalogue", 3, tried)
    assert (testing.least_ratio(DRIFT), testing.needed(DRIFT)) == (one, one)
    assert testing.least_ratio(BOTH) == decide.smallest_ratio("catalogue", 6, of_two)
    assert testing.needed(BOTH) == decide.smallest_ratio("catalogue", 3, of_two)
