"""The longest stretch at rest, and its Allan deviation."""

import numpy as np
import pytest
from zerorate_tools.loop.read.gate import CannotClose
from zerorate_tools.loop.read.stretch import deviation_of, still_stretch
from zerorate_tools.recordings import Recording, Scales, write_recording

HZ, N = 50.0, 30000


@pytest.fixture
def written(tmp_path):
    """Ten minutes of white noise of 0.05 dps; keep: samples that stay."""

    def write(hz=HZ, moving=(), keep=slice(None), n=N):
        gyro = np.random.default_rng(1).normal(0, 10, (n, 3))
        gyro[slice(*moving) if moving else slice(0)] *= 40
        columns = {"t_us": (np.arange(n) * 1e6 / hz).astype(np.int64)}
        columns.update({a: np.rint(v).astype(np.int32) for a, v in zip(("gx", "gy", "gz"), gyro.T)})
        columns = {name: values[keep] for name, values in columns.items()}
        path = tmp_path / "run.parquet"
        write_recording(Recording(columns, Scales("X", hz, 200.0), "run"), path)
        return path

    return write


@pytest.mark.parametrize(("hz", "each_s"), [(50.0, 0.1), (12.5, 0.1), (5.0, 0.2), (2.0, 0.5)])
def test_what_is_quiet_throughout_is_one_stretch(written, hz, each_s):
    rate, seconds = still_stretch(written(hz))
    assert seconds == pytest.approx(each_s)
    assert len(rate) * seconds == pytest.approx(N / hz, rel=0.01)


def test_white_noise_falls_with_the_square_root_of_time_to_minutes(written):
    tau_s, deviation = deviation_of(written())
    expected = 0.05 / np.sqrt(HZ * tau_s[:, None])
    few = tau_s < 10
    assert tau_s[-1] == pytest.approx(200, rel=0.01)
    assert np.abs(deviation[few] / expected[few] - 1).max() < 0.2


def test_motion_ends_a_stretch(written):
    rate, each_s = still_stretch(written(moving=(9000, 10000)))
    assert 395 <= len(rate) * each_s <= 400


def test_a_lost_tick_is_bridged_and_many_make_the_ticks_longer(written):
    lost = np.ones(N, bool)
    lost[1000:1008] = False
    assert still_stretch(written(keep=lost))[1] == 0.1
    bursts = np.arange(N) % 50 < 20
    rate, each_s = still_stretch(written(keep=bursts))
    assert each_s == 1.0 and len(rate) >= 599


def test_a_slow_recording_has_ticks_of_one_row(written):
    rate, each_s = still_stretch(written(hz=1 / 15, n=200))
    assert each_s == 15.0 and len(rate) == 200


def test_too_short_a_rest_is_a_sentence(written):
    with pytest.raises(CannotClose, match="run: never still for 450 s; leave it at rest longer"):
        still_stretch(written(hz=1 / 15, n=20))
