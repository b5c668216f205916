"""Steps of reading logs, which elsewhere are seen through a process of their own, and of scales."""

import os
from collections import Counter
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.feather
import pyarrow.parquet as pq
import pytest
from zerorate_i2c.parts import PARTS
from zerorate_tools.errors import BadRecording
from zerorate_tools.importers import import_recording, parsed_mapping, read_foreign
from zerorate_tools.importers.columns.guesses import guessed_unit, rate_unit_of
from zerorate_tools.importers.columns.units import RATE_DPS
from zerorate_tools.importers.logs import apart, columnar, messages
from zerorate_tools.recordings.turning import Size

BAG = Path("bag")
IMU, WARMTH = "sensor_msgs/msg/Imu", "sensor_msgs/msg/Temperature"


def vector(*xyz):
    return dict(zip("xyz", xyz))


def imu(rates, force, sec=1):
    return {
        "header": {"stamp": {"sec": sec, "nanosec": 250_000}},
        "angular_velocity": vector(*rates),
        "linear_acceleration": vector(*force),
    }


def table_of(topics, logged):
    return messages.table_of_messages(BAG, topics, lambda: iter(logged))


# Messages


def test_every_number_of_a_message_is_a_column_of_its_topic():
    warm = SimpleNamespace(temperature=31, header=None)
    logged = [
        ("/imu", 5, lambda: imu((1, 2.5, 3), (4, 5, 6))),
        ("/t", 9000, lambda: warm),
        ("/imu", 5, lambda: imu((7, "8", None), (10, 11, 12), sec=2)),
    ]
    table = table_of({"/imu": IMU, "/t": WARMTH, "/map": "nav_msgs/msg/Map"}, logged)
    rates = [f"/imu/angular_velocity/{axis}" for axis in "xyz"]
    force = [f"/imu/linear_acceleration/{axis}" for axis in "xyz"]
    assert table.names == ["t_us", *rates, *force, "/t/temperature [degc]"]
    (chunk,) = table.chunks(table.names)
    nan = np.nan
    expected = [
        [1_000_250.0, 1, 2.5, 3, 4, 5, 6, nan],
        [9.0, nan, nan, nan, nan, nan, nan, 31],
        [2_000_250.0, 7, nan, nan, 10, 11, 12, nan],
    ]
    found = np.column_stack([chunk.columns[name] for name in table.names])
    assert np.array_equal(found, expected, equal_nan=True)


@pytest.mark.parametrize(
    ("kind", "wanted"),
    [
        *((kind, True) for kind in (IMU, WARMTH, "sensor_msgs/Imu", "std_msgs/Float32", "Imu")),
        *((kind, True) for kind in ("std_msgs/msg/Float64", "sensor_msgs/Temperature")),
        *((kind, False) for kind in ("sensor_msgs/msg/Image", "ImuExtra", "my/Imu2", "")),
    ],
)
def test_types_are_known_by_their_last_word(kind, wanted):
    assert messages.is_wanted(kind) == wanted


def test_a_bag_without_rates_names_the_first_twelve_of_its_topics():
    topics = {f"/t{n:02d}": "std_msgs/Float32" for n in range(20)}
    with pytest.raises(BadRecording, match="no topic of type sensor_msgs/Imu") as caught:
        table_of(topics, [])
    assert "/t00 (std_msgs/Float32), /t01" in str(caught.value)
    assert "/t11" in str(caught.value) and "/t12" not in str(caught.value)
    with pytest.raises(BadRecording, match="this has none"):
        table_of({}, [])


def undecodable():
    raise ValueError("no such type")


def test_a_message_that_cannot_be_decoded_is_a_row_without_readings_and_counted():
    logged = [("/imu", 5, undecodable), ("/imu", 5, lambda: imu((1, 2, 3), (4, 5, 6)))]
    table = table_of({"/imu": IMU}, logged * 3)
    (chunk,) = table.chunks(table.names)
    assert table.dropped == Counter({"a message that cannot be decoded": 3})
    assert np.isnan(chunk.columns["t_us"]).tolist() == [True, False] * 3


def breaks(after, error):
    yield from range(after)
    raise error


