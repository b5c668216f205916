"""What of a recording counts as rest, and what its motion shows beside it."""

from dataclasses import replace

import numpy as np
import pytest
from zerorate_bench.loop.trials import NOISES_DPS, RATES_HZ, share_used, shares_with_turn
from zerorate_tools.loop.analyse import analyse
from zerorate_tools.loop.motion.scales_and_timing import in_motion, slots_of
from zerorate_tools.loop.read.blocks import session_of
from zerorate_tools.loop.read.still import still_ticks
from zerorate_tools.loop.read.ticks import read_ticks
from zerorate_tools.loop.report.unexplained import not_excluded
from zerorate_tools.recordings import Recording, Scales, write_recording
from zerorate_tools.simulate import simulate_sessions

from .power_ons import turning, written

HZ = 20


def _ramp(at_s):
    return 20 + np.clip(at_s - 300, 0, 840) * 2.5 / 60


def _swing(at_s):
    return 2.0 * (1 - np.cos(2 * np.pi * np.clip(at_s - 400, 0, 60) / 60))


def _knocked(at_s):
    knocks = 40.0 * (np.abs((at_s - 600) % 100 - 1) < 1) * (at_s >= 600) * (at_s < 702)
    return knocks + 0.6 * ((at_s >= 600) & (at_s < 700))


def _settling(at_s):
    return 0.6 * np.exp(-at_s / 110) + 30.0 * ((at_s >= 150) & (at_s < 165))


#: What happens: minutes, dps, and degC by seconds; where it rests, and where it moves, in s.
_COURSES = {
    "a turn on a fast ramp": (
        *(40, lambda s: 0.35 * _ramp(s) + 5.0 * ((s >= 600) & (s < 700)), _ramp),
        *([(0, 590), (710, 2400)], [(600, 700)]),
    ),
    "a turn that sets in slowly": (15, _swing, None, [(0, 395), (465, 900)], [(404, 456)]),
    "a bias that settles up to a turn": (
        *(30, _settling, None, [(0, 110), (210, 1800)], [(150, 165)]),
    ),
    "a step where a knock put it": (
        *(30, _knocked, None),
        *([(570, 597), (605, 697), (705, 1800)], [(600, 602), (700, 702)]),
    ),
    "a motion at the beginning": (30, lambda s: 2 * np.exp(-s / 8), None, [(40, 1800)], [(0, 25)]),
}


@pytest.mark.parametrize("course", _COURSES)
def test_rest_is_told_from_motion_to_the_end_of_either(tmp_path, course):
    minutes, rate_dps, degc, rests, moves = _COURSES[course]
    resting = _still(tmp_path, minutes, rate_dps, degc)
    assert all(resting[a:b].all() for a, b in rests)
    assert not any(resting[a:b].any() for a, b in moves)


def _still(folder, minutes, rate_dps, degc=None):
    """(m,) bool of a rate in dps and a temperature in degC, by seconds."""
    at_s = np.arange(HZ * 60 * minutes) / HZ
    columns = turning(3, rate_dps(at_s), HZ)
    columns["temp"] = np.full(len(at_s), -4000) if degc is None else np.rint(degc(at_s) * 340)
    columns["temp"] = columns["temp"].astype(np.int32)
    scales = Scales("MPU-6050", float(HZ), 131.0, None, 340.0, 0.0)
    [path] = written(folder, [Recording(columns, scales, "run")])
    return still_ticks(read_ticks(path))


