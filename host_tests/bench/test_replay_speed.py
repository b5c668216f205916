"""A replay streams: its memory does not grow with the recording."""

import pyarrow.parquet as pq
import pytest
from zerorate_bench.replay_speed import replay_speed, write_long

MOST_GROWTH = 1.2


@pytest.mark.parametrize("suffix", [".parquet", ".csv"])
def test_a_recording_ten_times_as_long_takes_no_more_memory(suffix):
    short, long = replay_speed((0.3, 3.0), suffix, runs=1).values()
    assert long["peak_bytes"] <= MOST_GROWTH * short["peak_bytes"]


def test_the_recording_is_as_long_as_asked_and_its_time_runs_on(tmp_path):
    path = tmp_path / "long.parquet"
    write_long(path, 1.2)
    t_us = pq.read_table(path, columns=["t_us"])["t_us"].to_numpy()
    assert len(t_us) == 432_000
    assert set(t_us[1:] - t_us[:-1]) == {10_000}
