"""What of a recording counts as rest."""

from dataclasses import replace

import numpy as np
import pytest
from zerorate_bench.loop.trials import NOISES_DPS, RATES_HZ, share_used, shares_with_turn
from zerorate_tools.closing import close
from zerorate_tools.loop.analyse import analyse
from zerorate_tools.loop.motion.by_windows import (
    GIVEN,
    GRAVITY,
    UNIT,
    RateScale,
    _judged_by_heading,
)
from zerorate_tools.loop.motion.scales_and_timing import in_motion, slots_of, without_scales
from zerorate_tools.loop.read.blocks import session_of
from zerorate_tools.loop.read.reference import RATES, Reference
from zerorate_tools.loop.read.still import still_ticks
from zerorate_tools.loop.read.ticks import read_ticks
from zerorate_tools.loop.report.in_words import in_words
from zerorate_tools.loop.report.unexplained import not_excluded
from zerorate_tools.recordings import Recording, Scales, write_recording
from zerorate_tools.recordings.checks import GAP
from zerorate_tools.simulate import simulate_sessions

from .power_ons import SCALES as WITH_ACCELEROMETER
from .power_ons import turning, written

ODR = 20
SCALES = Scales("MPU-6050", float(ODR), 131.0, None, 340.0, 36.53)


@pytest.fixture
def still(tmp_path):
    """(m,) bool of a rate in dps and a temperature in degC, each a sample."""

    def of(rate_dps, temp_degc):
        columns = turning(3, rate_dps, ODR)
        columns["temp"] = np.round((temp_degc - 36.53) * 340).astype(np.int32)
        [path] = written(tmp_path, [Recording(columns, SCALES, "run")])
        return still_ticks(read_ticks(path))

    return of


def test_a_steep_part_on_a_fast_ramp_is_still(still):
    at_s = np.arange(ODR * 2400) / ODR
    temp = 20 + np.abs((at_s - 300) % 1200 - 600) * 2.5 / 60  # up and down without a hold
    assert still(0.35 * temp, temp).mean() > 0.99


def test_a_turn_on_a_fast_ramp_is_no_rest(still):
    at_s = np.arange(ODR * 2400) / ODR
    temp = 20 + np.clip(at_s - 300, 0, 840) * 2.5 / 60
    turning = (at_s >= 600) & (at_s < 700)
    resting = still(0.35 * temp + 5.0 * turning, temp)
    assert not resting[600:700].any() and resting[:590].all() and resting[710:].all()


def test_a_turn_that_sets_in_slowly_is_motion_to_its_ends(still):
    at_s = np.arange(ODR * 900) / ODR
    swing = 2.0 * (1 - np.cos(2 * np.pi * np.clip(at_s - 400, 0, 60) / 60))
    resting = still(swing, np.full(len(at_s), 25.0))
    assert not resting[404:456].any()
    assert resting[:395].all() and resting[465:].all()


def test_a_bias_that_settles_up_to_a_turn_is_at_rest_before_it(still):
    at_s = np.arange(ODR * 1800) / ODR
    turning = 30.0 * ((at_s >= 150) & (at_s < 165))
    resting = still(0.6 * np.exp(-at_s / 110) + turning, np.full(len(at_s), 25.0))
    assert resting[:110].all() and resting[210:].all() and not resting[150:165].any()


def test_what_stays_where_a_knock_put_it_is_at_rest(still):
    at_s = np.arange(ODR * 1800) / ODR
    knocks = 40.0 * (np.abs((at_s - 600) % 100 - 1) < 1) * (at_s >= 600) * (at_s < 702)
    bias = 0.6 * ((at_s >= 600) & (at_s < 700))
    resting = still(bias + knocks, np.full(len(at_s), 25.0))
    assert resting[570:597].all() and resting[605:697].all() and resting[705:].all()
    assert not resting[600:602].any() and not resting[700:702].any()


def test_a_motion_that_the_recording_begins_with_is_motion_until_it_died_down(still):
    at_s = np.arange(ODR * 1800) / ODR
    resting = still(2.0 * np.exp(-at_s / 8), np.full(len(at_s), 25.0))
    assert not resting[:25].any() and resting[40:].all()


def test_what_shakes_as_a_recording_begins_or_ends_is_no_rest(tmp_path):
    rng, seconds = np.random.default_rng(4), 600
    at_s = np.arange(int(ODR) * seconds) / ODR
    shaken = (at_s < 60) | (at_s >= 540)
    columns = turning(4, np.zeros(len(at_s)), ODR)
    columns["temp"] = np.zeros(len(at_s), np.int32)
    for name, g in zip(("ax", "ay", "az"), (0.0, 0.0, 1.0)):
        noise = rng.normal(0, np.where(shaken, 0.3, 0.004))
        columns[name] = np.round((g + noise) * 16384).astype(np.int32)
    [path] = written(tmp_path, [Recording(columns, replace(WITH_ACCELEROMETER, odr_hz=ODR), "run")])
    resting = still_ticks(read_ticks(path))
    assert resting[:50].mean() < 0.2 and resting[550:].mean() < 0.2
    assert resting[75:525].all()


