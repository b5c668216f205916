"""Small steps of an import, each against a plain reading of what it says."""

import zipfile
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
from hypothesis import given
from hypothesis import strategies as st
from zerorate_tools.errors import ZerorateError
from zerorate_tools.importers import parsed_mapping, read_foreign
from zerorate_tools.importers.columns.guesses import likely_columns
from zerorate_tools.importers.columns.names import accel_groups, most_alike
from zerorate_tools.importers.logs import columnar
from zerorate_tools.importers.logs.messages import table_of_messages
from zerorate_tools.importers.samples.between import _spans

times = st.lists(st.integers(-1000, 1000), min_size=1, max_size=20)


@given(times, times)
def test_a_span_is_that_between_the_readings_around_a_time(t_us, at):
    at = sorted(set(at))
    found = _spans(np.array(t_us, float), np.array(at, float))
    for t, span in zip(t_us, found):
        later = [other for other in at if other >= t]
        earlier = [other for other in at if other < t]
        assert span == (later or [t])[0] - (earlier or [t])[-1]


@pytest.mark.parametrize(
    ("gyro", "instance", "chosen"),
    [
        ("imu2/gyro_x", 0, "imu2/acc_x"),  # the most alike, whichever is asked for
        ("imu1/gyro_x", 1, "imu1/acc_x"),
        ("wx", 0, "imu1/acc_x"),  # of those alike, the one of the same number
        ("wx", 1, "imu2/acc_x"),
        ("wx", 7, "imu1/acc_x"),  # of which there is none: the first
    ],
)
def test_the_acceleration_beside_rates_is_the_one_most_alike(gyro, instance, chosen):
    names = [f"{imu}/acc_{axis}" for imu in ("imu1", "imu2") for axis in "xyz"]
    assert most_alike(accel_groups(names), {"gx": gyro}, instance)["ax"] == chosen


