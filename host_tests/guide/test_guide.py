"""`record --guide`: what it asks for, when it ends, and what the recording it made then gives."""

import io
from functools import partial

import numpy as np
import pytest
from zerorate_tools.boards import fake_chip, recorder
from zerorate_tools.boards.bus import stream_bus
from zerorate_tools.cli import main
from zerorate_tools.closing import close
from zerorate_tools.guide import (
    KNOWN,
    Guide,
    KnownSoFar,
    unknown,
)
from zerorate_tools.recordings import read_recording
from zerorate_tools.simulate import load_description, simulate


def truth():
    """(3, 3) what the emulated device's gyroscope adds."""
    return np.array(load_description("in-hand").effects[0]["matrix"])


@pytest.fixture(scope="module")
def recorded(tmp_path_factory):
    """(file, printed) of a recording of the emulated hand, made by the command."""
    out = tmp_path_factory.mktemp("guided") / "run.parquet"
    with pytest.MonkeyPatch.context() as patched:
        said = io.StringIO()
        patched.setattr("sys.stdout", said)
        assert main(["record", "fake:", "--guide", "--out", str(out)]) == 0
    return out, said.getvalue()


def test_it_ends_by_itself_within_two_minutes_when_all_nine_are_known(recorded):
    out, said = recorded
    assert read_recording(out).columns["t_us"][-1] < 120e6
    assert "9 of 9" in said and "not known" not in said


def test_the_recording_closed_gives_the_matrix_within_its_intervals(recorded, tmp_path):
    result = close([recorded[0]], tmp_path / "closed")
    motion = result["in_motion"]
    off = np.array(motion["matrix_percent"]) / 100 - truth()
    assert result["effects"]
    # 3.5 sigma, which the largest of nine exceeds once in 240 times
    assert (np.abs(off) < 1.8 * np.array(motion["ci95_percent"]) / 100).all()
    assert np.abs(off).max() < 1.5 * KNOWN


def test_turns_about_one_axis_leave_the_others_unknown_and_cost_no_more_the_longer_they_last():
    """What parts that are done state is kept; their samples are not."""
    turns = {"kind": "swing", "axis": "x", "dps": 180, "hz": 0.4, "s": 8.5}
    motion = [{"kind": "rest", "s": 5}, {"kind": "pose", "face": "+y", "s": 1.5}, turns]
    recording, _ = simulate(
        {
            "name": "turned",
            "sensor": {"odr_hz": 100.0, "gyro_noise_dps": 0.05},
            "bias": {"b0": [0.4, -0.3, 0.2]},
            "effect": [{"kind": "scale", "dps": 1.0, "matrix": truth().tolist()}],
            "every_session": {"minutes": 2.0, "motion": motion},
        }
    )
    known = KnownSoFar(recording.scales)
    for first in range(0, len(recording), 3000):
        known.look([{k: v[first : first + 3000] for k, v in recording.columns.items()}])
    assert sum(len(batch["t_us"]) for batch in known._batches) == 0
    assert known.sigma[0, 0] < 2 * KNOWN and known._kept.normal.any()
    assert not known.all_known and known.next_axis in (1, 2)
    assert {"scale of y", "scale of z"} <= set(unknown(known))


class Silent:
    def show(self, known):
        pass


def test_a_guide_beside_the_recording_sees_what_one_that_waits_sees(tmp_path):
    seen = {}
    for waits in (True, False):
        bus, clock, _ = fake_chip.in_hand()
        with Guide(Silent(), waits=waits) as guide:
            streamed = partial(stream_bus, bus, seconds=30, time_source=clock, done=guide.done)
            recorder.recorded(tmp_path / f"{waits}.parquet", guide.heard, streamed)
            seen[waits] = guide.known.seconds
    assert seen[True] == pytest.approx(30, abs=3) and 0 < seen[False] <= 30


def test_a_recording_that_ends_before_says_what_is_not_known(tmp_path, capsys):
    out = tmp_path / "run.parquet"
    assert main(["record", "fake:", "--guide", "--seconds", "20", "--out", str(out)]) == 0
    said = capsys.readouterr().out
    assert "not known yet: scale of x" in said and "zerorate close" in said