def test_a_device_mostly_in_motion_keeps_its_rests(still):
    at_s = np.arange(ODR * 1200) / ODR
    moving = at_s % 100 >= 19
    hand = np.repeat(np.random.default_rng(5).normal(0, 30, 2400), ODR // 2) * moving
    resting = still(hand, np.full(len(at_s), 25.0))
    assert resting.sum() > 0.8 * 228 and not resting[25:98].any()


@pytest.mark.parametrize("accel", [False, True])
@pytest.mark.parametrize("noise_dps", NOISES_DPS)
@pytest.mark.parametrize("odr_hz", RATES_HZ)
def test_a_rest_at_any_rate_and_noise_is_used(tmp_path, odr_hz, noise_dps, accel):
    assert share_used(tmp_path, odr_hz, noise_dps, accel) > 95


@pytest.mark.parametrize("noise_dps", NOISES_DPS)
@pytest.mark.parametrize("odr_hz", RATES_HZ)
def test_a_turn_at_any_rate_and_noise_is_not(tmp_path, odr_hz, noise_dps):
    turn, beside = shares_with_turn(tmp_path, odr_hz, noise_dps)
    assert turn == 0
    assert beside > 95


MATRIX = [[0.0, 0.02, -0.01], [0.01, 0.0, 0.02], [-0.02, 0.01, 0.0]]
SCALE = {"kind": "scale", "dps": [0.01, -0.02, 0.015]}
CROSS = {"kind": "scale", "dps": 1.0, "matrix": MATRIX}
LATE = {"kind": "timing", "delay_ms": 5.0}
HANDLED = [{"kind": "rest", "s": 20}, {"kind": "hand", "s": 40}]
TURNED = [
    bout
    for face in ("+x", "-y", "-z", "-x", "+y", "+z")
    for bout in (
        {"kind": "rest", "s": [15, 25]},
        {"kind": "pose", "face": face, "s": 3},
        {"kind": "rest", "s": 15},
        {"kind": "turn", "axis": "random", "deg": 100, "s": 3},
    )
]


def sessions(folder, effect, motion, attitude, count=3, minutes=5, rates=False):
    """Sessions at 25 Hz; the accelerometer is off by 30 mg. rates: whether true ones are there."""
    description = {
        "sessions": count,
        "sensor": {"odr_hz": 25.0, "accel_bias_g": [0.03, -0.02, 0.04]},
        "every_session": {"minutes": minutes, "motion": motion},
        "effect": effect,
    }
    out = []
    for i, (recording, truth) in enumerate(simulate_sessions(description, seed=5)):
        columns = dict(recording.columns)
        for name, q in zip(("qw", "qx", "qy", "qz"), truth.attitude.T if attitude else ()):
            columns[name] = np.rint(q * 2**29).astype(np.int32)
        for name, dps in zip(RATES, truth.rate_dps.T if rates else ()):
            columns[name] = np.rint(dps * recording.scales.gyro_lsb_per_dps).astype(np.int32)
        path = folder / f"{i}.parquet"
        write_recording(replace(recording, columns=columns), path)
        out.append(session_of(read_ticks(path), 20.0))
    return out


def shown(folder, effect, attitude):
    made = sessions(folder, effect, HANDLED if attitude else TURNED, attitude)
    return made, in_motion(made[:-1], made[-1:], logs_of(folder, made))


def logs_of(folder, made):
    return {s.name: folder / f"{i}.parquet" for i, s in enumerate(made)}


def test_where_rests_suffice_and_an_attitude_is_given_the_heading_held_out_is_told(tmp_path):
    sessions(tmp_path, [SCALE], HANDLED, True, count=2, minutes=10)
    result = close([tmp_path / f"{i}.parquet" for i in range(2)], tmp_path / "closed")
    [effect] = [e for e in result["effects"] if "in_motion" in e]
    motion = effect["in_motion"]
    assert motion["heading_before"] > 0.5
    assert motion["heading_after"] < 0.4 * motion["heading_before"]
    words = f"{motion['heading_after']:.2f} degrees a minute of heading"
    assert words in in_words(result)
    assert words in (tmp_path / "closed" / "report.html").read_text()


def test_of_a_log_alone_the_second_half_tells_the_heading_beside_turns_of_the_first(tmp_path):
    alone = sessions(tmp_path, [SCALE], HANDLED, True, count=1, minutes=10)
    before, after = in_motion(alone, [], logs_of(tmp_path, alone)).scales.heading
    assert 0.5 < before and after < 0.4 * before


@pytest.mark.parametrize("attitude", [True, False], ids=["attitude", "gravity"])
def test_nothing_is_found_in_the_motion_of_a_sensor_without_fault(tmp_path, attitude):
    _, motion = shown(tmp_path, [], attitude)
    assert motion.rate_scale is not None and not motion.found and slots_of(motion) == []


@pytest.mark.parametrize("attitude", [True, False], ids=["attitude", "gravity"])
@pytest.mark.parametrize(
    ("effect", "kind", "matrix"),
    [
        (SCALE, "scale-factor", np.diag(SCALE["dps"])),
        (CROSS, "cross-axis+turned-axes", np.array(MATRIX)),
    ],
    ids=["scale", "cross"],
)
def test_scale_and_cross_axis_are_named_and_measured(tmp_path, effect, kind, matrix, attitude):
    _, motion = shown(tmp_path, [effect], attitude)
    assert motion.scales.kind == kind and motion.scales.confirmed
    assert motion.scales.matrix == pytest.approx(matrix, abs=0.002)
    assert motion.scales.after < 0.4 * motion.scales.before
    slots = slots_of(motion)
    assert [s.term.source for s in slots] == ["rate_x", "rate_y", "rate_z"]
    assert np.column_stack([s.coefficient_dps for s in slots]) == pytest.approx(matrix, abs=0.002)


def test_a_scale_that_turns_would_show_is_not_said_to_be_beyond_the_recordings(tmp_path):
    made = sessions(tmp_path, [], HANDLED, attitude=True, count=2)
    assert "rate-scale" not in not_excluded(analyse(made, logs=logs_of(tmp_path, made)))


@pytest.mark.parametrize("seen", [0, 1])
def test_of_nine_entries_one_at_least_must_be_seen(seen):
    unseen = np.arange(9).reshape(3, 3) >= seen
    large = np.full((3, 3), 0.05), np.full((3, 3), 0.01), 1e-9, "scale-factor", GIVEN, np.ones(2)
    shown = RateScale(*large, 2.0, 1.0, UNIT[GIVEN], 40, np.full(3, 300.0), unseen, 1.0)
    assert shown.found == (seen > 0)


@pytest.mark.parametrize(
    ("reference", "after", "found"),
    [(GIVEN, 6.1, True), (GIVEN, 6.2, False), (GRAVITY, 6.01, False), (GRAVITY, 5.9, True)],
)
def test_a_heading_given_may_scatter_by_2_percent_and_one_beside_gravity_may_not(
    monkeypatch, reference, after, found
):
    large = np.full((3, 3), 0.05), np.full((3, 3), 0.01), 1e-9, "scale-factor", reference
    seen = np.full(3, 300.0), np.zeros((3, 3), bool)
    shown = RateScale(*large, np.ones(2), 2.0, 1.0, UNIT[reference], 40, *seen, 1.0)
    monkeypatch.setattr(
        "zerorate_tools.loop.motion.by_windows.heading_lost", lambda judged: (6.0, after)
    )
    assert _judged_by_heading(shown, [], []).found is found


def test_beside_true_rates_what_turning_adds_is_taken_out_of_the_blocks_in_motion(tmp_path):
    made = sessions(tmp_path, [SCALE], HANDLED, False, count=2, rates=True)
    left = without_scales(made[0], in_motion(made, [], logs_of(tmp_path, made))).rate_dps
    assert np.nanstd(left, axis=0).max() < 0.7 * np.nanstd(made[0].rate_dps, axis=0).max()


def test_an_attitude_makes_no_rest_of_motion(tmp_path):
    with_it, without = (sessions(tmp_path, [], HANDLED, on, count=1)[0] for on in (True, False))
    assert np.array_equal(with_it.available, without.available) and not with_it.moved.any()


def test_readings_that_come_late_are_said_with_how_late(tmp_path):
    _, motion = shown(tmp_path, [LATE], attitude=True)
    assert motion.timing.found and motion.timing.delay_s == pytest.approx(5e-3, rel=0.05)


def test_an_attitude_without_a_value_was_not_seen():
    reference = Reference(["t_us", "qw", "qx", "qy", "qz"], 131.0)
    q = np.array([[1, 0, 0, 0], [GAP] * 4, [0, 0, 0, 0], [0, 1, 0, 0]])
    seen = reference.quaternions(dict(zip(("qw", "qx", "qy", "qz"), q.T)))
    assert np.isnan(seen).all(axis=1).tolist() == [False, True, True, False]
