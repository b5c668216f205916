"""From recordings to a report, and what bad recordings are told."""

import json
from dataclasses import replace

import numpy as np
import pyarrow.parquet as pq
import pytest
from zerorate_tools.bench.loop.simulated import simulate
from zerorate_tools.closing import close, load
from zerorate_tools.loop.analyse import sessions_of
from zerorate_tools.loop.read.gate import CannotClose, GateReport, usable_channels
from zerorate_tools.loop.read.sessions import Session
from zerorate_tools.loop.read.still import still_ticks
from zerorate_tools.loop.read.ticks import read_ticks
from zerorate_tools.recordings import Recording, Scales, write_recording

from . import power_ons
from .power_ons import SCALES


def recording(session, scales=SCALES):
    """A power-on with a load beside it, in hundredths."""
    columns = dict(power_ons.recording(session, scales).columns)
    columns["load"] = np.round(np.repeat(session.sources["load"], 5) * 100).astype(np.int32)
    return Recording(columns, scales, session.name)


@pytest.fixture(scope="module")
def hysteresis(tmp_path_factory):
    folder = tmp_path_factory.mktemp("device")
    paths = []
    for s in simulate(7, [("thermal-hysteresis", 5.0)]).sessions:
        paths.append(folder / f"{s.name}.parquet")
        write_recording(recording(s), paths[-1])
    return paths


def test_a_device_with_hysteresis_is_closed(hysteresis, tmp_path):
    result = close(hysteresis, tmp_path / "out")
    assert result == json.loads((tmp_path / "out" / "report.json").read_text())
    assert result["effects"][0]["effect"] == "thermal-hysteresis"
    assert result["verdict"] == "effects-found"
    assert sum(result["after_mdps"]) < 0.75 * sum(result["before_mdps"])
    for low, high in result["ci95_mdps"]["after"]:
        assert low < high
    assert result["smallest_detectable_mdps"]["thermal-hysteresis"] > 0
    assert (tmp_path / "out" / "model.bin").stat().st_size > 0


def test_corrected_rows_are_the_samples_and_agree_with_the_report(hysteresis, tmp_path):
    result = close(hysteresis, tmp_path / "out")
    frame = pq.read_table(tmp_path / "out" / "corrected.parquet").to_pandas()
    assert list(frame.columns[:3]) == ["recording", "t_us", "split"]
    test = frame[frame.split == "test"]
    assert set(test.recording) == {"session-4.parquet"} and len(test) == 3600
    raw = pq.read_table(hysteresis[-1]).to_pandas()
    error = raw.gx.to_numpy() - test.bias_after_gx.to_numpy()
    rms = np.sqrt(np.mean(error[60:] ** 2)) / 1.31
    assert rms == pytest.approx(result["after_mdps"][0], rel=0.15)


def test_another_recording_can_be_held_out(hysteresis):
    analysis = load(hysteresis, holdout=hysteresis[0])
    assert [s.name for s in analysis.holdout] == ["session-1"]


def test_the_same_recording_twice_is_refused(hysteresis):
    with pytest.raises(CannotClose, match="same samples"):
        load([hysteresis[0], hysteresis[0]])


def test_a_session_with_another_range_is_refused_and_named(hysteresis, tmp_path):
    other = recording(simulate(8).sessions[0], replace(SCALES, gyro_lsb_per_dps=655.0))
    path = tmp_path / "other-range.parquet"
    write_recording(other, path)
    with pytest.raises(CannotClose, match="other-range: gyro_lsb_per_dps is 655.0"):
        load([hysteresis[0], path])


def test_a_recording_too_short_is_told_how_long_is_needed(hysteresis, tmp_path):
    from zerorate_tools.recordings import read_recording

    path = tmp_path / "short.parquet"
    write_recording(read_recording(hysteresis[0]).between(0, 10), path)
    with pytest.raises(CannotClose, match="too short.*minutes at rest are needed"):
        load([path])


def test_a_recording_in_motion_is_told_to_rest(hysteresis, tmp_path):
    rng = np.random.default_rng(1)
    n = 10000
    columns = {"t_us": np.arange(n, dtype=np.int64) * 50_000}
    for name in ("gx", "gy", "gz"):
        swing = 60 * np.sin(np.arange(n) / rng.uniform(30, 90)) * 131
        columns[name] = np.round(swing + rng.normal(0, 6, n)).astype(np.int32)
    path = tmp_path / "swinging.parquet"
    write_recording(Recording(columns, Scales("MPU-6050", 20.0, 131.0), "swinging"), path)
    with pytest.raises(CannotClose, match="minutes are still"):
        load([path])


