"""From recordings to a report, and what bad recordings are told."""

import json
from dataclasses import replace

import numpy as np
import pyarrow.parquet as pq
import pytest
from zerorate_bench.loop.simulated import simulate
from zerorate_tools.closing import load
from zerorate_tools.loop.analyse import sessions_of
from zerorate_tools.loop.read.gate import CannotClose
from zerorate_tools.loop.read.still import still_ticks
from zerorate_tools.loop.read.ticks import read_ticks
from zerorate_tools.loop.report.report import report
from zerorate_tools.recordings import Recording, Scales

from .power_ons import SCALES, recording, turning, written


def test_a_device_with_hysteresis_is_closed(closed):
    result, folder = closed
    assert result == json.loads((folder / "report.json").read_text())
    assert result["effects"][0]["effect"] == "thermal-hysteresis"
    assert result["verdict"] == "effects-found"
    assert sum(result["after_mdps"]) < 0.75 * sum(result["before_mdps"])
    for low, high in result["ci95_mdps"]["after"]:
        assert low < high
    assert result["smallest_detectable_mdps"]["thermal-hysteresis"] > 0
    assert (folder / "model.bin").stat().st_size > 0


def test_corrected_rows_are_the_samples_and_agree_with_the_report(logs, closed):
    result, folder = closed
    frame = pq.read_table(folder / "corrected.parquet").to_pandas()
    assert list(frame.columns[:3]) == ["recording", "t_us", "split"]
    test = frame[frame.split == "test"]
    assert set(test.recording) == {"session-4.parquet"} and len(test) == 3600
    raw = pq.read_table(logs[-1]).to_pandas()
    error = raw.gx.to_numpy() - test.bias_after_gx.to_numpy()
    rms = np.sqrt(np.mean(error[60:] ** 2)) / 1.31
    assert rms == pytest.approx(result["after_mdps"][0], rel=0.15)


def test_another_recording_can_be_held_out(logs):
    analysis = load(logs, holdout=logs[0])
    assert [s.name for s in analysis.holdout] == ["session-1"]


def test_the_same_recording_twice_is_refused(logs):
    with pytest.raises(CannotClose, match="same samples"):
        load([logs[0], logs[0]])


def test_rails_repeats_and_zero_frames_are_counted_and_set_aside(tmp_path):
    whole = recording(simulate(9).sessions[0], replace(SCALES, odr_hz=10.0))
    columns = {k: v.copy() for k, v in whole.columns.items()}
    columns["gx"][100] = 32767
    for name in columns:
        if name != "t_us":
            columns[name][200] = 0
            columns[name][301] = columns[name][300]
    columns["t_us"] //= 10
    [path] = written(tmp_path, [Recording(columns, whole.scales, "faulty")])
    ticks = read_ticks(path)
    assert [ticks.faults[kind] for kind in ("clipped", "repeated", "all-zero")] == [1, 1, 1]
    assert ticks.count.sum() == ticks.samples - sum(ticks.faults.values())


def test_a_gap_in_time_leaves_blocks_out_and_invents_nothing(logs, tmp_path):
    from zerorate_tools.recordings import read_recording

    whole = read_recording(logs[0])
    keep = np.r_[0:1000, 1900 : len(whole)]
    columns = {k: v[keep] for k, v in whole.columns.items()}
    [path] = written(tmp_path, [Recording(columns, whole.scales, "gap")])
    sessions, _ = sessions_of([read_ticks(path), read_ticks(logs[1])])
    assert 40 <= (~sessions[0].available).sum() <= 46
    assert all(np.isfinite(v).all() for v in sessions[0].sources.values())


def test_a_steady_turn_is_not_stillness(tmp_path):
    columns = turning(2, np.where(np.arange(20 * 600) // 20 % 300 < 60, 5.0, 0.1))
    scales = Scales("MPU-6050", 20.0, 131.0)
    [path] = written(tmp_path, [Recording(columns, scales, "turning")])
    still = still_ticks(read_ticks(path))
    assert not still[5:55].any() and still[70:290].all()


def test_two_sessions_leave_one_to_choose_on_and_one_to_judge_by(logs):
    analysis = load(logs[:2])
    assert [s.name for s in analysis.train] == ["session-1"]
    assert "thermal-hysteresis" in [f.candidate.kind for f in analysis.selection.found]


def test_nothing_that_is_deployed_is_told_as_refused(logs):
    analysis = load(logs[:2])
    for effect in ("thermal-hysteresis", "temperature-kink"):
        analysis.selection.refused.append((effect, "another of its kind"))
    told = dict(report(analysis)["gate"]["considered_and_refused"])
    assert "thermal-hysteresis" not in told and "temperature-kink" in told


def test_long_recordings_with_long_gaps_get_longer_blocks(tmp_path):
    columns = turning(3, np.zeros(8 * 3600), hz=1.0, noise_dps=0.15)
    keep = (np.arange(8 * 3600) // 1800) % 2 == 0
    columns = {k: v[keep] for k, v in columns.items()}
    scales = Scales("MPU-6050", 1.0, 131.0)
    [path] = written(tmp_path, [Recording(columns, scales, "gaps")])
    sessions, _ = sessions_of([read_ticks(path)])
    assert sessions[0].blocks <= 250
