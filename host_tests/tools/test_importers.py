"""Foreign recordings come out as integers in LSB, and every loss is told."""

import gzip

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
import scipy.io
from zerorate_tools.errors import BadRecording
from zerorate_tools.importers import (
    Options,
    import_recording,
    layouts,
    parsed_mapping,
    read_bins,
    read_foreign,
)
from zerorate_tools.recordings import (
    Scales,
    read_recording,
    recording_from_columns,
    write_recording,
)
from zerorate_tools.recordings.checks import GAP

from . import foreign_files

RNG = np.random.default_rng(5)
G = 9.80665


def table(path, **columns):
    """A CSV of these columns."""
    pd.DataFrame(columns).to_csv(path, index=False)
    return path


def told(report, words):
    return any(words in line for line in report.lines())


# Tables by a mapping


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
    assert told(report, "131 LSB per dps chosen")
    assert told(report, "no temperature") and told(report, "no acceleration")


def test_a_layout_can_be_named_or_forbidden(tmp_path):
    (tmp_path / "in.csv").write_text("temp,xaxis,yaxis,zaxis\n20.0,0.1,0.2,0.3\n")
    with pytest.raises(BadRecording, match="no layout 'hub'; choose of table, adis16405_counts"):
        read_foreign(tmp_path / "in.csv", layout="hub")
    hub, _ = read_foreign(tmp_path / "in.csv", layout="hub_means", options=Options(hz=1))
    assert hub.scales.gyro_lsb_per_dps == 1000
    with pytest.raises(BadRecording, match="no column for gx"):
        read_foreign(tmp_path / "in.csv", layout="table", options=Options(hz=1))


def test_a_file_of_another_layout_than_named_is_refused(tmp_path):
    source = table(tmp_path / "in.csv", t_s=[0, 1], gx_dps=[1, 1], gy_dps=[1, 1], gz_dps=[1, 1])
    for name in layouts.NAMES:
        with pytest.raises(BadRecording):
            read_foreign(source, layout=name, options=Options(hz=1))


def test_tabs_and_semicolons_are_seen(tmp_path):
    for separator in "\t;":
        text = separator.join(["t_s", "gx_dps", "gy_dps", "gz_dps"]) + "\n"
        text += separator.join(["0", "1", "2", "3"]) + "\n" + separator.join("1123") + "\n"
        (tmp_path / "in.tsv").write_text(text)
        recording, _ = read_foreign(tmp_path / "in.tsv")
        assert recording.columns["gz"].tolist() == [393, 393]


def test_raw_counts_stay_as_they_are_and_need_their_scale(tmp_path):
    source = table(tmp_path / "in.csv", gx=[7, -9], gy=[1, 1], gz=[0, 3])
    with pytest.raises(BadRecording, match="unit of column 'gx' is not known.*--map gx=gx:UNIT"):
        read_foreign(source)
    with pytest.raises(BadRecording, match="unit of column 'gx' cannot be 'knots'"):
        read_foreign(source, units={"gyro": "knots"})
    with pytest.raises(BadRecording, match="scale of raw counts.*give --gyro-lsb-per-dps"):
        read_foreign(source, units={"gyro": "lsb"}, options=Options(hz=100))
    scaled = Options(hz=100, gyro_lsb_per_dps=16.4)
    recording, _ = read_foreign(source, units={"gyro": "lsb"}, options=scaled)
    assert recording.columns["gx"].tolist() == [7, -9]
    assert recording.columns["t_us"].tolist() == [0, 10_000]


def test_the_finest_range_that_holds_every_reading_is_chosen(tmp_path):
    for largest, lsb in ((100.0, 131.0), (300.0, 65.5), (1500.0, 16.4)):
        source = table(tmp_path / "in.csv", t_s=[0, 1], gx_dps=[0, largest], gy_dps=[1, 1],
                       gz_dps=[1, 1])  # fmt: skip
        assert read_foreign(source)[0].scales.gyro_lsb_per_dps == lsb


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
    assert recording.columns["t_us"].tolist() == [0, 2_000_000, 3_000_000]
    assert report.rows_read == 7 and report.rows_written == 3
    assert told(report, "dropped 1 rows: all readings are zero")
    assert told(report, "dropped 1 rows: the time stamp goes backwards")
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


def test_a_truncated_gzip_is_refused(tmp_path):
    whole = gzip.compress(b"t_s,gx_dps,gy_dps,gz_dps\n" + b"1,2,3,4\n" * 9999)
    (tmp_path / "in.csv.gz").write_bytes(whole[:-20])
    with pytest.raises(BadRecording, match="cut off or damaged"):
        read_foreign(tmp_path / "in.csv.gz")


