"""From recordings to a report, and to a model that is bound to their chip."""

import json
from dataclasses import replace

import numpy as np
import pyarrow.parquet as pq
import pytest
from zerorate_bench.loop.simulated import simulate
from zerorate_tools.closing import close
from zerorate_tools.loop.analyse import sessions_of
from zerorate_tools.loop.read.gate import CannotClose
from zerorate_tools.loop.read.ticks import read_ticks
from zerorate_tools.model import Binding, read_model
from zerorate_tools.model.model import binding_of
from zerorate_tools.model.term import Term
from zerorate_tools.recordings import Recording, Scales, write_recording
from zerorate_tools.replay import replay

from .power_ons import SCALES, recording, written


def test_a_device_with_hysteresis_is_closed(closed):
    result, folder = closed
    assert result == json.loads((folder / "report.json").read_text())
    assert result["effects"][0]["effect"] == "thermal-hysteresis"
    assert result["verdict"] == "effects-found"
    assert sum(result["after_mdps"]) < 0.75 * sum(result["before_mdps"])
    for low, high in result["ci95_mdps"]["after"]:
        assert low < high
    assert result["smallest_detectable_mdps"]["thermal-hysteresis"] > 0
    assert read_model(folder / "model.bin").slots[0].effect == "thermal-hysteresis"
    # the integers, of the numbers; and learning online is better than frozen
    assert 0 < result["integer_rounding_of_floor"] < 0.1
    for way in ("before_mdps", "after_mdps"):
        assert np.linalg.norm(result["online"][way]) < np.linalg.norm(result[way])


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


def corrected(folder, log):
    table = pq.read_table(folder / "corrected.parquet").to_pandas()
    return table[table.recording == log.name]


def test_online_is_what_replay_gives_with_the_model(closed, logs, tmp_path):
    _, folder = closed
    state = None
    for log in logs:
        done = replay(
            log, model=folder / "model.bin", from_state=state, state=tmp_path / "state.bin"
        )
        state = tmp_path / "state.bin"
        rows = corrected(folder, log)
        for axis in "xyz":
            by_replay = done.table[f"bias_g{axis}"].to_numpy()
            assert (rows[f"bias_online_g{axis}"].to_numpy() == by_replay).all()


def test_the_figures_are_those_of_the_columns(closed, logs):
    result, folder = closed
    rows = corrected(folder, logs[-1])
    rate = recording(simulate(7, [("thermal-hysteresis", 5.0)]).sessions[-1]).columns
    for way, figures in (
        ("before", result["before_mdps"]),
        ("after", result["after_mdps"]),
        ("online", result["online"]["after_mdps"]),
    ):
        for axis, figure in zip("xyz", figures):
            error = rate[f"g{axis}"] - rows[f"bias_{way}_g{axis}"].to_numpy()
            blocks = error.reshape(-1, 20).mean(axis=1)[-160:] / 1.31
            assert np.sqrt(np.mean(blocks**2)) == pytest.approx(figure, rel=0.1)


def test_every_effect_is_judged_by_the_model_with_it_alone(closed):
    result, _ = closed
    steps = result["effects"]
    assert steps[0]["before_mdps"] == result["before_mdps"]
    assert steps[-1]["after_mdps"] == result["after_mdps"]
    for one, following in zip(steps, steps[1:]):
        assert one["after_mdps"] == following["before_mdps"]


def test_of_three_recordings_every_row_is_left_out_once(logs, tmp_path):
    result = close(logs[:3], tmp_path)
    assert [e["effect"] for e in result["effects"]] == ["thermal-hysteresis"]
    split = result["split"]
    assert split["pieces_of"] == split["train"] == ["session-1", "session-2"]
    rows = pq.read_table(tmp_path / "corrected.parquet").to_pandas()
    assert set(rows["split"]) == {"test"} and not any("online" in name for name in rows)
    before, after = (np.array(split[f"pieces_{way}_mdps"]) for way in ("before", "after"))
    assert (after <= before).all() and after.max() < 0.5 * before.max()


@pytest.mark.parametrize(
    "term", [Term("vdd_mv", 3200.0, 3400.0, 3300.0, second="temp", knot=4.0), Term("time")]
)
def test_a_term_survives_json_without_infinities(term):
    assert Term.from_dict(json.loads(json.dumps(term.to_dict(), allow_nan=False))) == term


MPU6050 = Scales("MPU-6050", 100.0, 131.0, 16384.0, 340.0, 36.53)
RECORDED = {"chip_id": 0x68, "gyro_range": 0, "accel_range": 0, "filter": 3}


def test_what_the_recorder_wrote_is_the_binding():
    assert binding_of(replace(MPU6050, more={"binding": RECORDED})) == Binding(0x68, 0, 0, 3)


def test_of_a_foreign_recording_the_name_and_the_scales_tell_what_they_can():
    assert binding_of(MPU6050) == Binding(0x68, 0, 0, None)
    assert binding_of(replace(MPU6050, gyro_lsb_per_dps=16.4)).gyro_range == 3
    assert binding_of(Scales("ADIS16405", 100.0, 20.0)) == Binding()


@pytest.fixture(scope="module")
def sessions(tmp_path_factory):
    """Power-ons of a chip that the recorder knew."""
    folder = tmp_path_factory.mktemp("bound")

    def written(session, **binding):
        path = folder / f"{session.name}{len(list(folder.iterdir()))}.parquet"
        scales = replace(SCALES, more={"binding": {**RECORDED, **binding}})
        write_recording(replace(recording(session), scales=scales), path)
        return path

    return written


def test_close_writes_the_binding_of_its_recordings(sessions, tmp_path):
    close([sessions(s) for s in simulate(8, sessions=3).sessions], tmp_path)
    assert read_model(tmp_path / "model.bin").binding == Binding(0x68, 0, 0, 3)


@pytest.mark.parametrize("name", ["chip_id", "filter"])
def test_close_refuses_a_session_of_another_chip_or_filter_and_names_it(sessions, tmp_path, name):
    first, second = simulate(8).sessions[:2]
    logs = [sessions(first), sessions(second, **{name: 5})]
    with pytest.raises(CannotClose, match=f"{logs[1].stem}: its {name} is 5, but"):
        close(logs, tmp_path)
    assert not list(tmp_path.iterdir())
