"""Recordings that only move: scale factor and axes from gravity, by `close` itself."""

import json
from dataclasses import replace

import numpy as np
import pytest
from scipy.ndimage import gaussian_filter1d
from zerorate_bench.loop.devices import describe
from zerorate_tools import LoopReport
from zerorate_tools.closing import close
from zerorate_tools.loop.motion.by_windows import _tilt, by_windows
from zerorate_tools.loop.motion.columns import BIAS, OWN, columns_of
from zerorate_tools.loop.motion.device import DifferentDevices, Shown, device_of
from zerorate_tools.loop.motion.matrix import beside
from zerorate_tools.loop.motion.moving import moving_of
from zerorate_tools.loop.read.gate import CannotClose
from zerorate_tools.recordings import Recording, Scales
from zerorate_tools.recordings.writing import write_recording
from zerorate_tools.simulate import simulate_sessions
from zerorate_tools.simulate.attitude import IDENTITY, integrate, into_body, multiply, rotation

from .test_report_form import breaches

_HZ, _MINUTES = 50.0, 2.5
_SCALES = Scales("MPU-6050", _HZ, 32.8, 8192.0, None, None)
_MATRIX = np.array([[0.012, 0.0, 0.003], [0.0, -0.009, 0.0], [0.003, 0.0, 0.006]])


def handled(
    seed, matrix, dps=60.0, about=(1.0, 1.0, 1.0), minutes=_MINUTES, seen=False, steady=0.0
):
    """A device turned in the hand without a rest: bias 0.4 dps, a hand that sways by 3 cm."""
    rng, n = np.random.default_rng(seed), int(_HZ * minutes * 60)

    def smooth(seconds):
        waves = gaussian_filter1d(rng.standard_normal((n, 3)), seconds * _HZ, axis=0)
        return waves / waves.std(axis=0)

    true = smooth(0.4) * dps * np.array(about) + steady
    attitude = integrate(true, 1 / _HZ, IDENTITY)
    hand = np.gradient(np.gradient(0.03 * smooth(0.3), 1 / _HZ, axis=0), 1 / _HZ, axis=0) / 9.81
    accel = into_body(attitude, hand + [0.0, 0.0, 1.0]) + 0.003 * rng.standard_normal((n, 3))
    rate = true + true @ matrix.T + [0.4, -0.3, 0.2] + 0.05 * rng.standard_normal((n, 3))
    columns = {"t_us": np.arange(n, dtype=np.int64) * int(1e6 / _HZ)}
    for letter, values, lsb in (("g", rate, 32.8), ("a", accel, 8192.0)):
        words = np.clip(np.round(values * lsb), -32768, 32767).astype(np.int64)
        columns.update({letter + axis: words[:, i] for i, axis in enumerate("xyz")})
    if seen:
        parts = np.round(30000 * attitude[:n]).astype(np.int64)
        columns.update({f"q{part}": parts[:, i] for i, part in enumerate("wxyz")})
    return Recording(columns, _SCALES, f"run-{seed}")


@pytest.fixture
def recorded(tmp_path):
    def write(seed, *args, **how):
        path = tmp_path / f"run-{seed}.parquet"
        write_recording(handled(seed, *args, **how), path)
        return path

    return write


def test_the_matrix_of_a_device_that_never_rests_is_found_and_deployed(recorded, tmp_path):
    result = close([recorded(1, _MATRIX), recorded(2, _MATRIX)], tmp_path / "closed")
    assert breaches(result, LoopReport) == []
    motion = result["in_motion"]
    off = np.array(motion["matrix_percent"]) / 100 - _MATRIX
    assert np.abs(off).max() < 0.001  # a third of the smallest entry
    assert motion["after"] < 0.5 * motion["before"]
    model = json.loads((tmp_path / "closed" / "model.json").read_text())
    assert {s["source"] for s in model["slots"]} == {"rate_x", "rate_y", "rate_z"}


def test_beside_a_recording_at_rest_those_that_only_move_are_looked_at(recorded, tmp_path):
    rest = Recording(dict(handled(4, _MATRIX, dps=0.0).columns), _SCALES, "rest")
    write_recording(rest, tmp_path / "rest.parquet")
    logs = [recorded(1, _MATRIX), tmp_path / "rest.parquet", recorded(2, _MATRIX)]
    result = close(logs, tmp_path / "closed")
    assert breaches(result, LoopReport) == []
    columns = result["effects"][-1]["coefficients"]
    off = np.transpose([columns[f"rate_{axis}"] for axis in "xyz"]) - _MATRIX
    assert np.abs(off).max() < 0.001
    alone = [note for note in result["gate"]["notes"] if "looked at in motion alone" in note]
    assert len(alone) == 2
    logs[0] = recorded(1, np.zeros((3, 3)), minutes=2.0)
    nothing = close(logs[:2], tmp_path / "closed")
    assert any("nothing in motion" in note for note in nothing["gate"]["notes"])


