"""Binary logs of others; host_tests/hostile tries the process of its own that reads each."""

from collections import Counter
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from pyarrow.feather import write_feather
from zerorate_bench.foreign_logs import binary as foreign_files
from zerorate_tools.errors import BadRecording
from zerorate_tools.importers import read_foreign
from zerorate_tools.importers.logs import apart, arrays, json_file, messages

from host_tests.hostile.many_logs import in_this_process

from .test_tables import told

G = 9.80665


@pytest.fixture(autouse=True)
def child(monkeypatch):
    """What the child does is done here."""
    monkeypatch.setattr(apart, "table_apart", in_this_process)
    monkeypatch.setattr("resource.setrlimit", lambda *limits: None)


@pytest.mark.parametrize(
    ("name", "content", "said"),
    [
        ("bad.mat", b"nothing of the kind" * 20, "no .mat file"),
        ("bad.ulg", b"ULoX" * 50, "no ULog"),
        ("in.bbl", bytes(range(256)) * 9, "no blackbox log, or damaged; copy the file again"),
        ("a#b.db3", b"SQLite format 3\0" + bytes(range(256)) * 40, "no bag of ROS 2"),
    ],
)
def test_what_is_called_as_a_log_and_is_none_says_so(tmp_path, name, content, said):
    (tmp_path / name).write_bytes(content)
    with pytest.raises(BadRecording, match=said):
        read_foreign(tmp_path / name)


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
    foreign_files.ulog(tmp_path / "in.ulg", {"other": {"timestamp": ("uint64_t", [1])}})
    with pytest.raises(BadRecording, match="neither sensor_gyro nor sensor_combined"):
        read_foreign(tmp_path / "in.ulg")


def test_a_dataflash_log_gives_one_instance(tmp_path):
    rows = [(i * 2500, i % 2, 0.01 * i, 0.02, 0.03, 0.0, 0.0, -G, 35.0 + i) for i in range(10)]
    foreign_files.dataflash(tmp_path / "in.bin", rows)
    recording, report = read_foreign(tmp_path / "in.bin", instance=1)
    assert recording.columns["t_us"].tolist() == [row[0] for row in rows[1::2]]
    assert recording.temp_degc() == pytest.approx([36, 38, 40, 42, 44])
    assert told(report, "INS_GYROFFS")
    with pytest.raises(BadRecording, match="no IMU message of instance 2"):
        read_foreign(tmp_path / "in.bin", instance=2)


def test_a_bag_of_other_topics_says_what_it_has(tmp_path):
    with pytest.raises(BadRecording, match="no topic of type sensor_msgs/Imu.*/imu/temperature"):
        read_foreign(foreign_files.bag(tmp_path / "bag", "ros2", imu=False))


def test_an_imu_within_the_message_of_a_driver_is_read(tmp_path):
    recording, _ = read_foreign(foreign_files.bag_of_a_driver(tmp_path / "own.bag"))
    assert len(recording) == 600
    assert recording.gyro_dps()[0] == pytest.approx(foreign_files.SHORT.dps[0], abs=0.005)


@pytest.mark.parametrize("write", [pq.write_table, write_feather])
def test_words_dates_and_gaps_of_a_file_by_columns(tmp_path, write):
    at = np.arange(70_000)
    words = np.resize(["still", "fast", "", None], len(at))
    columns = {
        "mode": pa.array(words, pa.string()),
        "kind": pa.array(np.resize(["a", "b", "a"], len(at))).dictionary_encode(),
        "same": pa.array(["x"] * len(at)),
        "many": pa.array([str(n) for n in at]),
        "on": pa.array(at % 2 == 1),
        "at": pa.array(at * 1000, pa.timestamp("ms")),
        "gaps": pa.array([None if n % 3 == 1 else n for n in at.tolist()], pa.float32()),
    }
    write(pa.table(columns), tmp_path / "in")
    table = arrays.columnar(tmp_path / "in")
    chunks = [*table.chunks(table.names)]
    assert table.words == {"mode": ["still", "fast"], "kind": ["a", "b"]}
    assert table.calendar == {"at"} and max(len(chunk.place) for chunk in chunks) <= 65536
    assert np.array_equal(np.concatenate([chunk.place for chunk in chunks]), at)
    expected = {"mode": np.resize([0, 1, np.nan, np.nan], len(at)), "at": at, "on": at % 2}
    expected |= {"kind": np.resize([0, 1, 0], len(at)), "gaps": np.where(at % 3 == 1, np.nan, at)}
    assert {*expected} == {*table.names}
    for name, values in expected.items():
        found = np.concatenate([chunk.columns[name] for chunk in chunks])
        assert np.allclose(found, values, equal_nan=True), name


