"""Scale factor, cross-axis and late readings, found in motion that nobody declared."""

from dataclasses import replace

import numpy as np
import pytest
from zerorate_tools.loop.analyse import analyse
from zerorate_tools.loop.fit.regression import Regression
from zerorate_tools.loop.motion.in_motion import in_motion, slots_of, without_scales
from zerorate_tools.loop.read.blocks import session_of
from zerorate_tools.loop.read.reference import Reference
from zerorate_tools.loop.read.ticks import read_ticks
from zerorate_tools.loop.report.unexplained import not_excluded
from zerorate_tools.loop.search import steps as events
from zerorate_tools.recordings import write_recording
from zerorate_tools.recordings.checks import GAP
from zerorate_tools.simulate import simulate_sessions

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


def sessions(folder, effect, motion, attitude):
    """Four sessions of ten minutes at 25 Hz; the accelerometer is off by 30 mg."""
    description = {
        "sessions": 4,
        "sensor": {"odr_hz": 25.0, "accel_bias_g": [0.03, -0.02, 0.04]},
        "every_session": {"minutes": 10, "motion": motion},
        "effect": effect,
    }
    out = []
    for i, (recording, truth) in enumerate(simulate_sessions(description, seed=5)):
        columns = dict(recording.columns)
        for name, q in zip(("qw", "qx", "qy", "qz"), truth.attitude.T if attitude else ()):
            columns[name] = np.rint(q * 2**29).astype(np.int32)
        path = folder / f"{i}.parquet"
        write_recording(replace(recording, columns=columns), path)
        out.append(session_of(read_ticks(path), 20.0))
    return out


def shown(folder, effect, attitude):
    made = sessions(folder, effect, HANDLED if attitude else TURNED, attitude)
    return made, in_motion(made[:-1], made[-1:], single=False)


@pytest.mark.parametrize("attitude", [True, False], ids=["attitude", "gravity"])
def test_nothing_is_found_in_the_motion_of_a_sensor_without_fault(tmp_path, attitude):
    _, motion = shown(tmp_path, [], attitude)
    assert motion.rate_scale is not None and not motion.found and slots_of(motion) == []


@pytest.mark.parametrize("attitude", [True, False], ids=["attitude", "gravity"])
@pytest.mark.parametrize(
    ("effect", "kind", "matrix"),
    [(SCALE, "scale-factor", np.diag(SCALE["dps"])), (CROSS, "cross-axis", np.array(MATRIX))],
    ids=["scale", "cross"],
)
def test_scale_and_cross_axis_are_named_and_measured(tmp_path, effect, kind, matrix, attitude):
    _, motion = shown(tmp_path, [effect], attitude)
    assert motion.scales.kind == kind and motion.scales.confirmed
    assert motion.scales.matrix == pytest.approx(matrix, abs=0.002)
    assert motion.scales.after < 0.4 * motion.scales.before


def test_a_scale_that_turns_would_show_is_not_said_to_be_beyond_the_recordings(tmp_path):
    made = sessions(tmp_path, [], HANDLED, attitude=True)
    assert "rate-scale" not in not_excluded(analyse(made))


def test_the_scale_is_a_slot_of_each_rate_that_subtracts_what_was_added(tmp_path):
    made, motion = shown(tmp_path, [SCALE], attitude=True)
    slots = slots_of(motion)
    assert [s.term.source for s in slots] == ["rate_x", "rate_y", "rate_z"]
    assert slots[1].coefficient_dps[1] == pytest.approx(-0.02, abs=1e-3)
    left = without_scales(made[0], motion).rate_dps
    assert np.nanstd(left, axis=0).max() < 0.7 * np.nanstd(made[0].rate_dps, axis=0).max()


def test_readings_that_come_late_are_said_with_how_late(tmp_path):
    _, motion = shown(tmp_path, [LATE], attitude=True)
    assert motion.timing.found and motion.timing.delay_s == pytest.approx(5e-3, rel=0.05)


def test_no_step_of_the_bias_is_listed_in_the_midst_of_motion(tmp_path):
    made = sessions(tmp_path, [], HANDLED, attitude=True)
    moved = np.flatnonzero(made[1].moved)
    assert len(moved) > 5
    made[1].rate_dps[moved[2] :] += 5.0
    listed = events.find_all(Regression(made), [])
    assert all(s.block not in (*moved, *(moved + 1)) for s in listed if s.session == 1)


def test_an_attitude_without_a_value_was_not_seen():
    reference = Reference(["t_us", "qw", "qx", "qy", "qz"], 131.0)
    q = np.array([[1, 0, 0, 0], [GAP] * 4, [0, 0, 0, 0], [0, 1, 0, 0]])
    seen = reference.quaternions(dict(zip(("qw", "qx", "qy", "qz"), q.T)))
    assert np.isnan(seen).all(axis=1).tolist() == [False, True, True, False]
