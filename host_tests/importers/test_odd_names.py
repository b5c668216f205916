"""What a column is: by its usual name, by a unit in it, by what it holds."""

import re

import numpy as np
import pandas as pd
import pytest
from zerorate_tools.errors import BadRecording, InFile
from zerorate_tools.importers import Options, import_recording
from zerorate_tools.importers.columns import names as usual

from .test_odd_files import rates, read, table, told


@pytest.mark.parametrize(
    "names",
    [
        "imu.gyro.x imu.gyro.y imu.gyro.z",
        "wx wy wz",
        "gyr_x gyr_y gyr_z",
        "AngVelX AngVelY AngVelZ",
        "Gyroscope_X Gyroscope_Y Gyroscope_Z",
        "xgyro ygyro zgyro",
        "GyX GyY GyZ",
        "UncompGyro0 UncompGyro1 UncompGyro2",
        "gx_mean gy_mean gz_mean",
        "roll_rate pitch_rate yaw_rate",
    ],
)
def test_usual_names_need_but_a_unit_and_the_words_for_it_work(tmp_path, names):
    frame = rates(["t_s", *names.split()])
    with pytest.raises(BadRecording, match="not known; give --gyro-unit dps [(]or"):
        read(tmp_path, frame)
    recording, _ = read(tmp_path, frame, units={"gyro": "dps"})
    assert recording.gyro_dps().mean() == pytest.approx(0.8, abs=0.02)


def test_a_counter_of_rows_is_offered_as_no_time(tmp_path):
    with pytest.raises(BadRecording, match="no time stamps; give --hz"):
        read(tmp_path, rates(["n", "gx_dps", "gy_dps", "gz_dps"]).assign(n=range(2000)))


@pytest.mark.parametrize(
    "names",
    [
        "w_RS_S_x [rad s^-1] w_RS_S_y [rad s^-1] w_RS_S_z [rad s^-1]",
        "raw_angular_rate_x_rad_per_s raw_angular_rate_y_rad_per_s raw_angular_rate_z_rad_per_s",
        "X (rad/sec) Y (rad/sec) Z (rad/sec)",
        "gx_rad_s gy_rad_s gz_rad_s",
        "x-axis (rad/s) y-axis (rad/s) z-axis (rad/s)",
        "imu rate x [radians per second] imu rate y [radians per second] "
        "imu rate z [radians per second]",
    ],
)
def test_a_unit_of_rates_tells_what_a_column_is(tmp_path, names):
    names = re.findall(r"\S.*?(?:[])]|_s\b)", names)
    frame = rates(["timestamp_seconds", *names])
    frame[names] = np.radians(frame[names])
    recording, _ = read(tmp_path, frame)
    assert recording.gyro_dps().mean() == pytest.approx(0.8, abs=0.02)


@pytest.mark.parametrize(
    ("names", "offered"),
    [
        ("t_s p q r", "if these are rates: --map gx=p:dps --map gy=q:dps"),
        ("t_s xaxis yaxis zaxis", "--map gx=xaxis:dps --map gy=yaxis:dps"),
        # a quaternion is none
        ("t_s x y z w", "map it: --map gx=COLUMN:UNIT.* COLUMN one of t_s, x"),
        # a phone's Sensor Logger
        ("seconds_elapsed x y z", "--map gx=x:rad/s --map gy=y:rad/s"),
    ],
)
def test_what_may_be_rates_is_offered_as_such(tmp_path, names, offered):
    with pytest.raises(BadRecording, match=offered):
        read(tmp_path, rates(names.split()), name="turned.csv")


def test_a_temperature_of_another_name_is_offered(tmp_path):
    frame = table().rename(columns={"temp_c": "temp_h"}).assign(temp_cpu=40.0)
    _, report = read(tmp_path, frame)
    words = "by its name, but temp_h, temp_cpu: the bias cannot be followed over temperature"
    assert told(report, f"{words}; if one of them is the sensor's or near it: --map temp=temp_h")
    assert "temp" in read(tmp_path, frame, mapping="temp=temp_h")[0].columns
    _, report = read(tmp_path, table(), mapping="temp=none")
    assert told(report, "no temperature: the bias")


