"""The heading error of a filter is what it turned about the vertical since before the motion."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from zerorate_bench.filters import heading_error_deg
from zerorate_tools.demo.broad import Trial

HZ, SECONDS, REST_S = 300.0, 60, 20


def wxyz(angles_deg):
    """Attitudes turned about the vertical."""
    return Rotation.from_euler("z", angles_deg[:, None], degrees=True).as_quat()[:, [3, 0, 1, 2]]


@pytest.fixture
def trial():
    n = round(HZ * SECONDS)
    moving = np.arange(n) >= HZ * REST_S
    optical = wxyz(np.zeros(n))
    optical[::7] = np.nan  # the cameras lose it now and then
    return Trial("made", HZ, np.zeros((n, 3)), np.zeros((n, 3)), optical, moving)


def test_a_filter_may_begin_anywhere(trial):
    assert heading_error_deg(wxyz(np.full(6000, 137.0)), trial) == pytest.approx(0, abs=1e-6)


def test_what_it_turns_from_the_first_motion_on_counts(trial):
    # 0.5 deg/s, since the last second before the motion on average
    at_s = np.arange(6000) / 100
    turned = 0.5 * np.clip(at_s - REST_S, 0, None)
    expected = np.sqrt(np.mean(turned[at_s >= REST_S] ** 2))
    assert heading_error_deg(wxyz(100 + turned), trial) == pytest.approx(expected, rel=0.01)
