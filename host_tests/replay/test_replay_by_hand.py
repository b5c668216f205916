"""A replay in this process: what a MicroPython is given and gives back, drawings, kept states."""

from contextlib import nullcontext
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from zerorate.model import EffectModel
from zerorate_tools.errors import InFile, ZerorateError
from zerorate_tools.layout import EFFECTS, MOTION, MOTION_SETTINGS
from zerorate_tools.model import Slot, build_model, encoded, write_model
from zerorate_tools.model.files import sensor_for
from zerorate_tools.model.term import Term
from zerorate_tools.recordings import Scales, recording_from_columns
from zerorate_tools.recordings.checks import GAP
from zerorate_tools.replay import replay
from zerorate_tools.replay.engines import (
    CPythonEngine,
    InterpreterEngine,
    NativeEngine,
    Outcome,
    staged_packages,
)
from zerorate_tools.replay.plot import plot
from zerorate_tools.replay.replaying import (
    SOURCES,
    _count,
    can_be_a_state,
    corrector_for,
    load_model,
    state_bytes,
    table,
)
from zerorate_tools.replay.samples import frames_in_batches
from zerorate_tools.replay.state_in_words import words_of_file
from zerorate_tools.simulate import simulate

DEVICE = {
    "sensor": {"odr_hz": 25.0},
    "bias": {"b0": [1.5, -2.0, 0.5], "b1": 0.02},
    "every_session": {
        "temperature": [{"to": 30.0, "s": 40}],
        "motion": [{"kind": "rest", "s": 15}, {"kind": "hand", "s": 5}],
    },
    "channels": {
        name: {"kind": "levels", "low": 10, "high": 250, "mean_s": s}
        for name, s in (("load", 6), ("fan", 4))
    },
}
SLOTS = [
    Slot(Term("load", 0, 250, 100), (0.001, -0.002, 0.0)),
    Slot(Term("fan", 0, 250, 100), (-0.002, 0.001, 0.001)),
    Slot(Term("temp", 20, 45, 30, lag_mode="lag", lag_s=20), (0.01, 0.0, 0.02)),
]


@pytest.fixture(scope="module")
def recording():
    """With gaps in a channel, and time that leaps further than a step can tell, and back."""
    made = simulate(DEVICE)[0]
    made.columns["load"][100:130] = GAP
    made.columns["t_us"][500:] += 1 << 30
    made.columns["t_us"][700:] -= 1 << 31
    return made


def test_frames_hold_the_steps_of_time_in_bounds_and_no_more_than_is_there(recording):
    columns = {name: recording.columns[name] for name in ("t_us", "gy", "load")}
    (frames,) = frames_in_batches(replace(recording, columns=columns), 1000, ["load"])
    steps = np.full(1000, 40_000)
    steps[[500, 700]] = 1 << 29, -1 << 29
    assert frames.dt_us.tolist() == steps.tolist()
    assert (frames.frames[:, 5] == columns["gy"]).all() and not frames.frames[:, [0, 4, 6]].any()
    assert frames.extra[:, 0].tolist() == columns["load"].tolist()


@pytest.fixture
def model(recording, tmp_path):
    write_model(build_model(SLOTS, recording.scales), tmp_path)
    return tmp_path / "model.bin"


def played(engine, recording, model, rows=300, options=None):
    corrector = corrector_for(recording, options or {})
    channels = load_model(corrector, model, recording) if model else ()
    outcomes = list(engine.run(corrector, frames_in_batches(recording, rows, channels)))
    names = ("t_us", "frames", "bias_q8", "source", "quality_q8", "verdict")
    whole = {n: np.concatenate([getattr(o, n) for o in outcomes]) for n in names}
    return whole, state_bytes(corrector), [len(o.t_us) for o in outcomes]


@pytest.mark.parametrize("options", [{}, {"motion": False}, {"gravity": False}])
def test_through_files_or_compiled_the_firmware_gives_the_same(
    recording, model, options, find_runtime
):
    how = recording, None if options else model, 300, options
    ours, own_state, sizes = played(CPythonEngine(), *how)
    assert sizes == [300, 300, 300, 100]
    assert len(set(ours["source"].ravel())) > 1 and ours["quality_q8"].any()
    for engine in (InterpreterEngine(find_runtime("x86")), NativeEngine()):
        theirs, state, their_sizes = played(engine, *how)
        assert state == own_state and their_sizes == sizes
        for name, values in ours.items():
            assert np.array_equal(theirs[name], values), name


def test_samples_that_an_interpreter_lost_are_said(recording):
    def run(script, arguments, **how):
        return SimpleNamespace(files=dict.fromkeys(how["files_out"], b""), stdout="")

    with pytest.raises(ZerorateError, match="here lost samples"):
        played(InterpreterEngine(SimpleNamespace(name="here", run=run)), recording, None)


def test_a_package_that_is_not_there_is_named(tmp_path):
    with pytest.raises(ZerorateError, match="the package nowhere is not installed"):
        staged_packages(tmp_path, ("nowhere",))