def test_columns_that_may_hold_a_cause_are_said_to_be_left_aside(tmp_path):
    frame = table().assign(humidity=40.0, volt=3087.0)
    _, report = read(tmp_path, frame)
    assert told(report, "left aside: humidity, volt; take one along as --map NAME=COLUMN")
    recording, report = read(tmp_path, frame, mapping="vdd_mv=volt humidity=humidity")
    assert "vdd_mv" in recording.columns and not told(report, "left aside")


@pytest.mark.parametrize("name", ["FreeAcc_{}_g", "lacc_{}_g", "LinAcc{} (g)"])
def test_acceleration_less_gravity_is_none(tmp_path, name):
    frame = table().rename(columns={f"a{a}_g": name.format(a.upper()) for a in "xyz"})
    assert "ax" not in read(tmp_path, frame)[0].columns


def test_a_csv_of_plotjuggler_is_known_by_its_columns(tmp_path):
    frame = table()
    columns = {"__time": 1_777_636_800 + frame["t_s"]}
    for topic in ("/imu", "/second"):
        columns |= {f"{topic}/angular_velocity/{a}": np.radians(frame[f"g{a}_dps"]) for a in "xyz"}
        columns |= {f"{topic}/linear_acceleration/{a}": 9.8 * frame[f"a{a}_g"] for a in "xyz"}
    recording, report = read(tmp_path, pd.DataFrame(columns))
    assert recording.gyro_dps().mean() == pytest.approx(0.8, abs=0.02)
    assert recording.accel_g()[:, 2].mean() == pytest.approx(1, abs=0.01)
    assert told(report, "of several gyroscopes (/imu/angular_velocity/x, /second/")
    with pytest.raises(BadRecording, match="there are 2 gyroscopes; give --instance 0 to 1"):
        read(tmp_path, pd.DataFrame(columns), instance=2)
    with pytest.raises(BadRecording, match="there is one gyroscope; leave --instance away"):
        read(tmp_path, frame, instance=1)


def test_degrees_declared_as_radians_are_refused_with_the_right_words(tmp_path):
    frame = table()
    for axis in "xyz":
        frame[f"g{axis}_dps"] += 60.0 * np.sin(np.arange(2000) / 50)
    frame.columns = ["t_s", "p", "q", "r", *frame.columns[4:]]
    words = "gx=p:rad/s gy=q:rad/s gz=r:rad/s"
    with pytest.raises(BadRecording, match="did you mean dps[?] Give --map gx=p:dps") as error:
        read(tmp_path, frame, mapping=words)
    assert "34" in str(error.value)  # more than 3400 dps
    mended = words.replace("rad/s", "dps")
    assert read(tmp_path, frame, mapping=mended)[1].doubts == []


@pytest.mark.parametrize(
    ("words", "doubt"),
    [
        ("gx=gx_dps:rad/s gy=gy_dps:rad/s gz=gz_dps:rad/s", "a steady rate of 4[56].*mean dps"),
        ("gx=gx_dps:mdps gy=gy_dps:mdps gz=gz_dps:mdps", None),
    ],
)
def test_a_unit_that_cannot_be_is_doubted(tmp_path, words, doubt):
    _, report = read(tmp_path, table(), mapping=words)
    if doubt is None:
        assert report.doubts == []
    else:
        [said] = report.doubts
        assert re.search(doubt, said)


def test_raw_counts_are_asked_for_units_and_then_scales_in_one_go_each(tmp_path):
    frame = (16384 * table()[["t_s", *"gx_dps gy_dps gz_dps ax_g ay_g az_g".split()]]).round()
    frame.columns = ["t_us", "gx", "gy", "gz", "ax", "ay", "az"]
    frame["temp"] = -3400
    give = "--gyro-unit lsb .*--accel-unit lsb .*--temp-unit lsb "
    with pytest.raises(BadRecording, match=give):
        read(tmp_path, frame)
    units = dict.fromkeys(("gyro", "accel", "temp"), "lsb")
    give = "--gyro-lsb-per-dps 131 --accel-lsb-per-g 16384 --temp-lsb-per-degc 340 --temp-offset"
    with pytest.raises(BadRecording, match=give):
        read(tmp_path, frame, units=units)