@pytest.mark.parametrize("others", [1, 0])
def test_with_an_attitude_the_heading_of_what_was_held_out_is_told(recorded, tmp_path, others):
    logs = [recorded(20 + i, _MATRIX, minutes=1.9) for i in range(others)]
    logs.append(recorded(22, _MATRIX, minutes=1.9, seen=True))
    motion = close(logs, tmp_path / "closed")["in_motion"]
    assert motion["heading_before"] > 1.0
    assert motion["heading_after"] < 0.4 * motion["heading_before"]
    assert "degrees a minute of heading" in (tmp_path / "closed" / "report.html").read_text()


@pytest.mark.parametrize(
    ("mounted_deg", "turned"), [((3.0, -5.0, 2.0), 0.03), ((20.0, -80.0, 120.0), 0.0)]
)
def test_how_a_body_is_mounted_is_told_from_how_the_axes_are_turned(tmp_path, mounted_deg, turned):
    matrix = _MATRIX + turned * np.array([[0.0, 0.0, 1.0], [0.0, 0.0, 0.0], [-1.0, 0.0, 0.0]])
    logs = [tmp_path / f"run-{seed}.parquet" for seed in (20, 22)]
    for seed, log in zip((20, 22), logs):
        recording = handled(seed, matrix, seen=True)
        names = [f"q{part}" for part in "wxyz"]
        attitude = np.column_stack([recording.columns[q] for q in names])
        body = multiply(attitude, rotation(np.array(mounted_deg)))
        body[np.arange(len(body)) % 200 < 25] = 0.0  # markers are hidden for half a second
        recording.columns.update(zip(names, np.rint(body).astype(np.int64).T))
        write_recording(recording, log)
    motion = close(logs, tmp_path / "closed")["in_motion"]
    assert np.abs(np.array(motion["matrix_percent"]) / 100 - matrix).max() < 0.002
    assert motion["unit"] == "degrees a minute of turn"


def test_a_matrix_of_one_half_that_makes_the_heading_of_the_other_worse_is_not_deployed(tmp_path):
    halves = [
        handled(s, np.eye(3) * scale, minutes=2.0, seen=True)
        for s, scale in ((1, 0.01), (51, 0.003))
    ]
    columns = {n: np.concatenate([h.columns[n] for h in halves]) for n in halves[0].columns}
    columns["t_us"] = np.arange(len(columns["t_us"]), dtype=np.int64) * int(1e6 / _HZ)
    write_recording(replace(halves[0], columns=columns), tmp_path / "run.parquet")
    shown = by_windows([moving_of(tmp_path / "run.parquet")], [])
    assert shown.gains[0] > 0 and not shown.found  # windows are better with it
    assert "heading would lose" in shown.notes[0]


def jumping(seed):
    """A recording whose attitude jumps by 10 degrees about the vertical, six times a minute."""
    recording = handled(seed, _MATRIX, minutes=4.0, seen=True)
    rng, n = np.random.default_rng(seed + 99), len(recording.columns["t_us"])
    turned = np.zeros(n)
    for at in rng.choice(n, 24):
        turned[at:] += rng.normal(0, np.radians(10.0))
    jumps = np.column_stack([np.cos(turned / 2), np.zeros((n, 2)), np.sin(turned / 2)])
    names = [f"q{part}" for part in "wxyz"]
    attitude = multiply(jumps, np.column_stack([recording.columns[q] for q in names]))
    recording.columns.update(zip(names, np.rint(attitude).astype(np.int64).T))
    return recording


def test_an_attitude_that_jumps_hides_nothing_of_what_gravity_shows(tmp_path):
    write_recording(jumping(2), tmp_path / "run.parquet")
    result = close([tmp_path / "run.parquet"], tmp_path / "closed")
    [effect] = result["effects"]
    found = np.array([effect["coefficients"][f"rate_{axis}"] for axis in "xyz"]).T
    assert np.abs(found - _MATRIX).max() < 0.001  # 0.007 by the attitude
    assert "run: gravity shows more" in json.dumps(result)


