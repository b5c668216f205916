"""`bench real-motion`: what is judged, from where, and against which truth."""

import numpy as np
import pytest
from scipy.io import savemat
from zerorate_bench.real_motion import COLD, FIRST_REST, NONE, OURS, TOLD, in_markdown, run

HZ = 100
BIAS_DPS = np.array([0.3, -0.2, 0.1])


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A trial of fifteen seconds of rest, ten of turning to and fro, fifteen of rest."""
    t = np.arange(40 * HZ) / HZ
    moving = (t >= 15) & (t < 25)
    swing = np.where(moving, 90 * np.cos(2 * np.pi * 0.5 * (t - 15)), 0)[:, None] * [1, 0.5, 0.2]
    noise = np.random.default_rng(1).normal(0, 1, (2, len(t), 3))
    made = {
        "sampling_rate": HZ,
        "imu_gyr": np.radians(swing + BIAS_DPS + 0.05 * noise[0]),
        "imu_acc": 9.81 * ([0, 0, 1] + 0.003 * noise[1]),
        "opt_quat": np.tile([1.0, 0, 0, 0], (len(t), 1)),
        "movement": moving,
    }
    path = tmp_path_factory.mktemp("broad")
    savemat(path / "made.mat", made)
    return path


def test_the_bias_at_the_end_of_the_motion_is_judged_by_the_rest_after_it(folder):
    found = run([folder])
    uncorrected = 1000 * np.sqrt(np.mean(BIAS_DPS**2))
    for start in (FIRST_REST, COLD):
        assert found[start][NONE]["made"] == pytest.approx(uncorrected, abs=5)
        assert found[start][TOLD]["made"] == found[start][OURS]["made"]  # no other trial tells
    assert found[FIRST_REST][OURS]["made"] < 10
    assert found[COLD][OURS]["made"] > 50  # ten seconds of motion say little: the rest is not used


def test_worse_than_no_correction_is_counted_cold():
    errors = {OURS: [111.0, 50.0], "vqf": [90.0, 52.9], NONE: [100.0, 48.0]}
    one = {way: dict(zip("ab", two)) for way, two in errors.items()}
    rows = in_markdown({FIRST_REST: one, COLD: one}).splitlines()
    counted = {row.split("|")[1].strip(): row for row in rows if " of 2 |" in row}
    assert counted[OURS].endswith("| 1 of 2 |")
    assert counted["vqf"].endswith("| 0 of 2 |")  # by 10 %, but by less than 5 mdps
