"""`compare` on logs in motion: what the matrix would win is what it wins on windows left out."""

import numpy as np
import pytest
from zerorate_tools.cli import main
from zerorate_tools.compare.matrix import WITH, matrix_of
from zerorate_tools.recordings import Recording
from zerorate_tools.recordings.writing import write_recording
from zerorate_tools.simulate import load_description, simulate

TRUTH = np.array(load_description("in-hand").effects[0]["matrix"])


def described(matrix, minutes):
    motion = [{"kind": "rest", "s": 5}]
    for axis, face in (("x", "+y"), ("y", "+x"), ("z", "+y")):
        motion.append({"kind": "pose", "face": face, "s": 1.5})
        motion.append({"kind": "swing", "axis": axis, "dps": 150, "hz": [0.2, 0.5], "s": 8.5})
        motion.append({"kind": "turn", "axis": axis, "deg": 300, "s": 4})
    return {
        "sensor": {"odr_hz": 50.0, "gyro_noise_dps": 0.05, "gyro_lsb_per_dps": 65.5},
        "bias": {"b0": [0.4, -0.3, 0.2]},
        "effect": [{"kind": "scale", "dps": 1.0, "matrix": np.asarray(matrix).tolist()}],
        "every_session": {"minutes": minutes, "motion": motion},
    }


@pytest.fixture
def log(tmp_path):
    def write(seed, matrix=TRUTH, attitude=False, minutes=2.0):
        recording, truth = simulate(described(matrix, minutes), seed=seed)
        columns = dict(recording.columns)
        if attitude:
            parts = np.round(truth.attitude * 30000).astype(np.int32)
            columns |= {f"q{n}": parts[:, i] for i, n in enumerate("wxyz")}
        path = tmp_path / f"log-{seed}.parquet"
        write_recording(Recording(columns, recording.scales, path.stem), path)
        return path

    return write


def test_a_log_with_an_attitude_tells_the_heading_that_its_own_other_half_wins(log):
    won = matrix_of([log(1, attitude=True)])
    assert won.deployed and won.tilt[1] < 0.5 * won.tilt[0]
    assert won.heading[1] < 0.3 * won.heading[0]
    assert won.heading[0] > 1.0
    assert "of heading" in won.sentence()


def test_of_two_logs_each_is_judged_by_the_other(log):
    won = matrix_of([log(1, attitude=True, minutes=1.5), log(2, minutes=1.5)])
    assert won.heading[1] < 0.3 * won.heading[0]


def test_without_an_attitude_only_tilt_is_told(log):
    won = matrix_of([log(3)])
    assert won.heading is None and [row[0] for row in won.rows()][1] == WITH


def test_right_axes_win_nothing(log):
    won = matrix_of([log(4, matrix=np.zeros((3, 3)), attitude=True)])
    assert not won.deployed and won.heading is None and len(won.rows()) == 1


def test_a_device_that_rests_says_nothing_of_motion(tmp_path):
    description = described(TRUTH, 1.0)
    description["every_session"]["motion"] = [{"kind": "rest", "s": 100}]
    write_recording(simulate(description)[0], tmp_path / "still.parquet")
    assert matrix_of([tmp_path / "still.parquet"]) is None


def test_logs_of_two_devices_are_said_to_be_so(log):
    logs = [log(s, m) for s, m in ((5, TRUTH), (6, TRUTH), (7, -TRUTH), (8, -TRUTH), (9, TRUTH))]
    won = matrix_of(logs)
    assert not won.deployed and "log-7" in won.sentence() and won.rows() == []


def test_the_command_says_it_in_a_sentence_and_two_rows(log, tmp_path, capsys):
    page = tmp_path / "page.html"
    assert main(["compare", str(log(1)), "--out", str(page)]) == 0
    said = capsys.readouterr().out
    assert "zerorate close" in said and WITH in said
    assert WITH in page.read_text()


def test_a_log_that_never_rests_is_still_told_what_the_matrix_wins(tmp_path, capsys):
    description = described(TRUTH, 1.5)
    del description["every_session"]["motion"][0]
    write_recording(simulate(description)[0], tmp_path / "never.parquet")
    assert main(["compare", str(tmp_path / "never.parquet")]) == 0
    assert capsys.readouterr().out.startswith("In motion the matrix would leave")