def test_a_recording_in_this_form_only_changes_its_format(tmp_path):
    columns = {name: np.arange(5) for name in ("t_us", "gx", "gy", "gz", "load")}
    write_recording(recording_from_columns(columns, Scales("X", 10, 77)), tmp_path / "in.csv")
    report = import_recording(tmp_path / "in.csv", tmp_path / "out.parquet")
    recording = read_recording(tmp_path / "out.parquet")
    assert recording.columns["load"].tolist() == [0, 1, 2, 3, 4]
    assert recording.scales.gyro_lsb_per_dps == 77
    assert told(report, "in this form already")


# Other formats


def test_a_mat_is_a_table_of_its_variables(tmp_path):
    rates = RNG.normal(size=(50, 3))
    scipy.io.savemat(tmp_path / "in.mat", {"w": rates, "t": np.arange(50.0), "note": "hello"})
    words = ["t_us=t:s", *(f"g{a}=w[{i}]:dps" for i, a in enumerate("xyz"))]
    mapping = [parsed_mapping(word) for word in words]
    recording, _ = read_foreign(tmp_path / "in.mat", mapping=mapping)
    assert recording.columns["gy"].tolist() == np.rint(rates[:, 1] * 131).tolist()
    (tmp_path / "bad.mat").write_bytes(b"nothing of the kind" * 20)
    with pytest.raises(BadRecording, match="no .mat file"):
        read_foreign(tmp_path / "bad.mat", mapping=mapping)


def test_a_ulog_gives_each_rate_the_nearest_acceleration(tmp_path):
    n = 20
    stamps, late = np.arange(n) * 5000 + 1000, np.arange(n) * 5000 + 2500
    rates, force = RNG.normal(size=(n, 3)) * 0.1, RNG.normal(size=(n, 3))
    still = {"temperature": ("float", np.full(n, 41.5))}
    foreign_files.ulog(
        tmp_path / "in.ulg",
        {
            "sensor_gyro": {"timestamp": ("uint64_t", stamps)}
            | {a: ("float", rates[:, i]) for i, a in enumerate("xyz")}
            | still,
            "sensor_accel": {"timestamp": ("uint64_t", late)}
            | {a: ("float", force[:, i]) for i, a in enumerate("xyz")},
        },
    )
    recording, _ = read_foreign(tmp_path / "in.ulg")
    assert recording.columns["t_us"].tolist() == stamps.tolist()
    assert recording.gyro_dps() == pytest.approx(np.degrees(rates), abs=0.5 / 131 + 1e-4)
    assert recording.accel_g() == pytest.approx(force / G, abs=1e-4)
    assert recording.temp_degc() == pytest.approx(np.full(n, 41.5), abs=0.006)
    assert recording.scales.odr_hz == pytest.approx(200)


def test_a_ulog_of_combined_sensors_has_no_temperature(tmp_path):
    fields = {
        "timestamp": ("uint64_t", [0, 4000]),
        "gyro_rad": ("float[3]", [[0.1, 0.2, 0.3], [0.1, 0.2, 0.3]]),
        "accelerometer_m_s2": ("float[3]", [[0, 0, -G], [0, 0, -G]]),
    }
    foreign_files.ulog(tmp_path / "in.ulg", {"sensor_combined": fields})
    recording, report = read_foreign(tmp_path / "in.ulg")
    assert recording.accel_g()[0].tolist() == [0, 0, -1]
    assert told(report, "no temperature")


def test_a_ulog_that_is_none_or_lacks_the_sensor_is_refused(tmp_path):
    (tmp_path / "bad.ulg").write_bytes(b"ULoX" * 50)
    with pytest.raises(BadRecording, match="no ULog"):
        read_foreign(tmp_path / "bad.ulg")
    foreign_files.ulog(tmp_path / "in.ulg", {"other": {"timestamp": ("uint64_t", [1])}})
    with pytest.raises(BadRecording, match="neither sensor_gyro nor sensor_combined"):
        read_foreign(tmp_path / "in.ulg")


def test_a_dataflash_log_gives_one_instance(tmp_path):
    rows = [(i * 2500, i % 2, 0.01 * i, 0.02, 0.03, 0.0, 0.0, -G, 35.0 + i) for i in range(10)]
    foreign_files.dataflash(tmp_path / "in.bin", rows)
    recording, report = read_foreign(tmp_path / "in.bin", instance=1)
    assert recording.columns["t_us"].tolist() == [row[0] for row in rows[1::2]]
    expected = np.degrees([row[2] for row in rows[1::2]])
    assert recording.gyro_dps()[:, 0] == pytest.approx(expected, abs=0.005)
    assert recording.temp_degc() == pytest.approx([36, 38, 40, 42, 44])
    assert told(report, "INS_GYROFFS")
    with pytest.raises(BadRecording, match="no IMU message of instance 2"):
        read_foreign(tmp_path / "in.bin", instance=2)