@pytest.mark.parametrize(
    ("error", "words"),
    [
        (ValueError("bad  chunk\nof it"), "(bad chunk of it)"),
        (EOFError(), "(EOFError)"),
        (OSError("x" * 99), "(" + "x" * 60 + ")"),
    ],
)
def test_what_comes_before_damage_is_taken_and_said(error, words):
    notes = ["before"]
    assert list(messages.as_far_as_it_goes(breaks(3, error), notes)) == [0, 1, 2]
    assert notes == ["before", f"cut off or damaged after 3 messages {words}: those are taken"]
    with pytest.raises(type(error)):
        list(messages.as_far_as_it_goes(breaks(0, error), notes))
    assert len(notes) == 2


def test_a_lack_of_memory_is_no_damage():
    with pytest.raises(MemoryError):
        list(messages.as_far_as_it_goes(breaks(3, MemoryError()), []))

    def lacks_memory():
        raise MemoryError

    table = table_of({"/imu": IMU}, [("/imu", 5, lacks_memory)])
    with pytest.raises(MemoryError):
        list(table.chunks(table.names))


def test_a_folder_is_as_large_as_the_files_in_it(tmp_path):
    (tmp_path / "of").mkdir()
    (tmp_path / "a").write_bytes(bytes(7))
    (tmp_path / "of" / "b").write_bytes(bytes(30))
    assert (apart._size(tmp_path), apart._size(tmp_path / "a")) == (37, 7)


# Parquet and Feather


@pytest.mark.parametrize("rows", [13, 70_000])
@pytest.mark.parametrize("form", ["feather", "parquet"])
def test_numbers_words_and_dates_of_a_file_by_columns(tmp_path, form, rows):
    words = np.resize(["still", "fast", "", None], rows)
    table = pa.table(
        {
            "gx": pa.array(np.arange(rows) / 4),
            "on": pa.array(np.arange(rows) % 2 == 1),
            "mode": pa.array(words, pa.string()),
            "kind": pa.array(np.resize(["a", "b", "a"], rows)).dictionary_encode(),
            "same": pa.array(["x"] * rows),
            "many": pa.array([str(n) for n in range(rows)]),
            "at": pa.array(np.arange(rows) * 1000, pa.timestamp("ms")),
            "gaps": pa.array([None if n % 3 == 1 else n for n in range(rows)], pa.float32()),
        }
    )
    path = tmp_path / "in"
    if form == "feather":
        pyarrow.feather.write_feather(table, path, chunksize=rows)
    else:
        pq.write_table(table, path)
    read = columnar.read(path)
    assert read.names == [name for name in table.schema.names if name not in ("same", "many")]
    assert read.words == {"mode": ["still", "fast"], "kind": ["a", "b"]}
    assert read.calendar == {"at"}
    chunks = [*read.chunks(read.names)]
    assert max(len(chunk.place) for chunk in chunks) <= 65536
    found = {name: np.concatenate([c.columns[name] for c in chunks]) for name in read.names}
    n, nan = np.arange(rows), np.nan
    assert (np.concatenate([chunk.place for chunk in chunks]) == n).all()
    expected = {"gx": n / 4, "on": n % 2, "at": n, "gaps": np.where(n % 3 == 1, nan, n)}
    expected |= {"mode": np.resize([0, 1, nan, nan], rows), "kind": np.resize([0, 1, 0], rows)}
    for name, values in expected.items():
        assert np.allclose(found[name], values, rtol=1e-12, atol=0, equal_nan=True), name


def test_a_column_that_is_there_twice_is_refused_by_its_name(tmp_path):
    columns = [pa.array([1.0]), pa.array([2.0]), pa.array([3.0])]
    pq.write_table(pa.Table.from_arrays(columns, ["gx", "gy", "gx"]), tmp_path / "in.parquet")
    with pytest.raises(BadRecording, match="the column 'gx' is there twice"):
        columnar.read(tmp_path / "in.parquet")


# Units and scales


@pytest.mark.parametrize("unit", RATE_DPS)
@pytest.mark.parametrize(("times", "near"), [(0.3, 1), (1.3, 1), (0.2, 0), (1.5, 0)])
def test_gravity_that_turns_tells_the_unit_within_what_pushes_can_make_of_it(unit, times, near):
    dps = RATE_DPS[unit] * times
    told = rate_unit_of(Size(dps, dps / 1.4, dps * 4.1))
    assert (told is not None and RATE_DPS[told] == RATE_DPS[unit]) == near


