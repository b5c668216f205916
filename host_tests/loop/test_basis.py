"""Terms as JSON, and the binding of a model to the chip that it was made from."""

import json
from dataclasses import replace

import pytest
from zerorate_bench.loop.simulated import simulate
from zerorate_tools.closing import close
from zerorate_tools.loop.read.gate import CannotClose
from zerorate_tools.model import Binding, read_model
from zerorate_tools.model.model import binding_of
from zerorate_tools.model.term import Term
from zerorate_tools.recordings import Scales, write_recording

from .power_ons import SCALES, recording


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
