"""Several files of one device in one scale, and one file that holds several recordings."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy.io import savemat
from zerorate_bench.foreign_imports import BY_ITS_WORDS, REFUSED, RIGHT, judged
from zerorate_bench.foreign_logs import CORPUS
from zerorate_bench.public_data import recordings, told_of
from zerorate_tools.cli import main
from zerorate_tools.errors import BadRecording, InFile
from zerorate_tools.importers import (
    Options,
    cut,
    import_recording,
    import_together,
    read_foreign,
)
from zerorate_tools.importers.logs import apart
from zerorate_tools.recordings import (
    Scales,
    read_recording,
    recording_from_columns,
    write_recording,
)
from zerorate_tools.recordings.checks import GAP

from host_tests.hostile.many_logs import in_this_process

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


def of_sensor(path, sensor, at_s, level=0.0):
    """A CSV of one sensor, as phones write; the last axis is about a level."""
    rows = np.column_stack([at_s, *(np.sin(at_s * k) for k in (1, 2, 3))])
    rows[:, -1] += level
    head = ["time_s", *(f"{sensor}_{axis}" for axis in "xyz")]
    pd.DataFrame(rows).to_csv(path, index=False, header=head)
    return path


@pytest.fixture
def sensors(tmp_path):
    """Files of a gyroscope and of an accelerometer that is read a little later."""
    at_s = np.arange(500) / 100
    gyro = of_sensor(tmp_path / "gyro.csv", "gyro", at_s)
    return [gyro, of_sensor(tmp_path / "my acc.csv", "acc", at_s + 0.003, level=9.81)]


def test_files_of_sensors_become_one_recording_where_one_is_to_be_written(tmp_path, sensors):
    out = tmp_path / "run.parquet"
    how = ["--gyro-unit", "dps", "--accel-unit", "m/s2"]
    assert main(["import", *map(str, sensors), *how, "--out", str(out)]) == 0
    one = read_recording(out)
    assert len(one) == 500 and {"gx", "ax"} <= set(one.columns)
    gx_dps = one.columns["gx"] / one.scales.gyro_lsb_per_dps
    assert np.allclose(gx_dps, np.sin(np.arange(500) / 100), atol=0.01)


def test_a_file_of_rates_says_how_the_acceleration_beside_it_is_taken(tmp_path, sensors, capsys):
    names = ("Gyro.csv", "my Accel.csv")
    gyro, _ = [sensor.rename(tmp_path / name) for sensor, name in zip(sensors, names)]
    assert main(["import", str(gyro), "--gyro-unit", "dps", "-o", str(tmp_path / "o.csv")]) == 0
    said = capsys.readouterr().out
    assert f"zerorate import {gyro} '{tmp_path / 'my Accel.csv'}' --out FILE.parquet" in said


def test_files_of_sensors_without_rates_are_refused(tmp_path, sensors):
    (tmp_path / "other").mkdir()
    other = of_sensor(tmp_path / "other" / "acc.csv", "acc", np.arange(500) / 100)
    with pytest.raises(BadRecording, match="no table with rates in it, nor in the others"):
        import_recording([other, sensors[1]], tmp_path / "o.csv")
    same = of_sensor(tmp_path / "other" / "gyro.csv", "gyro", np.arange(500) / 100)
    with pytest.raises(BadRecording, match="two files of that name"):
        import_recording([sensors[0], same], tmp_path / "o.csv")


def test_tables_without_names_or_times_say_what_they_lack(tmp_path, sensors):
    for sensor in sensors:
        sensor.write_text(sensor.read_text().partition("\n")[2])
    bare = sensors[0].rename(tmp_path / "run.csv")
    with pytest.raises(BadRecording, match="run.csv: its columns have no names; write a line"):
        import_recording([bare, sensors[1]], tmp_path / "o.csv")
    bare.rename(sensors[0])
    sensors[0].write_text("n,gx_dps,gy_dps,gz_dps\n" + sensors[0].read_text())
    with pytest.raises(BadRecording, match="no time stamps; give --map t_us=n:s"):
        import_recording(tmp_path, tmp_path / "o.csv")


@pytest.mark.parametrize("ending", ["csv", "mat"])
def test_sensors_without_names_are_told_by_those_of_their_files(tmp_path, ending):
    at_s = np.arange(33_000) / 100
    levels = {"my gyro": (0.8, 0.5, 0.3), "acc": (0.0, 0.0, 1.0), "temp": (25.0,)}
    for name, of in levels.items():
        rows = np.random.default_rng(4).normal((0.0, *of), 0.01, (len(at_s), len(of) + 1))
        rows[:, 0] = at_s
        if ending == "mat":
            savemat(tmp_path / f"{name}.mat", {"rows": rows})
        else:
            np.savetxt(tmp_path / f"{name}.csv", rows, "%.4f", ",")
    recording, report = read_foreign(tmp_path, units={"gyro": "dps"})
    assert len(recording) == 33_000 and "interpolated" not in " ".join(report.lines())
    means = *recording.gyro_dps().mean(axis=0), *recording.accel_g().mean(axis=0)
    assert means == pytest.approx([0.8, 0.5, 0.3, 0, 0, 1], abs=0.01)
    assert recording.temp_degc().mean() == pytest.approx(25, abs=0.1)


def test_whole_recordings_are_not_put_into_one(tmp_path):
    sources = [table(tmp_path / "a.csv", 100.0), table(tmp_path / "b.csv", 400.0)]
    with pytest.raises(BadRecording, match=r"several recordings \(a, b\).*--out FOLDER"):
        import_recording(sources, tmp_path / "o.csv")
    assert not (tmp_path / "o.csv").exists()


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
    columns = {name: np.arange(140_000) % 9000 for name in ("gx", "gy", "gz")}
    columns["t_us"] = np.arange(140_000) * 10_000
    whole = recording_from_columns(columns, Scales("X", 100, 77))
    write_recording(whole, tmp_path / "in.parquet")
    at = [200, 401, 66_000, 131_073]
    parts = [read_recording(part) for part in cut(tmp_path / "in.parquet", at, tmp_path / "parts")]
    assert [len(part) for part in parts] == [199, 201, 65_599, 65_073, 8928]
    joined = np.concatenate([part.columns["t_us"] for part in parts])
    assert (joined == columns["t_us"]).all()
    assert parts[1].scales.to_json() == whole.scales.to_json()


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


def test_files_of_sensors_that_share_no_time_are_refused(tmp_path, sensors):
    sensors[1].write_text(sensors[1].read_text().replace("time_s", "elapsed"))
    with pytest.raises(BadRecording, match="the tables gyro, my acc share no time"):
        import_recording(sensors, tmp_path / "o.csv")


def test_files_without_times_are_put_together_row_by_row(tmp_path, sensors):
    how = {"options": Options(hz=100.0), "units": {"gyro": "dps", "accel": "m/s2"}}
    for file in sensors:
        lines = [line.split(",", 1)[1] for line in file.read_text().splitlines(keepends=True)]
        file.write_text("".join(lines))
    sensors[1].write_text("".join([*lines[:200], "torn\n", *lines[201:]]))
    report = import_recording(sensors, tmp_path / "o.csv", **how)
    assert sum(report.dropped.values()) == 1
    accel_g = read_recording(tmp_path / "o.csv").accel_g()
    at_s = np.arange(500) / 100 + 0.003
    assert len(accel_g) == 500
    np.testing.assert_allclose(accel_g[:, 0], np.sin(at_s) / 9.80665, atol=0.001)
    sensors[1].write_text("".join(lines[:-1]))
    with pytest.raises(BadRecording, match="do not begin and end together"):
        import_recording(sensors, tmp_path / "o.csv", **how)


_PAGE = Path(__file__).parents[2] / "docs" / "import-figures.md"


@pytest.fixture(scope="module")
def published():
    """The page's outcome of each log."""
    rows = [line.split(" | ") for line in _PAGE.read_text("utf-8").splitlines() if " | " in line]
    return {row[0].removeprefix("| "): row[1].removesuffix(" |") for row in rows}


