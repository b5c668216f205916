"""Replaying recordings: every engine gives the same bits, and bad input leaves nothing behind."""

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from zerorate import Corrector, Sensor
from zerorate_tools.cli import main
from zerorate_tools.errors import InFile, ZerorateError
from zerorate_tools.layout import AXIS, STATE, axis_at
from zerorate_tools.model import Slot, build_model, write_model
from zerorate_tools.model.term import Term
from zerorate_tools.recordings import write_recording
from zerorate_tools.replay import replay
from zerorate_tools.simulate import simulate

DESCRIPTION = {
    "name": "short",
    "seed": 3,
    "sensor": {"odr_hz": 50.0, "gyro_noise_dps": 0.05},
    "bias": {"b0": [5.0, -2.0, 0.5], "b1": [0.05, -0.03, 0.02]},
    "session": [
        {
            "start_degc": 22.0,
            "temperature": [{"to": 30.0, "minutes": 3}],
            "motion": [{"kind": "rest", "s": 20}, {"kind": "hand", "s": 15, "dps": [60, 80]}],
        }
    ],
}


FIRST_AXIS = axis_at(Corrector(Sensor(50, 131, 16384)).settings, 0)


@pytest.fixture(scope="module")
def simulated():
    return simulate(DESCRIPTION)


@pytest.fixture(scope="module")
def log(simulated, tmp_path_factory):
    path = tmp_path_factory.mktemp("replay") / "short.parquet"
    write_recording(simulated[0], path)
    return path


@pytest.fixture(scope="module")
def reference(log):
    return replay(log, runtime="native")


@pytest.fixture(scope="module")
def minute(simulated):
    """Its first minute, two rests: what an interpreter plays soon."""
    return simulated[0].between(0, 3000)


def test_every_interpreter_gives_the_bits_that_machine_code_gives(runtime, minute):
    reference = replay(minute, runtime="native")
    done = replay(minute, runtime=runtime.name)
    assert done.state == reference.state
    assert done.table.equals(reference.table)


@pytest.mark.parametrize("engine", ["native", "cpython"])
def test_a_model_without_effects_changes_nothing(engine, log, reference, simulated, tmp_path):
    write_model(build_model([], simulated[0].scales), tmp_path)
    done = replay(log, runtime=engine, model=tmp_path / "model.bin")
    assert done.table.equals(reference.table)


def test_the_bias_found_is_the_one_simulated(simulated, reference):
    recording, truth = simulated
    later = recording.columns["t_us"] > 100e6
    for i, axis in enumerate("xyz"):
        error = np.asarray(reference.table[f"bias_g{axis}"]) - truth.bias_lsb[:, i]
        # 20 mdps: half a degree is crossed between two rests
        assert np.sqrt(np.mean(error[later] ** 2)) < 0.020 * 131


def test_a_recording_cut_in_two_and_resumed_ends_in_the_same_state(simulated, reference, tmp_path):
    recording, _ = simulated
    half = len(recording.columns["t_us"]) // 2
    parts = [slice(None, half), slice(half, None)]
    first, second = (
        type(recording)({k: v[p] for k, v in recording.columns.items()}, recording.scales, "part")
        for p in parts
    )
    state = tmp_path / "state.bin"
    replay(first, state=state)
    assert replay(second, from_state=state, resume=True).state == reference.state


def test_a_state_is_not_written_over_the_scales_of_the_log(simulated, tmp_path):
    write_recording(simulated[0], tmp_path / "run.csv")
    scales = (tmp_path / "run.json").read_bytes()
    with pytest.raises(InFile, match="run.json: would be written over"):
        replay(tmp_path / "run.csv", state=tmp_path / "run.json")
    assert (tmp_path / "run.json").read_bytes() == scales


def test_a_new_power_on_knows_its_bias_from_the_first_sample(log, reference, tmp_path):
    state = tmp_path / "state.bin"
    state.write_bytes(reference.state)
    assert replay(log).sources["none"] > 0
    assert "none" not in replay(log, from_state=state).sources