@pytest.mark.parametrize(
    ("lsb", "unit"),
    [(1.0, "dps"), (180 / np.pi, "rad/s"), (0.1, None), (0.18 / np.pi, None)],
)
def test_a_device_that_turns_tells_the_unit_of_its_rates_by_gravity(lsb, unit):
    t_s = np.arange(1500) / 50
    angle = 0.6 * np.sin(2 * np.pi * 0.3 * t_s)
    dps = np.degrees(np.gradient(angle, t_s))
    still = np.zeros(1500)
    counted = np.rint if unit is None else np.asarray
    first = {
        **{"gx": counted(dps / lsb), "gy": counted(still), "gz": counted(still)},
        **{"ax": still, "ay": np.sin(angle), "az": np.cos(angle)},
    }
    wanted = {name: SimpleNamespace(column=name, unit="", target=name) for name in first}
    told = (unit, "gravity turns with it") if unit else (None, "")
    assert guessed_unit("gx", wanted, list(first), first, t_s) == told


def logged(tmp_path, **more):
    """A CSV of 400 samples at 100 Hz with these columns besides rates."""
    rows = 3 * np.sin(np.arange(1200).reshape(400, 3))
    frame = pd.DataFrame(rows, columns=["gx_dps", "gy_dps", "gz_dps"])
    frame.insert(0, "t_s", np.arange(400) / 100)
    frame.assign(**more).to_csv(tmp_path / "in.csv", index=False)
    return tmp_path / "in.csv"


@pytest.mark.parametrize("part", [PARTS[0], PARTS[3]])
def test_a_temperature_in_steps_of_a_part_comes_back_to_its_counts(tmp_path, part):
    _, name, lsb, offset, *_ = part
    counts = -1200 + np.arange(400)
    path = logged(tmp_path, temp_c=np.round(counts / lsb + offset, 6))
    recording, report = read_foreign(path)
    assert recording.columns["temp"].tolist() == counts.tolist()
    assert (recording.scales.temp_lsb_per_degc, recording.scales.temp_offset_degc) == (lsb, offset)
    assert any(f"as a {name} counts" in line for line in report.notes)


def test_a_temperature_of_three_values_tells_no_part(tmp_path):
    path = logged(tmp_path, temp_c=np.resize([25.0, 26.0, 27.0], 400))
    scales = read_foreign(path)[0].scales
    assert (scales.temp_lsb_per_degc, scales.temp_offset_degc) == (100.0, 0.0)


def test_one_reading_of_acceleration_leaves_no_sample_and_says_how_to_import(tmp_path):
    force = np.full((400, 3), np.nan)
    force[0] = 0, 0, 1
    path = logged(tmp_path, **dict(zip(("ax_g", "ay_g", "az_g"), force.T)), level=1)
    recording, report = read_foreign(path, mapping=[parsed_mapping("level=level")])
    assert len(recording.columns["gx"]) + sum(report.dropped.values()) == report.rows_read


def test_a_column_without_a_number_is_left_out_and_the_whole_acceleration_with_it(tmp_path):
    path = logged(tmp_path, ax_g=0.0, ay_g="none", az_g=1.0, temp_c="none")
    recording, report = read_foreign(path)
    assert {*recording.columns} == {"t_us", "gx", "gy", "gz"}
    left_out = [line for line in report.notes if "left out: no number is in it" in line]
    assert [line.split("'")[1] for line in left_out] == ["ay_g", "temp_c", "ax_g", "az_g"]


def test_what_is_no_file_is_said(tmp_path):
    with pytest.raises(BadRecording, match="no such file"):
        read_foreign(tmp_path / "none.csv")
    (tmp_path / "a").write_text("x")
    with pytest.raises(BadRecording, match="a directory"):
        read_foreign(tmp_path / "a" / "b.csv")
    os.mkfifo(tmp_path / "pipe.csv")
    with pytest.raises(BadRecording, match="neither a file nor a folder"):
        import_recording(tmp_path / "pipe.csv", tmp_path / "out.parquet")
    (tmp_path / "empty.csv").touch()
    with pytest.raises(BadRecording, match="empty file"):
        read_foreign(tmp_path / "empty.csv")
