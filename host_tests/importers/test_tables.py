"""Foreign recordings come out as integers in LSB, and every loss is told."""

from functools import reduce
from operator import xor

import numpy as np
import pandas as pd
import pytest
from zerorate_tools.errors import BadRecording
from zerorate_tools.importers import Options, import_recording, parsed_mapping, read_foreign
from zerorate_tools.importers.tables import checked_lines, delimited
from zerorate_tools.importers.tables.sniffing import _says_its_names
from zerorate_tools.recordings import (
    Scales,
    read_recording,
    recording_from_columns,
    write_recording,
)
from zerorate_tools.recordings.checks import GAP

from .test_odd_files import told

G = 9.80665


def table(path, **columns):
    """A CSV of these columns."""
    pd.DataFrame(columns).to_csv(path, index=False)
    return path


def test_a_mapping_with_units_gives_integers(tmp_path):
    n = np.arange(4.0)
    source = table(
        tmp_path / "in.csv", ms=n * 10, wx=n * 0.1, wy=n * 0, wz=-n, fx=n * 0, fy=n * 0,
        fz=n * 0 + G, die=n + 300.0, volts=n * 0 + 3.3,
    )  # fmt: skip
    words = (
        "t_us=ms:ms gx=wx:rad/s gy=wy:rad/s gz=wz:dps ax=fx:m/s2 ay=fy:m/s2 az=fz:m/s2 "
        "temp=die:k vdd_mv=volts:x1000"
    )
    recording, _ = read_foreign(
        source,
        mapping=[parsed_mapping(word) for word in words.split()],
        options=Options(sensor="MPU-6050", gyro_lsb_per_dps=131, accel_lsb_per_g=16384,
                        temp_lsb_per_degc=340, temp_offset_degc=36.53),
    )  # fmt: skip
    c = recording.columns
    assert c["t_us"].tolist() == [0, 10_000, 20_000, 30_000]
    assert c["gx"].tolist() == np.rint(np.degrees(n * 0.1) * 131).tolist()
    assert c["gz"].tolist() == [0, -131, -262, -393]
    assert c["az"].tolist() == [16384] * 4
    assert c["temp"].tolist() == np.rint((n + 26.85 - 36.53) * 340).tolist()
    assert c["vdd_mv"].tolist() == [3300] * 4
    assert recording.scales.sensor == "MPU-6050"
    assert recording.scales.odr_hz == pytest.approx(100)


def test_usual_names_and_units_in_names_need_no_mapping(tmp_path):
    source = table(tmp_path / "in.csv", **{"time [s]": [0, 1], "gyro_x [rad/s]": [0.1, 0.2],
                   "gyro_y [rad/s]": [0.1, 0.2], "gyro_z [rad/s]": [0.1, 0.2]})  # fmt: skip
    recording, report = read_foreign(source)
    assert recording.columns["gx"].tolist() == np.rint(np.degrees([0.1, 0.2]) * 131).tolist()
    assert told(report, "Stored at the +-250 dps scale (fastest rate: 11.46 dps)")
    assert told(report, "no temperature") and told(report, "no acceleration")


def test_raw_counts_stay_as_they_are_and_need_their_scale(tmp_path):
    source = table(tmp_path / "in.csv", gx=[7, -9], gy=[1, 1], gz=[0, 3])
    with pytest.raises(
        BadRecording, match="units of columns 'gx', 'gy', 'gz' are not.*--gyro-unit dps"
    ):
        read_foreign(source)
    with pytest.raises(BadRecording, match="unit of column 'gx' cannot be 'knots'"):
        read_foreign(source, units={"gyro": "knots"})
    with pytest.raises(BadRecording, match="scale of raw counts.*give --gyro-lsb-per-dps 131 "):
        read_foreign(source, units={"gyro": "lsb"}, options=Options(hz=100))
    scaled = Options(hz=100, gyro_lsb_per_dps=16.4)
    recording, _ = read_foreign(source, units={"gyro": "lsb"}, options=scaled)
    assert recording.columns["gx"].tolist() == [7, -9]
    assert recording.columns["t_us"].tolist() == [0, 10_000]


