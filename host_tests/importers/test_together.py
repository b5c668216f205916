"""Several files of one device in one scale, and one file that holds several recordings."""

import numpy as np
import pandas as pd
import pytest
from zerorate_tools.cli import main
from zerorate_tools.errors import BadRecording, InFile
from zerorate_tools.importers import cut, import_together
from zerorate_tools.recordings import read_recording

NAMES = ["t_s", "gx_dps", "gy_dps", "gz_dps", "temp_c"]


def table(path, fastest_dps, n=500):
    """A CSV in which the fastest rate is so many deg/s."""
    rates = 0.3 * np.sin(np.arange(3 * n).reshape(n, 3))
    rates[n // 2, 0] = fastest_dps
    frame = pd.DataFrame(np.column_stack([np.arange(n) / 100, rates, np.full(n, 25.0)]))
    frame.to_csv(path, index=False, header=NAMES)
    return path


def test_logs_of_one_device_imported_together_get_one_scale(tmp_path):
    sources = [table(tmp_path / "a.csv", 100.0), table(tmp_path / "b.csv", 400.0)]
    reports = import_together(sources, tmp_path / "out")
    scales = [read_recording(path).scales.gyro_lsb_per_dps for path in reports]
    assert scales == [65.5, 65.5]
    assert [path.name for path in reports] == ["a.parquet", "b.parquet"]


def test_none_is_written_where_one_cannot_be_read(tmp_path):
    (tmp_path / "b.csv").write_text("a,b\n1,2\n")
    with pytest.raises(BadRecording):
        import_together([table(tmp_path / "a.csv", 1.0), tmp_path / "b.csv"], tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_two_files_of_one_name_are_not_written_over_each_other(tmp_path):
    (tmp_path / "other").mkdir()
    sources = [table(tmp_path / "a.csv", 1.0), table(tmp_path / "other" / "a.csv", 1.0)]
    with pytest.raises(InFile, match="would be written twice"):
        import_together(sources, tmp_path / "out")


def test_a_table_is_cut_into_tables_with_the_names_of_the_first(tmp_path, capsys):
    source = table(tmp_path / "in.csv", 1.0)
    again = source.read_text().partition("\n")[2]
    source.write_text("# a note\n" + source.read_text() + again)
    assert main(["import", str(source), "--out", str(tmp_path / "out.parquet")]) == 2
    command = capsys.readouterr().err.partition("zerorate cut ")[2].split()
    command[-1] = str(tmp_path / "parts")
    assert main(["cut", *command]) == 0
    parts = sorted((tmp_path / "parts").iterdir())
    assert [part.read_text().count("\n") for part in parts] == [502, 502]
    assert main(["import", *map(str, parts), "--out", str(tmp_path / "out")]) == 0
    assert len(read_recording(tmp_path / "out" / "in-2.parquet")) == 500


def test_a_recording_is_cut_with_nothing_lost(tmp_path):
    [whole] = import_together([table(tmp_path / "in.csv", 1.0)], tmp_path / "out")
    parts = [read_recording(part) for part in cut(whole, [200, 401], tmp_path / "parts")]
    assert [len(part) for part in parts] == [199, 201, 100]
    joined = np.concatenate([part.columns["gx"] for part in parts])
    assert joined.tolist() == read_recording(whole).columns["gx"].tolist()
    assert parts[1].scales.to_json() == read_recording(whole).scales.to_json()


@pytest.mark.parametrize("rows", [[501], [9000]])
def test_a_row_that_is_not_there_is_no_place_to_cut(tmp_path, rows):
    source = table(tmp_path / "in.csv", 1.0)
    with pytest.raises(BadRecording, match="it has no row"):
        cut(source, rows, tmp_path / "parts")
    assert not (tmp_path / "parts").exists()


def test_files_of_two_recordings_in_a_folder_are_not_mixed(tmp_path):
    table(tmp_path / "Gyroscope.csv", 1.0)
    still = pd.DataFrame({"t_s": np.arange(5000) / 100, "ax_g": 0.0, "ay_g": 0.0, "az_g": 1.0})
    still.to_csv(tmp_path / "Accelerometer.csv", index=False)
    with pytest.raises(BadRecording, match="do not begin and end together"):
        import_together([tmp_path], tmp_path / "out")
    still[:500].to_csv(tmp_path / "Accelerometer.csv", index=False)
    [out] = import_together([tmp_path], tmp_path / "out")
    assert read_recording(out).accel_g()[:, 2].mean() == pytest.approx(1.0)
