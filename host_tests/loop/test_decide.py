"""What a candidate must reach: each pays for all that are tried."""

import numpy as np
import pytest
from scipy.stats import chi2
from zerorate_tools.loop.search import decide


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