def test_rows_that_are_no_samples_are_dropped_and_counted(tmp_path):
    source = table(
        tmp_path / "in.csv",
        t_s=[0, 1, 2, 3, 2.5, 4, np.nan],
        gx_dps=[1, 0, 1, 1, 1, np.nan, 1],
        gy_dps=[1, 0, 1, 300, 1, 1, 1],
        gz_dps=[1, 0, 1, 1, 1, 1, 1],
        temp_c=[20, 0, 20, 20, 20, 20, 20],
    )
    recording, report = read_foreign(source, options=Options(gyro_lsb_per_dps=131))
    assert recording.columns["t_us"].tolist() == [0, 2_000_000, 2_500_000, 3_000_000]
    assert report.rows_read == 7 and report.rows_written == 4
    assert told(report, "dropped 1 rows: all readings are zero")
    assert told(report, "time goes back at 1 rows: sorted by time")
    assert told(report, "dropped 1 rows: a reading is no number")
    assert told(report, "dropped 1 rows: the time stamp is no number")
    assert told(report, "gy: 1 readings at the end of the 16-bit range (clipped)")


def test_three_zero_rates_alone_may_be_a_sample(tmp_path):
    source = table(tmp_path / "in.csv", t_s=[0, 1], gx_dps=[1, 0], gy_dps=[0, 0], gz_dps=[0, 0])
    assert len(read_foreign(source)[0]) == 2


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("", "empty file"),
        ("t_s,gx_dps,gy_dps,gz_dps\n", "no data row"),
        ("a,b\n1,2\n", "no column for gx, gy, gz; map it: --map gx=COLUMN"),
        ("gx_dps,gy_dps,gz_dps\n1,2,3\n", "no time stamps; give --hz"),
        ("t_s,gx_dps,gy_dps,gz_dps\n1,2,3,4\n", "time stands still"),
        ("t_s,gx_dps,gy_dps,gz_dps,temp_c\n1,0,0,0,0\n", "no sample is left; 1 rows: all readings"),
    ],
)
def test_a_table_that_cannot_be_imported_says_why(tmp_path, text, complaint):
    (tmp_path / "in.csv").write_text(text)
    with pytest.raises(BadRecording, match=complaint):
        import_recording(tmp_path / "in.csv", tmp_path / "out.parquet")
    assert not (tmp_path / "out.parquet").exists()


@pytest.mark.parametrize(
    ("words", "complaint"),
    [
        ("gx", "no mapping: write gx=COLUMN:UNIT"),
        ("gx=w:furlongs", "unit 'furlongs' of gx is none of dps"),
        ("load=w:dps", "an extra channel takes a factor: load=w:x100"),
        ("t=time:s", "t is none of t_us, gx, .*, temp, and"),
    ],
)
def test_a_mapping_that_is_none_says_how(words, complaint):
    with pytest.raises(ValueError, match=complaint):
        parsed_mapping(words)


def test_a_column_that_is_not_there_and_a_channel_too_large_are_named(tmp_path):
    source = table(tmp_path / "in.csv", t_s=[0, 1], gx_dps=[1, 1], gy_dps=[1, 1], gz_dps=[1, 1],
                   load=[1, 3e9])  # fmt: skip
    with pytest.raises(BadRecording, match="no column 'weight'; choose of t_s, gx_dps"):
        read_foreign(source, mapping=[parsed_mapping("load=weight")])
    with pytest.raises(
        BadRecording, match=r"row 2: load is 3e\+09, no integer of 32 bits; scale it down"
    ):
        read_foreign(source, mapping=[parsed_mapping("load=load")])


@pytest.mark.parametrize("name", ["out.parquet", "out.csv.gz"])
def test_gaps_of_a_channel_stay_gaps_however_often_it_is_imported(tmp_path, name):
    source = table(tmp_path / "in.csv", t_s=[0, 1], gx_dps=[1, 1], gy_dps=[1, 1], gz_dps=[1, 1],
                   load=[1, np.nan])  # fmt: skip
    import_recording(source, tmp_path / "first.csv", mapping=[parsed_mapping("load=load")])
    import_recording(tmp_path / "first.csv", tmp_path / name)
    assert read_recording(tmp_path / name, keep_gaps=True).columns["load"].tolist() == [1, GAP]
    with pytest.raises(BadRecording, match="row 2: load has no value"):
        read_recording(tmp_path / name)


