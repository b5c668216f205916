"""The float reference of effect slots."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest
from zerorate_bench.loop.simulated import simulate
from zerorate_tools.closing import close
from zerorate_tools.loop.read.gate import CannotClose
from zerorate_tools.model import Binding, read_model
from zerorate_tools.model.model import binding_of
from zerorate_tools.model.term import Term, evaluate, first_order_lag, play
from zerorate_tools.recordings import Scales, write_recording

from .power_ons import SCALES, recording

RAMP = np.concatenate([np.full(5, 20.0), np.linspace(20, 40, 50), np.linspace(40, 25, 50)])


def sources_of(**values):
    ticks = len(next(iter(values.values())))
    return {"time": np.arange(ticks) + 0.5, "one": np.ones(ticks), **values}.__getitem__


def test_a_lag_is_the_recursion_that_the_firmware_runs():
    alpha, z, expected = 1 - math.exp(-1.0 / 30.0), RAMP[0], []
    for u in RAMP:
        z += alpha * (u - z)
        expected.append(z)
    assert first_order_lag(RAMP, 30.0, 1.0) == pytest.approx(expected, abs=1e-9)


def test_backlash_moves_only_when_its_play_is_used_up():
    p = play(np.array([0.0, 0.9, 1.5, 2.0, 1.2, 0.2, -1.0]), 2.0)
    assert p.tolist() == pytest.approx([0.0, 0.0, 0.5, 1.0, 1.0, 1.0, 0.0])


def test_hysteresis_differs_between_heating_and_cooling_at_the_same_temperature():
    v = evaluate(Term("temp", memory="backlash", width=4.0), sources_of(temp=RAMP), 1.0)
    assert v[30] == pytest.approx(-2.0) and v[80] == pytest.approx(2.0)


def test_a_source_outside_its_fitted_range_is_held_at_the_edge():
    term = Term("temp", lo=22.0, hi=35.0, centre=25.0, power=2)
    v = evaluate(term, sources_of(temp=np.array([0.0, 22.0, 35.0, 90.0])), 1.0)
    assert v.tolist() == [9.0, 9.0, 100.0, 100.0]


def test_the_highest_temperature_is_remembered():
    v = evaluate(Term("temp", memory="peak"), sources_of(temp=RAMP), 1.0)
    assert v[:55] == pytest.approx(np.zeros(55)) and v[-1] == pytest.approx(15.0)


def test_a_decay_starts_at_one_and_restarts_with_power():
    v = evaluate(Term("one", decay_s=10.0), sources_of(temp=RAMP), 1.0)
    assert v[0] == 1.0 and v[10] == pytest.approx(math.exp(-1.0))


def test_a_power_taken_first_is_not_a_power_taken_last():
    steps = sources_of(load=np.repeat([0.0, 2.0], 30))
    term = Term("load", power=2, lag_s=10.0, lag_mode="lag")
    first, last = (evaluate(replace(term, power_first=f), steps, 1.0)[35] for f in (True, False))
    assert first > last > 0


@pytest.mark.parametrize(
    "term", [Term("vdd_mv", 3200.0, 3400.0, 3300.0, second="temp", knot=4.0), Term("time")]
)
def test_a_term_survives_json_without_infinities(term):
    assert Term.from_dict(json.loads(json.dumps(term.to_dict(), allow_nan=False))) == term


def test_a_delay_holds_the_first_value_until_it_is_over():
    v = evaluate(Term("load", delay_s=3.0), sources_of(load=np.arange(6.0)), 1.0)
    assert v.tolist() == [0, 0, 0, 0, 1, 2]


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
    device = simulate(7, [("thermal-hysteresis", 5.0)])
    close([sessions(s) for s in device.sessions], tmp_path)
    assert read_model(tmp_path / "model.bin").binding == Binding(0x68, 0, 0, 3)


@pytest.mark.parametrize("name", ["chip_id", "filter"])
def test_close_refuses_a_session_of_another_chip_or_filter_and_names_it(sessions, tmp_path, name):
    first, second = simulate(8).sessions[:2]
    logs = [sessions(first), sessions(second, **{name: 5})]
    with pytest.raises(CannotClose, match=f"{logs[1].stem}: its {name} is 5, but"):
        close(logs, tmp_path)
    assert not list(tmp_path.iterdir())