@pytest.mark.parametrize(("unit", "ns"), [("s", 10**9), ("ms", 10**6), ("us", 1000), ("ns", 1)])
def test_dates_of_any_unit_are_seconds_since_1970(tmp_path, unit, ns):
    counts = [0, 1, 10**18 // ns, -(10**9) // ns]
    path = tmp_path / "in.parquet"
    pq.write_table(pa.table({"at": pa.array(counts, pa.timestamp(unit))}), path)
    (chunk,) = columnar.read(path).chunks(["at"])
    assert chunk.columns["at"].tolist() == [count * ns * 1e-9 for count in counts]


def stamped(**stamp):
    """A message of an IMU whose header has that stamp."""
    vector = SimpleNamespace(x=1.0, y=2.0, z=3.0)
    return SimpleNamespace(
        header=SimpleNamespace(stamp=SimpleNamespace(**stamp)),
        angular_velocity=vector,
        linear_acceleration=vector,
    )


@pytest.mark.parametrize(
    ("message", "t_us"),
    [
        (stamped(sec=3, nanosec=5000), 3000005.0),
        (stamped(sec=3, nsec=5000), 3000005.0),
        (stamped(sec=0, nanosec=5000), 5.0),
        (stamped(sec=3, nanosec=0), 3000000.0),
        (stamped(sec=0, nanosec=0), 7.0),  # no clock was set: when it was logged
        (stamped(sec=3), 7.0),
        (stamped(nanosec=5), 7.0),
        ({"angular_velocity": {"x": 1.0, "y": 2.0, "z": 3.0}}, 7.0),
    ],
)
def test_a_message_without_a_whole_stamp_has_the_time_when_it_was_logged(message, t_us):
    logged = [("/imu", 7000, lambda: message)]
    table = table_of_messages(Path("bag"), {"/imu": "sensor_msgs/Imu"}, lambda: iter(logged))
    (chunk,) = table.chunks(table.names)
    assert chunk.columns["t_us"].tolist() == [t_us]
    assert chunk.columns["/imu/angular_velocity/z"].tolist() == [3.0]


@pytest.mark.parametrize(("constant", "is_rate"), [(0.0, True), (0.5, True), (2.0, False)])
def test_a_whole_number_that_stays_is_of_a_kind_of_line_and_no_rate(constant, is_rate):
    noise = np.random.default_rng(1).normal(0, 20, (2, 50))
    columns = {"a": np.arange(50) * 0.01, "b": noise[0], "c": noise[1], "d": np.full(50, constant)}
    assert bool(likely_columns(columns)) == is_rate


def unnamed(draw):
    """Columns that nothing names, in any order of their groups, and what each group is."""
    random = np.random.default_rng(draw(st.integers(0, 1000)))
    n, force = 60, draw(st.sampled_from([1.0, 9.80665]))
    up = np.sin(np.linspace(0, 9, n)) * draw(st.floats(0.5, 1.5))
    # no two of the three are as long as gravity
    accel = force * (1 / np.sqrt(3) + 0.02 * np.array([up, -up, 0 * up]))
    accel += random.normal(0, force / 50, (3, n))
    rates = random.normal(0, 0.5 if force > 2 else 60.0, (3, n))
    turn = np.array([np.cos(up / 2), np.sin(up / 2), 0 * up, 0 * up])
    unit, count = draw(st.sampled_from([("s", 0.01), ("ms", 10.0), ("us", 10_000.0), ("ns", 1e7)]))
    begin = draw(st.sampled_from([0.0, 1e9, 1.7e9])) * 0.01 / count if unit == "ns" else 0.0
    groups = {"t": [begin + np.arange(n) * count], "a": accel, "g": rates}
    if draw(st.booleans()):
        groups["q"] = turn
    if draw(st.booleans()):
        groups["k"] = [np.full(n, float(draw(st.sampled_from([1, 7, -3]))))]
    order = draw(st.permutations(sorted(groups)))
    return unit, force, {f"{g}{i}": v for g in order for i, v in enumerate(groups[g])}, order


@given(st.data())
def test_columns_that_nothing_names_are_told_by_their_values(data):
    unit, force, columns, order = unnamed(data.draw)
    gyro_first = order.index("g") < order.index("a")
    found = likely_columns(columns)
    accel, rate = ("g", "dps") if force == 1.0 else ("m/s2", "rad/s")
    wanted = [f"t_us=t0:{unit}"]
    wanted += [f"{axis}=a{i}:{accel}" for i, axis in enumerate(("ax", "ay", "az"))]
    wanted += [f"{axis}=g{i}:{rate}" for i, axis in enumerate(("gx", "gy", "gz"))]
    assert found == wanted, (order, gyro_first)


def test_columns_that_are_whole_in_no_row_are_taken_for_nothing():
    rows = np.arange(99)
    columns = {name: np.where(rows % 3 == n, np.nan, rows) for n, name in enumerate("abc")}
    assert likely_columns(columns) == []


@pytest.mark.parametrize("at", range(0, 400, 8))
def test_any_damage_of_a_zip_is_said_in_one_line(tmp_path, at):
    path = tmp_path / "in.zip"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as packed:
        packed.writestr("run.csv", "t_s,gx_dps,gy_dps,gz_dps\n" + "0.1,1,2,3\n" * 99)
    content = bytearray(path.read_bytes())
    content[at % len(content)] ^= 0xB5
    path.write_bytes(content)
    with pytest.raises(ZerorateError) as caught:
        read_foreign(path)
    assert "\n" not in str(caught.value)


def polled(every, rows=3000, lsb_dps=0.02, **more):
    """A rest of 0.05 dps of noise, each reading written some times, on a scale of such steps."""
    rng = np.random.default_rng(5)
    readings = np.rint(rng.normal(0.8, 0.05, (3, rows // every + 1)) / lsb_dps) * lsb_dps
    columns = {"t_s": np.arange(rows) * 0.005, **more}
    rates = np.repeat(readings, every, axis=1)[:, :rows]
    return pd.DataFrame(columns | dict(zip(("gx_dps", "gy_dps", "gz_dps"), rates)))


@pytest.mark.parametrize("every", [2, 4])
def test_a_sensor_read_faster_than_it_measures_has_each_reading_once(tmp_path, every):
    path, count = tmp_path / "in.csv", np.arange(3000)
    polled(every, lsb_dps=0.002, other=count).to_csv(path, index=False)
    recording, report = read_foreign(path, mapping=[parsed_mapping("other=other")])
    assert len(recording) == pytest.approx(3000 / every, rel=0.01)
    assert recording.scales.odr_hz == pytest.approx(200 / every)
    assert any("faster than the sensor measures" in reason for reason in report.dropped)
    assert np.array_equal(recording.columns["other"], recording.columns["t_us"] // 5000)


@pytest.mark.parametrize("lsb_dps", [0.002, 0.06, 0.2])
def test_readings_that_are_alike_by_chance_or_by_a_coarse_scale_are_all_kept(tmp_path, lsb_dps):
    path = tmp_path / "in.csv"
    polled(1, lsb_dps=lsb_dps).to_csv(path, index=False)
    assert len(read_foreign(path)[0]) == 3000