def test_a_column_that_is_there_twice_is_refused_by_its_name(tmp_path):
    columns = [pa.array([1.0]), pa.array([2.0]), pa.array([3.0])]
    pq.write_table(pa.Table.from_arrays(columns, ["gx", "gy", "gx"]), tmp_path / "in.parquet")
    with pytest.raises(BadRecording, match="the column 'gx' is there twice"):
        arrays.columnar(tmp_path / "in.parquet")


def test_a_file_without_a_row_says_so(tmp_path):
    names = ("t_s", "gx_dps", "gy_dps", "gz_dps")
    pq.write_table(pa.table({n: pa.array([], pa.float64()) for n in names}), tmp_path / "x.parquet")
    with pytest.raises(BadRecording, match="no data row|no column"):
        read_foreign(tmp_path / "x.parquet")


@pytest.mark.parametrize("line", [b"(1, 2", b"{[]: 1, 'a': 2}", b"(" * 3000, b"[" * 10**6, b"'"])
def test_a_line_that_is_neither_json_nor_python_is_counted(line):
    dropped = Counter()
    assert json_file._object(line, dropped) is None and sum(dropped.values()) == 1


def stamped(**stamp):
    """A message of an IMU whose header has that stamp."""
    vector = SimpleNamespace(x=1.0, y=2.0, z=3.0)
    return SimpleNamespace(
        header=SimpleNamespace(stamp=SimpleNamespace(**stamp)),
        angular_velocity=vector,
        linear_acceleration=vector,
    )


def table_of(*decoded):
    logged = [("/imu", 7000, one) for one in decoded]
    return messages.table_of_messages(Path("bag"), {"/imu": "my/Imu"}, lambda: iter(logged))


@pytest.mark.parametrize(
    ("message", "t_us"),
    [
        (stamped(sec=3, nanosec=5000), 3000005.0),
        (stamped(sec=3, nsec=5000), 3000005.0),
        (stamped(sec=0, nanosec=5000), 5.0),
        (stamped(sec=3, nanosec=0), 3000000.0),
        (stamped(sec=0, nanosec=0), 7.0),  # no clock was set: when it was logged
        (stamped(sec=3), 7.0),
        ({"angular_velocity": {"x": 1.0, "y": 2.0, "z": 3.0}}, 7.0),
    ],
)
def test_a_message_without_a_whole_stamp_has_the_time_when_it_was_logged(message, t_us):
    table = table_of(lambda: message)
    (chunk,) = table.chunks(table.names)
    assert chunk.columns["t_us"].tolist() == [t_us]
    assert chunk.columns["/imu/angular_velocity/z"].tolist() == [3.0]


def breaks(after, error):
    yield from range(after)
    raise error


def test_what_comes_before_damage_is_taken_and_said():
    error, notes = ValueError("bad  chunk\n" + "x" * 99), ["before"]
    assert list(messages.as_far_as_it_goes(breaks(3, error), notes)) == [0, 1, 2]
    words = f"cut off or damaged after 3 messages (bad chunk {'x' * 50}): those are taken"
    assert notes == ["before", words]
    with pytest.raises(ValueError, match="bad"):
        list(messages.as_far_as_it_goes(breaks(0, error), notes))


def test_a_lack_of_memory_is_no_damage():
    with pytest.raises(MemoryError):
        list(messages.as_far_as_it_goes(breaks(3, MemoryError()), []))
    table = table_of(lambda: next(breaks(0, MemoryError())))
    with pytest.raises(MemoryError):
        list(table.chunks(table.names))


def test_a_folder_is_as_large_as_the_files_in_it(tmp_path):
    (tmp_path / "of").mkdir()
    (tmp_path / "a").write_bytes(bytes(7))
    (tmp_path / "of" / "b").write_bytes(bytes(30))
    assert (apart._size(tmp_path), apart._size(tmp_path / "a")) == (37, 7)