def test_a_drawing_has_at_most_some_thousand_points_in_dps_over_minutes(recording):
    long = {name: np.tile(column, 5) for name, column in recording.columns.items()}
    long["t_us"] = np.arange(5000, dtype=np.int64) * 40_000 + 7_000_000
    whole = recording_from_columns(long, recording.scales, "<b>run")
    found = replay(whole, options={"motion": False, "gravity": False})
    figure = plot(whole, found)
    frame, lines = found.to_frame().iloc[::2], {t.name: t for t in figure.data if t.name}
    known = frame["source"] != "none"
    assert lines["gx"].x.tolist() == pytest.approx((np.arange(2500) * 0.08 / 60).tolist())
    bias = np.where(known, frame["bias_gy"] / 131.0, np.nan)
    assert lines["gy"].y == pytest.approx(bias, nan_ok=True)
    upper, lower = (t for t in figure.data[:2])
    sigma = 2 * frame["quality_gx"].to_numpy() / 131.0
    assert upper.y - lower.y == pytest.approx(np.where(known, 2 * sigma, np.nan), nan_ok=True)
    assert lines["temperature"].y == pytest.approx(whole.temp_degc()[::2])
    assert figure.layout.title.text == "&lt;b>run"
    assert (figure.layout.yaxis.title.text, figure.layout.yaxis2.title.text) == (
        "bias, dps",
        "degC",
    )
    assert figure.layout.xaxis2.title.text == "minutes" and figure.layout.xaxis.title.text is None


def test_absent_channels_have_no_scale():
    sensor = sensor_for(Scales("X", 10.0, 131.0))
    assert (sensor.accel_lsb_per_g, sensor.temp_lsb_per_degc, sensor.temp_offset_degc) == (0, 0, 0)


@pytest.mark.parametrize("resume", [False, True])
@pytest.mark.parametrize("slots", [[], SLOTS])
def test_a_kept_state_is_of_the_same_model_or_refused(recording, tmp_path, slots, resume):
    short, state, model = recording.between(0, 99), tmp_path / "state.bin", tmp_path / "model.bin"
    model.write_bytes(encoded(build_model(slots, recording.scales)))
    replay(short, model=model, state=state)
    kept = np.frombuffer(state.read_bytes(), "<i4")
    first = len(kept) - len(EffectModel().e)
    last = max(0, len(slots) - 1)
    given_words = EFFECTS.TICK_US, EFFECTS.INPUTS, EFFECTS.SLOTS, EFFECTS.TABLES
    for word, more, is_taken in (
        (EFFECTS.NEXT_SLOT, last, True),
        (EFFECTS.NEXT_SLOT, last + 1, False),
        (EFFECTS.NEXT_SLOT, -1, False),
        *((given, more, False) for given in given_words for more in (-1, 1)),
    ):
        changed = kept.copy()
        changed[first + word] = more + (word != EFFECTS.NEXT_SLOT) * kept[first + word]
        state.write_bytes(changed.tobytes())
        with nullcontext() if is_taken else pytest.raises(InFile, match="another effect model"):
            replay(short, model=model, from_state=state, resume=resume)


def test_a_state_has_as_many_nodes_filled_as_there_are_at_most(recording):
    corrector = corrector_for(recording, {})
    nodes = corrector.motion_settings[MOTION_SETTINGS.NODES]
    for filled in (0, nodes - 1, nodes, nodes + 1):
        corrector.motion[MOTION.FILLED] = filled
        assert can_be_a_state(corrector) == (filled <= nodes)


def test_the_least_trusted_axis_counts():
    source = np.array([[1, 2, 3], [3, 1, 2], [2, 3, 1]], np.int8)
    q8 = 256 * source.astype(np.int32)
    rows = table(Outcome(np.arange(3), None, q8, source, q8, source[0])).to_pydict()
    assert rows["source"] == [SOURCES[1]] * 3 and rows["quality_lsb"] == [3, 3, 3]
    assert rows["quality_gy"] == rows["bias_gy"] == [2, 1, 3]


def test_a_state_whose_last_word_is_cut_has_the_words_before(tmp_path):
    state = bytes(corrector_for(recording_from_columns({}, Scales("a", 100.0, 131.0)), {}).state)
    (tmp_path / "s.bin").write_bytes(state + b"\1\2")
    assert len(words_of_file(tmp_path / "s.bin")) == len(state) // 4


@pytest.mark.parametrize("name", ["o.csv", "o.txt", "o"])
def test_a_replay_is_written_as_parquet_alone(recording, name):
    with pytest.raises(InFile, match="end the name in .parquet"):
        replay(recording, name)


def test_times_go_on_over_batches_and_verdicts_are_counted_over_them(recording):
    steps = np.concatenate([f.dt_us for f in frames_in_batches(recording, 300)])
    (whole,) = frames_in_batches(recording, 1000)
    assert (steps == whole.dt_us).all()
    counts = {}
    for codes in (np.array([1, 1, 1, 0]), np.array([1, 3])):
        _count(counts, ("a", "b", "c", "d"), codes)
    assert counts == {"a": 1, "b": 4, "d": 1}