@pytest.mark.parametrize(
    ("times", "words", "cure"),
    [
        (1.0, "ax=ax_g:m/s2 ay=ay_g:m/s2 az=az_g:m/s2", "0.102 g.*did you mean g[?] Give --map ax"),
        (4096, "ax=ax_g:lsb ay=ay_g:lsb az=az_g:lsb", "0.25 g.*give --accel-lsb-per-g 4096;"),
    ],
)
def test_a_force_that_cannot_be_gravity_is_refused(tmp_path, times, words, cure):
    frame = table()
    frame[["ax_g", "ay_g", "az_g"]] *= times
    scale = Options(accel_lsb_per_g=16384.0)
    with pytest.raises(BadRecording, match=cure):
        read(tmp_path, frame, mapping=words, options=scale)
    assert "ax" not in read(tmp_path, frame, mapping="ax=none")[0].columns


def test_a_name_as_long_as_names_may_be_is_written(tmp_path):
    source = tmp_path / "in.csv"
    source.write_text(table(50).to_csv(index=False))
    out = tmp_path / ("x" * 242 + ".parquet")
    import_recording(source, out)
    assert [path.name for path in tmp_path.glob("*.parquet")] == [out.name]
    with pytest.raises(InFile, match="the name is longer than 255 bytes; give it a shorter one"):
        import_recording(source, tmp_path / ("x" * 250 + ".parquet"))


@pytest.mark.parametrize(
    ("name", "names", "told"),
    [
        ("Raw.csv", "X_(m/s^2) Y_(m/s^2) Z_(m/s^2)", "no rates [(]the unit of .X_"),
        ("turned.csv", "x y z", "no rates [(]they are as long as gravity"),
        ("Magnetometer.csv", "x y z", "no rates [(]the file is called Magnetometer.csv"),
    ],
)
def test_axes_of_another_sensor_are_offered_as_no_rates(tmp_path, name, names, told):
    (tmp_path / "Gyroscope.csv").write_text("t_s,x,y,z\n")
    frame = table()[["t_s", "ax_g", "ay_g", "az_g"]].set_axis(["t_s", *names.split()], axis=1)
    with pytest.raises(BadRecording, match=told) as error:
        read(tmp_path, frame, name=name)
    assert "--map gx=X" not in str(error.value) and "--map gx=x" not in str(error.value)
    assert "likely in Gyroscope.csv: zerorate import" in str(error.value)


def test_an_accelerometer_in_the_file_beside_is_said(tmp_path):
    (tmp_path / "Linear Accelerometer.csv").write_text("t_s,x,y,z\n0,0,0,0.01\n1,0,0,0.02\n")
    frame = table()[["t_s", "gx_dps", "gy_dps", "gz_dps"]]
    _, report = read(tmp_path, frame, name="Gyroscope.csv")
    assert not told(report, "is beside it")  # it has no gravity
    (tmp_path / "Accelerometer.csv").write_text("t_s,x,y,z\n0,0,0,1.01\n1,0,0,1.0\n")
    _, report = read(tmp_path, frame, name="Gyroscope.csv")
    assert told(report, "Accelerometer.csv is beside it: zerorate import")


def test_a_column_of_lists_is_not_offered_for_a_rate(tmp_path):
    frame = pd.DataFrame({"t_s": np.arange(300) / 100, "pulse": 70, "gyro": "[0.8, -0.5, 0.3]"})
    with pytest.raises(BadRecording, match="COLUMN one of t_s, pulse; gyro: no number alone"):
        read(tmp_path, frame)


@pytest.mark.parametrize("three", ["acc_g_0 acc_g_1 acc_g_2", "acc_mg_x acc_mg_y acc_mg_z"])
def test_acceleration_may_have_its_unit_before_its_axis(three):
    assert list(usual.accel_groups(three.split())[0].values()) == three.split()