# Layouts of public recordings, made here in their form


def test_an_mpu6050_in_printed_units_comes_back_to_the_last_bit(tmp_path):
    raw = RNG.integers(-32000, 32000, (300, 7))
    printed = raw / ([131.0] * 3 + [16384.0] * 3 + [340.0]) + ([0.0] * 6 + [36.53])
    names = ["t_s", *(f"g{a}_dps" for a in "xyz"), *(f"a{a}_g" for a in "xyz"), "temp_C"]
    frame = pd.DataFrame(np.c_[np.repeat(np.arange(150), 2) * 0.01, printed], columns=names)
    frame.loc[[7, 9], names] = 0.0
    frame.to_csv(tmp_path / "in.csv.gz", index=False, float_format="%.6g")
    report = import_recording(tmp_path / "in.csv.gz", tmp_path / "out.parquet")
    recording = read_recording(tmp_path / "out.parquet")
    kept = np.delete(raw, [7, 9], axis=0)
    names = ("gx", "gy", "gz", "ax", "ay", "az")
    got = np.stack([recording.columns[name] for name in names], axis=1)
    assert np.abs(got - kept[:, :6]).max() <= 0
    assert np.abs(recording.columns["temp"] - kept[:, 6]).max() == 0
    assert told(report, "recognised as mpu6050_unmoved")
    assert told(report, "dropped 2 rows: all readings are zero")


def test_the_cool_downs_die_temperature_comes_back_in_its_own_steps(tmp_path):
    raw = np.arange(-500, -400) * 16
    zeros = np.zeros(100)
    columns = {"now[ms]": np.arange(100) * 79, "AHT_tmp[C]": zeros, "AHT_hum": zeros + 38.62}
    columns |= {"BMP_temp[C]": zeros, "BMP_pres": zeros + 102633}
    columns |= {"gx": zeros + 1.748, "gy": zeros, "gz": zeros, "ax": zeros, "ay": zeros}
    columns |= {"az": zeros + 1, "gtemp": np.round(raw / 340 + 36.53, 2), "magx": zeros}
    columns |= {"magy": zeros, "magz": zeros, "volt": zeros + 3087}
    recording, _ = read_foreign(table(tmp_path / "cooldown.csv", **columns))
    assert recording.columns["temp"].tolist() == raw.tolist()
    assert recording.columns["gx"][0] == 229
    assert recording.columns["vdd_mv"][0] == 3087
    assert recording.columns["humidity_mpct"][0] == 38620


def test_hubs_with_and_without_time(tmp_path):
    (tmp_path / "rb.csv").write_text(
        "time,   dc, temp, xaxis, yaxis, zaxis\n  15,    0, 26.2, -1.04, -1.83, -0.40\n"
        "  30,    1, 26.2, -1.04, -1.83, -0.37\n"
    )
    recording, _ = read_foreign(tmp_path / "rb.csv")
    assert recording.columns["t_us"].tolist() == [15_000_000, 30_000_000]
    assert recording.columns["gz"].tolist() == [-400, -370]
    assert recording.columns["temp"].tolist() == [2620, 2620]
    assert recording.columns["heater_pct"].tolist() == [0, 1]
    (tmp_path / "rx.csv").write_text(" temp, xaxis, yaxis, zaxis\n 22.8, -0.57, -2.25, -0.89\n" * 1)
    with pytest.raises(BadRecording, match="no time stamps.*--hz 1/15"):
        read_foreign(tmp_path / "rx.csv")
    recording, _ = read_foreign(tmp_path / "rx.csv", options=Options(hz=1 / 15))
    assert recording.columns["gy"].tolist() == [-2250]


def test_counts_without_time_take_their_rate(tmp_path):
    names = [f"{letter}{axis}_lsb" for letter in "ga" for axis in "xyz"]
    counts = pa.table({name: pa.array([1, -2, 3], pa.int16()) for name in names})
    pq.write_table(counts, tmp_path / "in.parquet")
    with pytest.raises(BadRecording, match="--hz 100"):
        read_foreign(tmp_path / "in.parquet")
    recording, _ = read_foreign(tmp_path / "in.parquet", options=Options(hz=100))
    assert recording.columns["az"].tolist() == [1, -2, 3]
    assert recording.columns["t_us"].tolist() == [0, 10_000, 20_000]
    assert recording.scales.gyro_lsb_per_dps == 20


