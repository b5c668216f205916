"""`FloatCorrector`: floats in, the same floats without their bias out."""

import itertools
import re
from math import radians
from random import Random

import numpy as np
import pytest
import yaml
from zerorate.storage.learned_store import LearnedStore
from zerorate_tools.errors import BadModel, InFile
from zerorate_tools.host import FloatCorrector, store_file
from zerorate_tools.model import Slot, build_model, read_model
from zerorate_tools.model.model_in_words import in_words, rate_matrix
from zerorate_tools.model.term import Term
from zerorate_tools.recordings import Scales

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


def test_an_unknown_unit_is_refused():
    with pytest.raises(ValueError, match="rate is one of"):
        FloatCorrector(100, rate="deg/s")


@pytest.mark.parametrize("name", ["full_scale_dps", "full_scale_g"])
@pytest.mark.parametrize("most", [0, -250.0])
def test_a_range_of_nothing_is_refused_by_its_name(name, most):
    with pytest.raises(ValueError, match=f"{name} must be above 0, not {most}"):
        FloatCorrector(100, **{name: most})


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


_BIAS, _MEASURED = np.array([0.4, -0.3, 0.2]), np.array([120.0, -45.0, 200.0])
#: What the firmware makes of it with the matrix of the model.
_ERROR = np.array([[0.01, 0.002, -0.003], [0.004, -0.02, 0.001], [0.0, 0.005, 0.006]])
_TRUE = (np.eye(3) - _ERROR) @ (_MEASURED - _BIAS)


@pytest.fixture
def model(matrix_model):
    return read_model(matrix_model.path)


def after(model, heading):
    """The lines after the one that begins with a heading."""
    lines = in_words(model).splitlines()
    return lines[next(i for i, t in enumerate(lines) if t.strip().startswith(heading)) + 1 :]


def numbers(lines):
    return np.array([re.findall(r"-?\d+\.\d+", line) for line in lines], float)


def in_yaml(model, heading, name):
    """A matrix of the YAML after a heading."""
    lines = itertools.takewhile(lambda line: line.startswith("  "), after(model, heading))
    return yaml.safe_load("\n".join(lines))[name]


def test_the_matrix_subtracts_what_the_slots_add(model):
    np.testing.assert_allclose(rate_matrix(model), np.eye(3) - _ERROR, atol=1e-6)


def test_the_plain_matrix_times_the_rate_less_its_bias_is_the_true_rate(model):
    ours = numbers(after(model, "corrected rate")[:3]) @ (_MEASURED - _BIAS)
    np.testing.assert_allclose(ours, _TRUE, atol=2e-3)


def test_fusion_with_these_settings_gives_the_true_rate(model):
    fusion = pytest.importorskip("imufusion")
    lines = after(model, "misalignment")
    ours = fusion.model_inertial(_MEASURED, numbers(lines[:3]), numbers(lines[3:4])[0], _BIAS)
    np.testing.assert_allclose(ours, _TRUE, atol=2e-3)


def test_kalibr_with_these_settings_predicts_the_measured_rate(model):
    """Scale-misalignment: measured = M C_gyro_i true + bias (A, of acceleration, is zero)."""
    of = in_yaml(model, "kalibr", "gyroscopes")
    lower, rotation = np.array(of["M"]), np.array(of["C_gyro_i"])
    assert np.abs(np.triu(lower, 1)).max() == 0.0
    np.testing.assert_allclose(rotation @ rotation.T, np.eye(3), atol=1e-5)
    np.testing.assert_allclose(lower @ rotation @ _TRUE + _BIAS, _MEASURED, atol=2e-3)


def test_open_vins_with_these_settings_gives_the_true_rate(model):
    """true = R_IMUtoGYRO^T Tw^-1 (measured - bias), Tg zero."""
    of = in_yaml(model, "OpenVINS", "imu0")
    inner = np.linalg.solve(np.array(of["Tw"]), _MEASURED - _BIAS)
    np.testing.assert_allclose(np.array(of["R_IMUtoGYRO"]).T @ inner, _TRUE, atol=2e-3)


def test_a_model_without_rates_has_no_matrix():
    slot = Slot(Term("temp", 10.0, 40.0), (0.01, 0.0, 0.0), "channel")
    scales = Scales("MPU-6050", 100.0, 131.0, 16384.0, 340.0, 36.53)
    assert rate_matrix(build_model([slot], scales)) is None


@pytest.mark.parametrize("data", [b"t_us,gx\n0,1\n" * 999, b"ZRM" + bytes(2045), bytes(9999)])
def test_a_file_that_holds_something_else_is_no_store(tmp_path, data):
    (tmp_path / "mine.csv").write_bytes(data)
    with pytest.raises(InFile, match="mine.csv"):
        store_file(tmp_path / "mine.csv")
    assert (tmp_path / "mine.csv").read_bytes() == data


def test_a_store_is_known_however_torn_or_rotten_it_is(tmp_path):
    path = tmp_path / "learned.bin"
    store = LearnedStore(store_file(path), b"", FloatCorrector(100).corrector)
    torn, one = tmp_path / "torn.bin", (store.save(), path.read_bytes())[1]
    two = (store.save(), path.read_bytes())[1]
    rotten = Random(1).randbytes(len(one))
    wholes = one, two, rotten + one, rotten + rotten
    for left in (b"", b"Z", one[:100], rotten + one[:100], *wholes, bytes(100)):
        torn.write_bytes(left)
        assert LearnedStore(store_file(torn), b"", FloatCorrector(100).corrector).save()
