"""Samples summed over ticks of time."""

import numpy as np
import pytest
from zerorate_tools.loop.read.ticks import read_ticks
from zerorate_tools.recordings import Recording, Scales, write_recording


def read(path, t_us, odr_hz):
    rng = np.random.default_rng(2)
    words = {n: rng.integers(-40, 40, len(t_us)) for n in ("gx", "gy", "gz", "ax", "ay", "az")}
    scales = Scales("MPU-6050", odr_hz, 131.0, 16384.0)
    write_recording(Recording({"t_us": t_us, **words}, scales, path.stem), path)
    return read_ticks(path)


@pytest.mark.parametrize(
    ("every_s", "odr_hz"), [(15.0, 0.0666667), (14.9999925, 1 / 15), (0.99999, 1.0)]
)
def test_slow_samples_have_a_tick_each_though_their_rate_is_not_quite_what_it_says(
    tmp_path, every_s, odr_hz
):
    t_us = np.rint(np.arange(400) * every_s * 1e6).astype(np.int64)
    assert (read(tmp_path / "slow.parquet", t_us, odr_hz).count == 1).all()


def test_slow_samples_that_come_early_or_late_have_a_tick_each(tmp_path):
    jitter = np.random.default_rng(1).uniform(-0.2, 0.2, 400)
    t_us = np.rint((np.arange(400) + jitter) * 1e6).astype(np.int64)
    assert (read(tmp_path / "late.parquet", t_us, 1.0).count == 1).all()


def test_quick_samples_begin_with_the_first_tick(tmp_path):
    t_us = 5_000_000 + np.arange(1000) * 40_000
    ticks = read(tmp_path / "quick.parquet", t_us, 25.0)
    assert ticks.start_us == 5_000_000 and (ticks.count == 25).all()
