"""`FloatCorrector`: floats in, the same floats without their bias out."""

from math import nan, radians
from random import Random

import numpy as np
import pytest
from zerorate_tools.errors import BadModel
from zerorate_tools.host import FloatCorrector

BIAS_DPS = (0.31, -0.19, 1.08)


def at_rest(corrector, unit=1.0, g=1.0, seconds=30):
    """The mean of the last five seconds of a device at rest with BIAS_DPS."""
    noise = Random(1)
    last = []
    for _ in range(seconds * 100):
        rate = [(bias + noise.gauss(0, 0.05)) * unit for bias in BIAS_DPS]
        last.append(corrector.update(rate, (0.0, noise.gauss(0, 0.002) * g, g)))
    return [sum(row[axis] for row in last[-500:]) / 500 / unit for axis in range(3)]


@pytest.mark.parametrize("full_scale_dps", [250, 2000])
def test_degrees_a_second_lose_their_bias_whatever_the_range(full_scale_dps):
    corrector = FloatCorrector(100, full_scale_dps=full_scale_dps)
    assert at_rest(corrector) == pytest.approx([0, 0, 0], abs=0.01)
    assert corrector.bias() == pytest.approx(BIAS_DPS, abs=0.01)


def test_radians_a_second_and_metres_a_second_squared():
    corrector = FloatCorrector(100, rate="rad/s", accel="m/s2")
    assert at_rest(corrector, radians(1), 9.81) == pytest.approx([0, 0, 0], abs=0.01)


def test_a_reading_keeps_what_its_lsb_would_lose():
    corrector = FloatCorrector(100)
    at_rest(corrector)
    bias = corrector.bias()
    rate = (0.012345, -0.000321, 12.000777)
    corrected = corrector.update(rate, (0, 0, 1))
    assert corrected == pytest.approx([r - b for r, b in zip(rate, bias)], abs=1e-3)


def test_the_scale_that_was_chosen_is_said():
    said = FloatCorrector(100, full_scale_dps=250, rate="rad/s").said
    assert said == "1 LSB is 0.000133 rad/s (0.00763 dps) and 0.488 mg"


def test_what_is_no_number_teaches_nothing():
    corrector = FloatCorrector(100)
    corrected = corrector.update((nan, 1.0, 2.0), (0, 0, 1))
    assert corrected[1:] == (1.0, 2.0) and corrector.refused == 1


def test_an_unknown_unit_is_refused():
    with pytest.raises(ValueError, match="rate is one of"):
        FloatCorrector(100, rate="deg/s")


@pytest.mark.parametrize(("rate", "unit"), [("dps", 1.0), ("rad/s", radians(1))])
def test_a_matrix_is_applied_to_every_sample(matrix_model, rate, unit):
    corrector = FloatCorrector(100, rate=rate, model=matrix_model.path)
    given = matrix_model.rates_dps * unit
    left = [corrector.update(tuple(row), (0, 0, 1)) for row in given]
    wanted = given - given @ matrix_model.error.T
    np.testing.assert_allclose(left, wanted, atol=0.001 * unit)


def test_a_file_that_is_no_model_is_refused_by_name(tmp_path):
    (tmp_path / "model.bin").write_bytes(b"no model")
    with pytest.raises(BadModel, match=r"model\.bin"):
        FloatCorrector(100, model=tmp_path / "model.bin")
