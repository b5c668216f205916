"""Before and after are what the firmware's own kernels give."""

import numpy as np
import pyarrow.parquet as pq
import pytest
from zerorate_bench.loop.simulated import simulate
from zerorate_tools.closing import close, load
from zerorate_tools.loop.search.catalogue import Candidate
from zerorate_tools.loop.search.selection import Found, Selection
from zerorate_tools.loop.verify.firmware import Firmware, Refused
from zerorate_tools.loop.verify.measure import _measured, _without_harmful
from zerorate_tools.loop.verify.measured import Course, Measured
from zerorate_tools.model import read_model
from zerorate_tools.model.term import Term
from zerorate_tools.recordings import Scales, open_recording
from zerorate_tools.replay import replay
from zerorate_tools.replay.engines import CPythonEngine
from zerorate_tools.replay.samples import frames_in_batches

from .power_ons import SCALES, recording


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


def test_the_frozen_firmware_is_the_same_on_cpython(logs):
    frames = next(iter(frames_in_batches(recording(simulate(7).sessions[0]), 1200)))
    compiled, plain = Firmware(SCALES, None), Firmware(SCALES, None)
    plain._engine = CPythonEngine()
    for learn in (True, False):
        assert (compiled.run(frames, learn) == plain.run(frames, learn)).all()


def test_a_frozen_firmware_learns_nothing(logs):
    first, second = (next(iter(frames_in_batches(recording(s)))) for s in simulate(7).sessions[:2])
    firmware = Firmware(SCALES, None)
    firmware.run(first)
    twice = firmware.copy()
    for device, runs in ((firmware, 1), (twice, 2)):
        for _ in range(runs):
            device.power_on()
            device.set_offset((0, 0, 0))
            bias = device.run(second, learn=False)
        device.bias = bias
    assert (firmware.bias == twice.bias).all()
    assert np.ptp(bias, axis=0).min() > 0


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


def test_the_integers_are_below_a_tenth_of_the_floor_from_the_numbers(closed):
    result, _ = closed
    assert 0 < result["integer_rounding_of_floor"] < 0.1


def test_learning_online_is_better_than_frozen(closed):
    result, _ = closed
    for way in ("before_mdps", "after_mdps"):
        assert np.linalg.norm(result["online"][way]) < np.linalg.norm(result[way])


def test_every_effect_is_judged_by_the_model_with_it_alone(closed):
    result, _ = closed
    steps = result["effects"]
    assert steps[0]["before_mdps"] == result["before_mdps"]
    assert steps[-1]["after_mdps"] == result["after_mdps"]
    for one, following in zip(steps, steps[1:]):
        assert one["after_mdps"] == following["before_mdps"]


def test_scales_that_the_firmware_cannot_run_at_are_refused():
    with pytest.raises(Refused, match="gyro_lsb_per_dps must be 1..8000"):
        Firmware(Scales("odd", 1.0, 13100.0), None)


def test_the_model_carries_the_effect(closed):
    _, folder = closed
    assert [s.effect for s in read_model(folder / "model.bin").slots][:1] == ["thermal-hysteresis"]


def test_of_three_recordings_every_row_is_left_out_once(logs, tmp_path):
    result = close(logs[:3], tmp_path)
    assert [e["effect"] for e in result["effects"]] == ["thermal-hysteresis"]
    split = result["split"]
    assert split["pieces_of"] == split["train"] == ["session-1", "session-2"]
    rows = pq.read_table(tmp_path / "corrected.parquet").to_pandas()
    assert set(rows["split"]) == {"test"}
    before, after = (np.array(split[f"pieces_{way}_mdps"]) for way in ("before", "after"))
    assert (after <= before).all() and after.max() < 0.5 * before.max()


def test_what_pieces_of_few_recordings_speak_against_is_withdrawn():
    rate = Found(Candidate("thermal-rate", (Term("temp"),), "catalogue"), None)
    selection = Selection([rate], [], [], 0, None, (), (), [], {})
    ways = {"before": np.ones((4, 3)), "after": np.full((4, 3), 0.9)}
    worse = ways | {"after": np.full((4, 3), [0.9, 1.1, 0.9])}
    courses = {"a": Course(np.arange(4), {}, worse), "b": Course(np.arange(4), {}, ways)}
    alone, both = (Measured(courses, ["b"], np.zeros(3), inside=some) for some in ([], ["a"]))
    assert _without_harmful(selection, alone, None) is selection
    assert _without_harmful(selection, both, None).found[0].axes == (True, False, True)


def test_what_a_trial_notes_is_not_said_of_what_is_deployed(monkeypatch, logs):
    analysis = load(logs[:1])
    before = list(analysis.gate.notes)

    def noting(trial, scales):
        trial.gate.notes.append("found but left out: of the trial")
        return trial

    monkeypatch.setattr("zerorate_tools.loop.verify.measure.deployable", noting)
    _measured(analysis, logs[:1], open_recording(logs[0]).scales, analysis.selection)
    assert analysis.gate.notes == before
