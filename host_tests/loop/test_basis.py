"""The float reference of effect slots."""

import json
import math
import struct
import zlib
from dataclasses import replace

import numpy as np
import pytest
from zerorate import Sensor, model
from zerorate.effects import model_file
from zerorate.effects.model_file import (
    LOADED,
    OTHER_CHIP,
    OTHER_FILTER,
    OTHER_RANGE,
    OTHER_SCALE,
    REASONS,
)
from zerorate.model import EffectModel
from zerorate_bench.loop.simulated import simulate
from zerorate_tools.closing import close
from zerorate_tools.loop.analyse import analyse
from zerorate_tools.loop.fit.line import by_axis, ordinary, with_line
from zerorate_tools.loop.fit.single import PiecesByLine
from zerorate_tools.loop.read.gate import CannotClose
from zerorate_tools.loop.verify.slots import deployable
from zerorate_tools.model import Binding, Slot, build_model, encoded, read_model
from zerorate_tools.model.binding import binding_of
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


@pytest.fixture
def analysis():
    device = simulate(13, [("thermal-hysteresis", 3.0), ("supply-voltage", 3.0)])
    return analyse(device.sessions)


def kinds(analysis):
    return [f.candidate.kind for f in analysis.selection.found]


def test_what_fits_stays_as_it_is(analysis):
    assert len(kinds(analysis)) == 2
    assert deployable(analysis, SCALES) is analysis


def test_an_effect_beyond_the_integers_is_left_out_and_said(analysis):
    [supply] = [f for f in analysis.selection.found if f.candidate.kind == "supply-voltage"]
    [term] = supply.candidate.terms
    supply.candidate = replace(supply.candidate, terms=(replace(term, lag_s=1e9, lag_mode="lag"),))
    left = deployable(analysis, SCALES)
    assert kinds(left) == ["thermal-hysteresis"]
    assert len(left.judgement.gains) == 1
    assert any(note.startswith("found but left out: ") for note in left.gate.notes)


LINE, SLOPE = Term("temp", centre=25.0), Term("temp", 10.0, 50.0, 25.0)
BEND, LAG = Term("temp", 10.0, 50.0, 25.0, 2), Term("temp", lag_s=300.0, lag_mode="difference")


@pytest.fixture(scope="module")
def session():
    return simulate(4, [("thermal-lag", 10.0)], sessions=1, bare=True).sessions[0]


def test_an_axis_without_an_effect_is_fitted_as_if_it_were_not_there(session):
    applied = np.array([[1.0, 1.0, 1.0], [1.0, 0.0, 1.0]])
    _, spared = PiecesByLine(session, hold=False).fitted_to(session, [LINE], [BEND, LAG], applied)
    alone, both = ordinary([LINE, BEND], [session]), ordinary([LINE, BEND, LAG], [session])
    assert np.allclose(spared[:2, 1], alone[:, 1])
    assert not np.allclose(spared[:2, 1], both[:2, 1])
    assert np.allclose(spared[:, [0, 2]], both[:, [0, 2]])
    assert spared[2, 1] == 0


def test_the_line_stands_back_on_the_axes_that_have_a_slope():
    applied = with_line([LINE], [SLOPE, BEND], np.array([[1.0, 0.0, 1.0], [1.0, 1.0, 1.0]]))
    assert applied[0].tolist() == [0.0, 1.0, 0.0]


def test_nothing_applied_is_nothing(session):
    assert not by_axis(lambda terms: ordinary(terms, [session]), [BEND], np.zeros((1, 3))).any()


MPU6050 = Scales("MPU-6050", 100.0, 131.0, 16384.0, 340.0, 36.53)
RECORDED = {"chip_id": 0x68, "gyro_range": 0, "accel_range": 0, "filter": 3}
SLOT = Slot(Term("temp", 20, 45, 30), (0.01, 0.01, 0.01), "temperature")

ON_A_BOARD = """
from zerorate import Sensor
from zerorate.model import EffectModel
from zerorate.effects.model_file import REASONS

for binding in ((104, 0, 0, 3), (112, 0, 0, 3), (104, 1, 0, 3), (104, 0, 0, 4)):
    print(REASONS[EffectModel().load_file("model.bin", Sensor(), bytes(binding))])
print(REASONS[EffectModel().load_file("model.bin", Sensor(gyro_lsb_per_dps=65.5))])
"""


def test_what_the_recorder_wrote_is_the_binding():
    assert binding_of(replace(MPU6050, more={"binding": RECORDED})) == Binding(0x68, 0, 0, 3)


def test_of_a_foreign_recording_the_name_and_the_scales_tell_what_they_can():
    assert binding_of(MPU6050) == Binding(0x68, 0, 0, None)
    assert binding_of(replace(MPU6050, gyro_lsb_per_dps=16.4)).gyro_range == 3
    assert binding_of(Scales("ADIS16405", 100.0, 20.0)) == Binding()


def test_a_board_refuses_other_chips_ranges_and_filters(micropython, tmp_path, repository):
    model = build_model([SLOT], MPU6050, binding=Binding(0x68, 0, 0, 3))
    script = tmp_path / "load.py"
    script.write_text(ON_A_BOARD)
    said = micropython.run(
        script,
        modules=[repository / "firmware"],
        files_in={"model.bin": encoded(model)},
        check=True,
    ).stdout.splitlines()
    reasons = (LOADED, OTHER_CHIP, OTHER_RANGE, OTHER_FILTER, OTHER_RANGE)
    assert said == [REASONS[r] for r in reasons]


@pytest.mark.parametrize(
    ("sensor", "reason"),
    [
        (Sensor(), LOADED),
        (Sensor(gyro_lsb_per_dps=65.5), OTHER_RANGE),
        (Sensor(accel_lsb_per_g=8192.0), OTHER_RANGE),
        (Sensor(temp_lsb_per_degc=326.8, temp_offset_degc=25.0), OTHER_SCALE),
    ],
)
def test_without_a_driver_the_scales_bind(sensor, reason):
    model = build_model([SLOT], MPU6050, binding=binding_of(MPU6050))
    assert EffectModel().load(encoded(model), sensor) == reason


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


def test_a_flipped_binding_is_caught_by_the_checksum():
    data = bytearray(encoded(build_model([SLOT], MPU6050, binding=Binding(0x68, 0, 0, 3))))
    data[12] = 0x70
    assert REASONS[EffectModel().load(bytes(data), Sensor())].startswith("the model is damaged")
    data[-4:] = struct.pack("<I", zlib.crc32(data[:-4]))
    assert EffectModel().load(bytes(data), Sensor(), bytes((0x68, 0, 0, 3))) == OTHER_CHIP


def test_a_model_and_its_reader_have_the_same_codes():
    codes = {name: getattr(model, name) for name in ("LOADED", "NO_MODEL", "UNREADABLE")}
    assert codes == {name: getattr(model_file, name) for name in codes}
    assert model._IMPOSSIBLE == model_file.IMPOSSIBLE