@pytest.mark.parametrize("log", CORPUS, ids=lambda log: log.what)
def test_a_log_of_another_tool_is_right_or_refused_as_its_page_says(log, published, monkeypatch):
    # host_tests/hostile tries the child that reads it; to begin one takes longer than the rest here
    monkeypatch.setattr(apart, "table_apart", in_this_process)
    monkeypatch.setattr("resource.setrlimit", lambda *limits: None)
    row = judged(replace(log, samples=log.samples // 2))
    if row["outcome"] != published[log.what]:  # it lasts seconds, what the log is about
        row = judged(log)
    assert row["outcome"] in (RIGHT, BY_ITS_WORDS, REFUSED), row["said"]
    assert row["outcome"] == published[log.what], row["said"]


def test_every_real_recording_is_imported(real_data, tmp_path):
    found = [*recordings(real_data), *real_data.glob("chamber-loop/*")]
    assert len(found) == 20
    for number, source in enumerate(found):
        out = tmp_path / f"{number}.parquet"
        report = import_recording(source, out, **told_of(source))
        assert report.rows_written > 0.89 * report.rows_read
        assert report.doubts == []
        assert len(read_recording(out, keep_gaps=True)) == report.rows_written


def test_the_real_mpu6050_comes_back_to_integers(real_data):
    for source in real_data.glob("mpu6050-unmoved/*.csv.gz"):
        frame = pd.read_csv(source)
        frame = frame[frame["temp_C"] != 0]
        recording, _ = read_foreign(source, **told_of(source))
        printed = frame[["gx_dps", "gy_dps", "gz_dps"]].to_numpy()
        assert np.abs(recording.gyro_lsb() - printed * 131).max() < 0.001
        untold, _ = read_foreign(source)
        assert untold.columns["temp"].tolist() == recording.columns["temp"].tolist()
        assert 90 < recording.scales.odr_hz < 110


def test_a_trial_of_broad_keeps_movement_and_the_attitude_that_cameras_saw(real_data):
    source = next(real_data.glob("broad/02*.mat"))
    recording, _ = read_foreign(source, **told_of(source))
    assert set(recording.columns["moving"]) == {0, 1}
    optical = np.stack([recording.columns[f"opt_q{n}"] for n in "wxyz"], axis=1)
    seen = (optical != GAP).all(axis=1)
    assert seen.mean() > 0.8
    assert np.linalg.norm(optical[seen] * 2.0**-29, axis=1) == pytest.approx(1, abs=1e-6)
    assert recording.scales.more["channels"]["opt_qw"]["role"] == "reference"


def test_what_cannot_be_true_of_the_chamber_is_doubted_in_words(real_data):
    source = next(real_data.glob("chamber-loop/*"))
    units = {"gyro": "rad/s", "time": "ns"}
    _, report = read_foreign(source, units=units)
    assert len(report.doubts) == 1
    assert "89.7 degC within 4.24 s cannot be" in report.doubts[0]
    assert "give --hz" in report.doubts[0]