def test_a_device_that_warms_fast_or_mostly_moves_keeps_its_rests(tmp_path):
    def wave_degc(at_s):  # up and down without a hold
        return 20 + np.abs((at_s - 300) % 1200 - 600) * 2.5 / 60

    def hand_dps(at_s):
        hand = np.random.default_rng(5).normal(0, 30, 2400)
        return np.repeat(hand, HZ // 2) * (at_s % 100 >= 19)

    assert _still(tmp_path, 40, lambda s: 0.35 * wave_degc(s), wave_degc).mean() > 0.99
    resting = _still(tmp_path, 20, hand_dps)
    assert resting.sum() > 0.8 * 228 and not resting[25:98].any()


@pytest.mark.parametrize("noise_dps", NOISES_DPS)
@pytest.mark.parametrize("odr_hz", RATES_HZ)
def test_a_rest_at_any_rate_and_noise_is_used_and_a_turn_is_not(tmp_path, odr_hz, noise_dps):
    assert share_used(tmp_path, odr_hz, noise_dps, accel=True) > 95
    turn, beside = shares_with_turn(tmp_path, odr_hz, noise_dps)
    assert turn == 0 and beside > 95


MATRIX = [[0.0, 0.02, -0.01], [0.01, 0.0, 0.02], [-0.02, 0.01, 0.0]]
SCALE = {"kind": "scale", "dps": [0.01, -0.02, 0.015]}
CROSS = {"kind": "scale", "dps": 1.0, "matrix": MATRIX}
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


def sessions(folder, effect, motion, attitude, count=3):
    """(sessions of five minutes at 25 Hz, their logs); the accelerometer is off by 30 mg."""
    description = {
        "sessions": count,
        "sensor": {"odr_hz": 25.0, "accel_bias_g": [0.03, -0.02, 0.04]},
        "every_session": {"minutes": 5, "motion": motion},
        "effect": effect,
    }
    made, logs = [], {}
    for recording, truth in simulate_sessions(description, seed=5):
        columns = dict(recording.columns)
        for name, q in zip(("qw", "qx", "qy", "qz"), truth.attitude.T if attitude else ()):
            columns[name] = np.rint(q * 2**29).astype(np.int32)
        path = folder / f"{len(made)}.parquet"
        write_recording(replace(recording, columns=columns), path)
        made.append(session_of(read_ticks(path), 20.0))
        logs[made[-1].name] = path
    return made, logs


@pytest.fixture(scope="module")
def faultless(tmp_path_factory):
    """Those of a sensor without fault, by attitude."""
    return sessions(tmp_path_factory.mktemp("faultless"), [], HANDLED, attitude=True)


def shown(made, logs):
    return in_motion(made[:-1], made[-1:], logs)


@pytest.mark.parametrize("attitude", [True, False], ids=["attitude", "gravity"])
def test_nothing_is_found_in_the_motion_of_a_sensor_without_fault(tmp_path, faultless, attitude):
    motion = shown(*faultless if attitude else sessions(tmp_path, [], TURNED, False))
    assert motion.rate_scale is not None and not motion.found and slots_of(motion) == []


@pytest.mark.parametrize(
    ("effect", "kind", "matrix", "attitude"),
    [
        (SCALE, "scale-factor", np.diag(SCALE["dps"]), True),
        (CROSS, "cross-axis+turned-axes", np.array(MATRIX), False),
    ],
    ids=["scale by attitude", "cross-axis by gravity"],
)
def test_scale_and_cross_axis_are_named_and_measured(tmp_path, effect, kind, matrix, attitude):
    motion = shown(*sessions(tmp_path, [effect], HANDLED if attitude else TURNED, attitude))
    assert motion.scales.kind == kind and motion.scales.confirmed
    assert motion.scales.after < 0.4 * motion.scales.before
    slots = slots_of(motion)
    assert [s.term.source for s in slots] == ["rate_x", "rate_y", "rate_z"]
    assert np.column_stack([s.coefficient_dps for s in slots]) == pytest.approx(matrix, abs=0.002)


def test_a_scale_that_turns_would_show_is_not_said_to_be_beyond_the_recordings(faultless):
    made, logs = faultless
    assert "rate-scale" not in not_excluded(analyse(made[:2], logs=logs))


def test_an_attitude_makes_no_rest_of_motion(tmp_path, faultless):
    with_it, ((without, *_), _) = faultless[0][0], sessions(tmp_path, [], HANDLED, False, count=1)
    assert np.array_equal(with_it.available, without.available) and not with_it.moved.any()