def test_a_hand_that_turns_one_way_more_than_back_is_no_bias(tmp_path):
    recording = handled(23, np.zeros((3, 3)), minutes=2.0, steady=(0.0, -150.0, 0.0))
    write_recording(recording, tmp_path / "run.parquet")
    moving = moving_of(tmp_path / "run.parquet")
    bias = np.degrees(moving.offset + beside(moving, np.zeros((3, 3))).own[BIAS])
    np.testing.assert_allclose(bias, [0.4, -0.3, 0.2], atol=0.05)  # -150 of y where it is the mean


def test_nothing_is_deployed_where_the_axes_are_right(recorded, tmp_path):
    result = close([recorded(4, np.zeros((3, 3)))], tmp_path / "closed")
    assert result["effects"] == []
    assert json.loads((tmp_path / "closed" / "model.json").read_text())["slots"] == []


def test_motion_about_one_axis_names_what_it_did_not_show(recorded, tmp_path):
    result = close([recorded(6, _MATRIX, about=(1.0, 0.0, 0.0))], tmp_path / "closed")
    assert {"scale of y", "scale of z"} <= set(result["in_motion"]["not_seen"])
    assert any("turn the device about it" in a for a in result["unexplained"]["measure_next"])


def test_recordings_of_two_devices_are_refused_by_name(recorded, tmp_path):
    one, other = [recorded(s, _MATRIX) for s in (7, 8)], [recorded(s, -_MATRIX) for s in (9, 10)]
    with pytest.raises(DifferentDevices) as refused:
        close([*one, *other, recorded(11, _MATRIX)], tmp_path / "closed")
    assert sorted(map(sorted, refused.value.groups)) == [["run-10", "run-9"], ["run-7", "run-8"]]


def test_a_recording_that_neither_rests_nor_turns_is_refused(recorded, tmp_path):
    with pytest.raises(CannotClose, match="minutes"):
        close([recorded(12, np.zeros((3, 3)), dps=2.0)], tmp_path / "closed")


def test_a_gap_of_days_leaves_the_motion_before_and_after_it(recorded):
    whole = moving_of(recorded(13, _MATRIX, minutes=3.0))
    late = np.arange(len(whole.at_s)) > len(whole.at_s) // 2
    parted = replace(whole, at_s=whole.at_s + 2e5 * late)
    assert parted.dt_s == pytest.approx(1 / _HZ)
    np.testing.assert_allclose(by_windows([parted], []).matrix, _MATRIX, atol=0.003)


def test_a_slow_recording_may_end_with_one_sample_more_than_it_is_read_in(recorded):
    moving = moving_of(recorded(19, np.zeros((3, 3)), minutes=1.8))
    slow = slice(None, 513 * 5, 5)  # 10 Hz, in parts of 512
    columns = columns_of(moving.part(slow), np.zeros((3, 3)), np.zeros(sum(OWN.values())))
    assert len(columns.seen) == 513


def test_a_few_bouts_of_a_hand_that_pushes_as_it_turns_show_no_matrix(tmp_path):
    description, _, _ = describe(104)
    recording, _ = next(iter(simulate_sessions(description, seed=104)))
    write_recording(recording, tmp_path / "run.parquet")
    shown = by_windows([moving_of(tmp_path / "run.parquet")], [])
    assert shown.runs > 8 and not shown.found  # it was told 8 % of cross-axis sensitivity


def test_a_loud_recording_that_hides_tilts_does_not_outweigh_a_quiet_one_when_judged():
    quiet, loud = np.array([[[2.0, 100.0]]] * 2), np.array([[[300.0, 0.001]]] * 2)
    assert _tilt([quiet, loud]) == pytest.approx((2.2, 2.2), abs=0.1)


def test_one_turn_between_two_rests_is_told_by_gravity_before_and_after_it(recorded):
    moving = moving_of(recorded(22, np.zeros((3, 3)), minutes=2.0))
    n, edge = len(moving.rate), round(10 * _HZ)
    still = (np.arange(n) < edge) | (np.arange(n) >= n - edge)
    rests = replace(moving, rate=np.where(still[:, None], 0.0, moving.rate), still=still)
    found = [beside(m, np.zeros((3, 3))).rows.there[:, -1].sum() for m in (moving, rests)]
    assert found == [0, 1]


@pytest.mark.parametrize(("precision", "share"), [(1e4, 0.0), (1e8, 1.0)])
def test_of_entries_that_heading_sees_those_are_deployed_that_surely_lessen_it(precision, share):
    said = Shown(np.eye(9) * precision, np.eye(3).ravel() * 0.01 * precision)
    seen = np.diag([0.0, *np.ones(8)])
    assert device_of([said]).kept([seen]) == pytest.approx(np.eye(9) - (1 - share) * seen)
