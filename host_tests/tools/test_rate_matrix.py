"""What `model show` prints of a matrix does in other programs what the firmware does."""

import re

import numpy as np
import pytest
from zerorate_tools.model import Slot, build_model
from zerorate_tools.model.model_in_words import in_words
from zerorate_tools.model.rate_matrix import rate_matrix
from zerorate_tools.model.term import Term
from zerorate_tools.recordings import Scales

_SCALES = Scales("MPU-6050", 100.0, 131.0, 16384.0, None, None)
_ERROR = np.array([[0.01, 0.002, -0.003], [0.004, -0.02, 0.001], [0.0, 0.005, 0.006]])
_RATE = np.array([120.0, -45.0, 200.0])


@pytest.fixture
def model():
    terms = [Term(f"rate_{axis}", -250.0, 250.0) for axis in "xyz"]
    slots = [Slot(term, tuple(column), "scale-factor") for term, column in zip(terms, _ERROR.T)]
    return build_model(slots, _SCALES)


def printed(model, heading, rows=3):
    """The numbers of the lines after a heading."""
    lines = in_words(model).splitlines()
    at = next(i for i, line in enumerate(lines) if line.strip().startswith(heading))
    return np.array(
        [re.findall(r"-?\d+\.\d+", line) for line in lines[at + 1 : at + 1 + rows]], float
    )


def test_the_matrix_subtracts_what_the_slots_add(model):
    np.testing.assert_allclose(rate_matrix(model), np.eye(3) - _ERROR, atol=1e-6)


def test_fusion_with_these_settings_gives_the_same_rates(model):
    text = next(line for line in in_words(model).splitlines() if "sensitivity" in line)
    sensitivity = np.array(re.findall(r"-?\d+\.\d+", text), float)
    ours = printed(model, "misalignment") @ (sensitivity * _RATE)
    np.testing.assert_allclose(ours, _RATE - _ERROR @ _RATE, atol=1e-3)


def test_kalibr_with_these_settings_predicts_the_measured_rates(model):
    lower, rotation = printed(model, "M:"), printed(model, "C_gyro_i:")
    assert np.abs(np.triu(lower, 1)).max() == 0.0
    np.testing.assert_allclose(rotation @ rotation.T, np.eye(3), atol=1e-5)
    np.testing.assert_allclose(lower @ rotation @ (_RATE - _ERROR @ _RATE), _RATE, atol=2e-3)


def test_a_model_without_rates_has_no_matrix():
    slot = Slot(Term("temp", 10.0, 40.0), (0.01, 0.0, 0.0), "channel")
    scales = Scales("MPU-6050", 100.0, 131.0, 16384.0, 340.0, 36.53)
    assert rate_matrix(build_model([slot], scales)) is None
