"""The notebook page runs from its first cell to its last, and shows what it says."""

import contextlib
import io
import os

import numpy as np
import pytest
import zerorate_tools as zt
from zerorate_tools.recordings import Recording, Scales

from host_tests.docs.outputs import blocks


@pytest.fixture(scope="module")
def ran(repository, tmp_path_factory):
    """(what each cell printed, the names that the cells left, their folder)."""
    folder = tmp_path_factory.mktemp("notebook")
    names, printed = {}, []
    with inside(folder):
        for cell in blocks(repository / "docs" / "notebook.md", "python"):
            out = io.StringIO()
            with contextlib.redirect_stdout(out):
                exec(cell.text, names)
            printed.append(out.getvalue())
    return printed, names, folder


@contextlib.contextmanager
def inside(folder):
    """contextlib.chdir, which Python 3.10 lacks."""
    before = os.getcwd()
    os.chdir(folder)
    try:
        yield
    finally:
        os.chdir(before)


def test_what_was_hidden_is_found(ran):
    printed, names, _ = ran
    assert names["found"]["effects"][0]["effect"] == "thermal-hysteresis"
    assert sum(names["found"]["after_mdps"]) < sum(names["found"]["before_mdps"])
    assert names["better"].samples == len(zt.read_recording(ran[2] / "run-4.parquet"))


def test_the_plot_is_a_page_with_three_axes_and_the_temperature(ran):
    _, names, folder = ran
    assert {"gx", "gy", "gz", "temperature"} <= {trace.name for trace in names["figure"].data}
    assert "plotly" in (folder / "bias.html").read_text(encoding="utf-8")


def test_an_error_is_a_line_with_the_file(ran):
    assert "no-such.parquet" in ran[0][-1]
    assert len(ran[0][-1].splitlines()) == 1


def test_physical_columns_are_the_raw_ones_in_units(ran):
    recording, frame = ran[1]["recording"], ran[1]["frame"]
    raw = recording.to_frame()
    assert frame["gx_dps"].to_numpy() * 131.0 == pytest.approx(raw["gx"].to_numpy())
    assert frame.index.name == "t_s" and frame.index[0] == 0
    assert "vdd_mv" in frame


def test_a_name_from_a_stranger_is_text_in_the_plot(ran):
    recording, replayed = ran[1]["recording"], ran[1]["replayed"]
    odd = Recording(recording.columns, recording.scales, "<script>alert(1)</script>")
    assert "<script>" not in zt.plot_replay(odd, replayed).layout.title.text


def test_a_recording_without_temperature_has_a_plot_of_one_panel():
    columns = {name: np.arange(500, dtype=np.int32) % 3 for name in ("gx", "gy", "gz")}
    columns["t_us"] = np.arange(500, dtype=np.int64) * 10_000
    recording = Recording(columns, Scales("X", 100.0, 131.0), "bare")
    figure = zt.plot_replay(recording, zt.replay_recording(recording, runtime="cpython"))
    assert "temperature" not in {trace.name for trace in figure.data}


def test_a_replay_that_went_to_a_file_says_where_its_table_is(ran, tmp_path):
    done = zt.replay_recording(ran[2] / "run-1.parquet", tmp_path / "out.parquet")
    with pytest.raises(ValueError, match="read_parquet"):
        done.to_frame()