def test_rails_repeats_and_zero_frames_are_counted_and_set_aside(hysteresis, tmp_path):
    whole = recording(simulate(9).sessions[0], replace(SCALES, odr_hz=10.0))
    columns = {k: v.copy() for k, v in whole.columns.items()}
    columns["gx"][100] = 32767
    for name in columns:
        if name != "t_us":
            columns[name][200] = 0
            columns[name][301] = columns[name][300]
    columns["t_us"] //= 10
    path = tmp_path / "faulty.parquet"
    write_recording(Recording(columns, whole.scales, "faulty"), path)
    ticks = read_ticks(path)
    assert (ticks.faults["clipped"], ticks.faults["repeated"], ticks.faults["all-zero"]) == (
        1,
        1,
        1,
    )
    assert ticks.count.sum() == ticks.samples - sum(ticks.faults.values())


def test_constant_and_copied_channels_are_dropped_with_a_reason():
    rng = np.random.default_rng(1)
    wander = rng.normal(size=80)
    sources = {
        "load": wander,
        "twin": 3 * wander + 1,
        "dead": np.ones(80),
        "other": rng.normal(size=80),
    }
    session = Session("one", 20.0, 4, np.zeros((20, 3)), np.ones(20), sources)
    report = GateReport()
    usable_channels([session], report)
    assert set(session.sources) == {"load", "other"}
    assert "copy of load" in report.dropped["twin"] and report.dropped["dead"] == "constant"


def test_a_gap_in_time_leaves_blocks_out_and_invents_nothing(hysteresis, tmp_path):
    from zerorate_tools.recordings import read_recording

    whole = read_recording(hysteresis[0])
    keep = np.r_[0:1000, 1900 : len(whole)]
    columns = {k: v[keep] for k, v in whole.columns.items()}
    path = tmp_path / "gap.parquet"
    write_recording(Recording(columns, whole.scales, "gap"), path)
    sessions, _ = sessions_of([read_ticks(path), read_ticks(hysteresis[1])])
    assert 40 <= (~sessions[0].available).sum() <= 46
    assert all(np.isfinite(v).all() for v in sessions[0].sources.values())


def test_a_steady_turn_is_not_stillness(tmp_path):
    rng = np.random.default_rng(2)
    n = 20 * 600
    rate = np.where((np.arange(n) // 20) % 300 < 60, 5.0, 0.1)
    columns = {"t_us": np.arange(n, dtype=np.int64) * 50_000}
    for name in ("gx", "gy", "gz"):
        columns[name] = np.round((rate + rng.normal(0, 0.05, n)) * 131).astype(np.int32)
    path = tmp_path / "turning.parquet"
    write_recording(Recording(columns, Scales("MPU-6050", 20.0, 131.0), "turning"), path)
    still = still_ticks(read_ticks(path))
    assert not still[5:55].any() and still[70:290].all()


def test_two_sessions_leave_one_to_choose_on_and_one_to_judge_by(hysteresis):
    analysis = load(hysteresis[:2])
    assert [s.name for s in analysis.train] == ["session-1"]
    assert "thermal-hysteresis" in [f.candidate.kind for f in analysis.selection.found]


def test_long_recordings_with_long_gaps_get_longer_blocks(hysteresis, tmp_path):
    rng = np.random.default_rng(3)
    n = 8 * 3600
    columns = {"t_us": np.arange(n, dtype=np.int64) * 1_000_000}
    for name in ("gx", "gy", "gz"):
        columns[name] = rng.normal(0, 20, n).astype(np.int32)
    keep = (np.arange(n) // 1800) % 2 == 0
    columns = {k: v[keep] for k, v in columns.items()}
    path = tmp_path / "gaps.parquet"
    write_recording(Recording(columns, SCALES.__class__("MPU-6050", 1.0, 1310.0), "gaps"), path)
    sessions, _ = sessions_of([read_ticks(path)])
    assert sessions[0].blocks <= 250