def test_the_command_writes_the_columns_of_the_design(log, tmp_path, capsys):
    out = tmp_path / "out.parquet"
    assert main(["replay", str(log), "--out", str(out)]) == 0
    table = pq.read_table(out)
    wanted = {"t_us", "bias_gx", "bias_gy", "bias_gz", "source", "quality_lsb"}
    assert wanted <= set(table.column_names)
    assert table.num_rows == pq.read_metadata(log).num_rows
    assert "source of the bias" in capsys.readouterr().out


@pytest.fixture
def with_supply(log, tmp_path):
    """A function that writes the log with a channel vdd_mv, a list in which None is a gap."""

    def write(name, values):
        channel = pa.array(values, pa.int32())
        pq.write_table(pq.read_table(log).append_column("vdd_mv", channel), tmp_path / name)
        return tmp_path / name

    return write


def test_gaps_in_a_channel_that_nobody_follows_change_nothing(with_supply, reference):
    samples = reference.samples
    assert replay(with_supply("gaps.parquet", [None] * samples)).state == reference.state


@pytest.mark.parametrize("engine", ["native", "cpython"])
def test_a_model_goes_on_with_a_channels_last_value_in_its_gaps(
    simulated, with_supply, reference, tmp_path, engine
):
    slot = Slot(Term("vdd_mv", 4900.0, 5100.0, 5000.0), (1e-3, 2e-3, -1e-3))
    write_model(build_model([slot], simulated[0].scales), tmp_path)
    held = [4950 + i // 500 for i in range(reference.samples)]
    gaps = [value if i % 500 == 0 else None for i, value in enumerate(held)]
    logs = with_supply("held.parquet", held), with_supply("gaps.parquet", gaps)
    whole, with_gaps = (replay(each, model=tmp_path / "model.bin", runtime=engine) for each in logs)
    assert with_gaps.table.equals(whole.table) and with_gaps.state != reference.state


def test_a_state_of_another_shape_is_refused_by_name(log, tmp_path):
    state = tmp_path / "state.bin"
    state.write_bytes(b"\0" * 100)
    with pytest.raises(InFile, match="state.bin: 100 bytes"):
        replay(log, from_state=state)


def as_words(state):
    return np.frombuffer(state, "<i4").copy()


def with_word(state, at, word):
    words = as_words(state)
    words[at] = word
    return words


@pytest.mark.parametrize(
    "damage",
    [
        lambda state: 0 * as_words(state),
        lambda state: ~(0 * as_words(state)),
        lambda state: np.roll(as_words(state), 1),
        lambda state: with_word(state, -1, 2**30),
        lambda state: with_word(state, STATE.WORK, 13),
        lambda state: with_word(state, STATE.SOURCE, 9),
        lambda state: with_word(state, FIRST_AXIS + AXIS.ORDER, 5000),
        lambda state: with_word(state, FIRST_AXIS + AXIS.CURRENT, 5000),
        lambda state: with_word(state, FIRST_AXIS + AXIS.LINE_SHIFT, -1),
    ],
)
def test_a_damaged_state_is_refused_and_no_kernel_goes_where_it_says(
    log, reference, damage, tmp_path
):
    state = tmp_path / "state.bin"
    state.write_bytes(damage(reference.state).astype("<i4").tobytes())
    with pytest.raises(InFile, match="state.bin: damaged, or no state at all; name a file"):
        replay(log, from_state=state)


def test_an_unknown_setting_is_refused_and_those_there_are_are_named(log):
    with pytest.raises(ZerorateError, match="no such setting: colour; .*bins, .*step_degc, "):
        replay(log, options={"colour": 1})


def test_a_broken_recording_leaves_no_output(tmp_path, capsys):
    bad = tmp_path / "bad.parquet"
    bad.write_bytes(b"PAR1 not really")
    out = tmp_path / "out.parquet"
    assert main(["replay", str(bad), "--out", str(out)]) == 2
    assert list(tmp_path.iterdir()) == [bad]
    assert capsys.readouterr().err.count("\n") == 1