@pytest.mark.parametrize("block", [60, 500, 1 << 20])
@pytest.mark.parametrize("checked", [False, True])
def test_a_line_that_is_no_row_keeps_its_place_in_blocks_of_any_size(
    tmp_path, monkeypatch, checked, block
):
    rows = [f"{number % 7 + 0.25},2,{number}" for number in range(60)]
    lost = [3, 4, 29, 59]
    for number in lost:
        rows[number] = rows[number].rpartition(",")[0]
    if checked:
        rows = [f"$IMU,{row}*{reduce(xor, f'IMU,{row}'.encode()):02X}" for row in rows]
    head = [] if checked else ["A note", "", "a,b,c"]
    (tmp_path / "in.csv").write_text("\n".join([*head, *rows, ""]))
    for reader in (checked_lines, delimited):
        monkeypatch.setattr(reader, "_BLOCK_BYTES", block)
    read = checked_lines.checked_lines if checked else delimited.delimited
    table = read(tmp_path / "in.csv")
    name = table.names[2]
    chunks = list(table.chunks([name]))
    places = np.concatenate([chunk.place for chunk in chunks])
    values = np.concatenate([chunk.columns[name] for chunk in chunks])
    whole = [number for number in range(60) if number not in lost]
    assert places.tolist() == values.tolist() == whole and sum(table.dropped.values()) == len(lost)


@pytest.mark.parametrize(
    ("line", "says"),
    [
        *(("Gyro X,3,Y,4,Z,5", True), ("Gyro X,1,Y,2,Z,3", False), ("7,3,Y,4,8,5", False)),
        *(("Gyro X,3,Y,4", False), (",3,,4,,5", False)),
    ],
)
def test_words_that_come_again_with_other_numbers_are_no_names(line, says):
    assert _says_its_names("Gyro X,1,Y,2,Z,3", [line], ",") is says


def test_letters_that_mark_the_ends_of_rows_are_no_words_around_numbers():
    assert not _says_its_names("S,ACCx,GYRx,E", ["S,0.1,0.2,E"], ",")


def test_of_two_accelerations_that_of_the_mapped_rates_is_taken(tmp_path):
    columns = {f"imu{n}_{k}": [x] * 9 for n in (1, 2) for k, x in zip("pqr", (n, 2.0, 3.0))}
    columns |= {f"imu{n}_acc_{k}_g": [n / 100] * 9 for n in (1, 2) for k in "xy"}
    columns |= {f"imu{n}_acc_z_g": [1.0] * 9 for n in (1, 2)}
    source = table(tmp_path / "in.csv", t_s=np.arange(9) / 10, **columns)
    for n in (1, 2):
        mapping = [parsed_mapping(f"g{a}=imu{n}_{k}:dps") for a, k in zip("xyz", "pqr")]
        recording, _ = read_foreign(source, mapping=mapping)
        assert recording.columns["ax"][0] == pytest.approx(163.84 * n, abs=0.5)


def test_a_line_of_other_names_before_its_values_is_no_row_of_the_others(tmp_path):
    rows = [f"gx:{k}.5 gy:2 gz:-3 t:{10 * k}" for k in range(9)]
    rows[4] = rows[4].replace("gy", "ax")
    (tmp_path / "in.txt").write_text("\n".join(["ready: 1", *rows, ""]))
    _, report = read_foreign(tmp_path / "in.txt", units={"gyro": "dps", "time": "ms"})
    assert (report.rows_written, sum(report.dropped.values())) == (8, 1)


def test_a_recording_in_this_form_only_changes_its_format(tmp_path):
    columns = {name: np.arange(5) for name in ("gx", "gy", "gz", "load")}
    columns["t_us"] = 3000 + 100_000 * np.arange(5)
    write_recording(recording_from_columns(columns, Scales("X", 10, 77)), tmp_path / "in.csv")
    report = import_recording(tmp_path / "in.csv", tmp_path / "out.parquet")
    recording = read_recording(tmp_path / "out.parquet")
    assert recording.columns["load"].tolist() == [0, 1, 2, 3, 4]
    assert recording.scales.gyro_lsb_per_dps == 77
    assert report.notes == ["a recording in this form already"]
    assert (report.rows_read, report.rows_written, report.odr_hz) == (5, 5, 10)
    assert report.duration_s == pytest.approx(0.4)
    for told_more in ({"options": Options(hz=5.0)}, {"units": {"gyro": "dps"}}):
        report = read_foreign(tmp_path / "in.csv", **told_more)[1]
        assert told(report, "its own scales and times are kept") and report.odr_hz == 10