def test_vectornav_lines_are_checked_and_keep_their_place_in_time(tmp_path):
    good = foreign_files.vectornav_line((0.01, -0.02, 0.03))
    lines = [good, good[:-2] + "00", good[:40], good.replace("$VN", "$V\0N"), good]
    (tmp_path / "in.csv.gz").write_bytes(gzip.compress("\n".join(lines).encode()))
    recording, report = read_foreign(tmp_path / "in.csv.gz", options=Options(hz=50))
    assert recording.columns["t_us"].tolist() == [0, 80_000]
    assert recording.columns["gx"].tolist() == [round(np.degrees(0.01) * 131)] * 2
    assert recording.columns["az"].tolist() == [round(-9.8 / G * 16384)] * 2
    assert recording.columns["pressure_pa"].tolist() == [96559] * 2
    assert report.rows_read == 5 and report.rows_written == 2
    assert told(report, "dropped 1 rows: the checksum fails")
    assert told(report, "dropped 1 rows: no whole line")
    assert told(report, "dropped 1 rows: damaged")


def test_a_broad_trial_keeps_movement_and_optical_attitude(tmp_path):
    raw = RNG.integers(-10000, 10000, (30, 3))
    quaternion = RNG.normal(size=(30, 4))
    quaternion /= np.linalg.norm(quaternion, axis=1, keepdims=True)
    quaternion[:5] = np.nan
    moving = (np.arange(30) > 10).astype(np.uint8)
    trial = {"imu_gyr": raw * 0.001065297, "imu_acc": np.full((30, 3), 9.81)}
    trial |= {"opt_quat": quaternion, "movement": moving[:, None], "sampling_rate": 2000 / 7}
    scipy.io.savemat(tmp_path / "in.mat", trial)
    recording, report = read_foreign(tmp_path / "in.mat")
    assert recording.gyro_lsb().tolist() == raw.tolist()
    assert recording.columns["moving"].tolist() == moving.tolist()
    optical = np.stack([recording.columns[f"opt_q{n}"] for n in "wxyz"], axis=1)
    assert not optical[:5].any()
    assert optical[5:] * 2.0**-29 == pytest.approx(quaternion[5:], abs=1e-8)
    assert recording.scales.odr_hz == pytest.approx(285.714, abs=1e-3)
    assert recording.scales.more["channels"]["opt_qw"]["role"] == "reference"
    assert told(report, "5 rows unseen")


BINS = """BIN_DATA:  9,   1.38, 19674, 11107,  0.12998, -0.11330,  9.80665, -0.1, 0.0, 0.1, -49.576
BIN_DATA: 15,  14.65, 12853,    0,  0.11542, -0.11539,  9.83959, -0.00289,  0.00318,  0.0, 0.0"""


def test_bins_without_time_are_a_table_and_no_recording(tmp_path):
    (tmp_path / "unit.log").write_text(BINS)
    with pytest.raises(BadRecording, match="2 temperature bins without time"):
        read_foreign(tmp_path / "unit.log")
    bins = read_bins(tmp_path / "unit.log")
    assert bins["temp_degc"].tolist() == [1.38, 14.65]
    assert bins["n"].tolist() == [19674, 12853]
    assert bins["az"][0] == pytest.approx(1.0)
    assert bins["gx"][0] == pytest.approx(np.degrees(-0.1))
    assert np.isnan(bins["turning_gz"][1]) and bins["turning_gz"][0] == -49.576


# The real ones, where they are


@pytest.mark.parametrize(
    ("pattern", "hz", "files"),
    [
        ("mpu6050-unmoved/*.csv.gz", None, 7),
        ("gy521-cooldown/*.csv.gz", None, 1),
        ("lsm6ds3-hubs/R[XB].csv", 1 / 15, 2),
        ("adis16405-static/*1.parquet", 100, 1),
        ("vn200-flip/*.csv.gz", 50, 2),
        ("broad/02*.mat", None, 1),
    ],
)
def test_every_real_recording_is_imported(real_data, tmp_path, pattern, hz, files):
    found = sorted(real_data.glob(pattern))
    assert len(found) == files
    for number, source in enumerate(found):
        out = tmp_path / f"{number}.parquet"
        report = import_recording(source, out, options=Options(hz=hz))
        assert report.rows_written > 0.89 * report.rows_read
        assert len(read_recording(out)) == report.rows_written


def test_the_real_mpu6050_comes_back_to_integers(real_data):
    for source in real_data.glob("mpu6050-unmoved/*.csv.gz"):
        frame = pd.read_csv(source)
        frame = frame[frame["temp_C"] != 0]
        recording, _ = read_foreign(source)
        printed = frame[["gx_dps", "gy_dps", "gz_dps"]].to_numpy()
        assert np.abs(recording.gyro_lsb() - printed * 131).max() < 0.001


def test_the_real_bins_are_read(real_data):
    assert len(read_bins(real_data / "hipnuc-bins" / "unitA_ac697ea.log")) == 30
    assert len(read_bins(real_data / "hipnuc-bins" / "unitB_d6f064e.log")) == 34
