"""Binary logs of others; host_tests/hostile tries the process of its own that reads each."""

import numpy as np
import pytest
import scipy.io
from zerorate_bench.foreign_logs import binary as foreign_files
from zerorate_tools.errors import BadRecording
from zerorate_tools.importers import Options, parsed_mapping, read_foreign
from zerorate_tools.importers.logs import apart

from host_tests.hostile.many_logs import in_this_process

from .test_odd_files import told

RNG = np.random.default_rng(5)
G = 9.80665


@pytest.fixture(autouse=True)
def child(monkeypatch):
    """What the child does is done here."""
    monkeypatch.setattr(apart, "table_apart", in_this_process)
    monkeypatch.setattr("resource.setrlimit", lambda *limits: None)


@pytest.mark.parametrize("turned", [False, True], ids=["a row a sample", "a column a sample"])
def test_a_mat_is_a_table_of_its_variables(tmp_path, turned):
    rates = RNG.normal(size=(50, 3))
    found = {"w": rates.T if turned else rates, "t": np.arange(50.0), "note": "hello"}
    scipy.io.savemat(tmp_path / "in.mat", found)
    words = ["t_us=t:s", *(f"g{a}=w[{i}]:dps" for i, a in enumerate("xyz"))]
    mapping = [parsed_mapping(word) for word in words]
    recording, _ = read_foreign(tmp_path / "in.mat", mapping=mapping)
    assert recording.columns["gy"].tolist() == np.rint(rates[:, 1] * 131).tolist()
    (tmp_path / "bad.mat").write_bytes(b"nothing of the kind" * 20)
    with pytest.raises(BadRecording, match="no .mat file"):
        read_foreign(tmp_path / "bad.mat", mapping=mapping)


def test_a_variable_of_a_mat_that_begins_with_time_is_offered_so(tmp_path):
    counted = np.column_stack([np.arange(50) / 100, RNG.normal(33000, 20, size=(50, 3))])
    scipy.io.savemat(tmp_path / "in.mat", {"omega": counted})
    offered = r"t_us=omega\[0\]:s --map gx=omega\[1\]:lsb --map gy=omega\[2\]:lsb"
    with pytest.raises(BadRecording, match=f"if these are rates: --map {offered}"):
        read_foreign(tmp_path / "in.mat")


def test_a_mat_of_arrays_of_three_is_read_by_their_names(tmp_path):
    arrays = {"Gyr_noise": RNG.normal(size=(50, 3)), "Acc_noise": RNG.normal(size=(50, 3))}
    scipy.io.savemat(tmp_path / "in.mat", arrays)
    with pytest.raises(BadRecording, match=r"units of columns 'Gyr_noise\[0\]'.* are not known"):
        read_foreign(tmp_path / "in.mat", options=Options(hz=100.0))


def test_the_fields_of_a_structure_are_columns(tmp_path):
    n = 40
    imu = {"t": np.arange(n)[:, None] / 100, "wb": np.full((n, 3), 0.01)}
    scipy.io.savemat(tmp_path / "in.mat", {"imu1": imu})
    words = ("t_us=imu1.t:s", *(f"g{a}=imu1.wb[{i}]:rad/s" for i, a in enumerate("xyz")))
    recording, _ = read_foreign(tmp_path / "in.mat", mapping=[*map(parsed_mapping, words)])
    assert len(recording) == n and recording.scales.odr_hz == pytest.approx(100)


def test_a_ulog_with_the_gyro_once_a_second_takes_the_combined_sensors(tmp_path):
    n = 400
    gyro = {
        "timestamp": ("uint64_t", [0, 1_000_000, 2_000_000]),
        "temperature": ("float", [41.5] * 3),
    }
    combined = {
        "timestamp": ("uint64_t", np.arange(n) * 5000),
        "gyro_rad": ("float[3]", np.full((n, 3), 0.01)),
        "accelerometer_m_s2": ("float[3]", [[0, 0, -G]] * n),
    }
    gyro |= {axis: ("float", [0.01] * 3) for axis in "xyz"}
    foreign_files.ulog(tmp_path / "in.ulg", {"sensor_gyro": gyro, "sensor_combined": combined})
    recording, report = read_foreign(tmp_path / "in.ulg")
    assert len(recording) == n and recording.temp_degc() == pytest.approx(41.5, abs=0.01)
    assert told(report, "after PX4's own offsets")
    gyro["temperature"] = ("float", [0.0] * 3)
    foreign_files.ulog(tmp_path / "in.ulg", {"sensor_gyro": gyro, "sensor_combined": combined})
    _, report = read_foreign(tmp_path / "in.ulg")
    assert told(report, "doubtful: the temperature is 0 throughout")


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


def test_units_that_a_log_states_are_not_doubted(tmp_path):
    shaking = np.radians(RNG.normal(0, 3.0, size=(500, 3)))
    rows = [(i * 40_000, 0, *rate, 0.0, 0.0, -G, 35.0) for i, rate in enumerate(shaking)]
    foreign_files.dataflash(tmp_path / "in.bin", rows)
    assert not told(read_foreign(tmp_path / "in.bin")[1], "did you mean")


@pytest.fixture
def bag_of(tmp_path):
    """A bag of a kind (ros1, ros2, db3, mcap) with 200 Hz of Imu, and 1 Hz of Temperature."""

    def make(kind, **options):
        return foreign_files.bag(tmp_path / "bag", kind, **options)

    return make


def test_a_bag_of_other_topics_says_what_it_has(bag_of):
    with pytest.raises(BadRecording, match="no topic of type sensor_msgs/Imu.*/imu/temperature"):
        read_foreign(bag_of("ros2", imu=False))


def test_an_imu_within_the_message_of_a_driver_is_read(tmp_path):
    recording, _ = read_foreign(foreign_files.bag_of_a_driver(tmp_path / "own.bag"))
    assert len(recording) == 600
    assert recording.gyro_dps()[0, 0] == pytest.approx(np.degrees(0.01), abs=0.005)


def test_what_is_called_bbl_and_is_none_says_so(tmp_path):
    (tmp_path / "in.bbl").write_bytes(bytes(range(256)) * 9)
    with pytest.raises(BadRecording, match="no blackbox log, or damaged; copy the file again"):
        read_foreign(tmp_path / "in.bbl")
