"""Recordings are grouped by device as their owner would expect."""

import pytest
from zerorate_tools.errors import ZerorateError
from zerorate_tools.fleet import Device, devices_of
from zerorate_tools.fleet.cluster import in_batches


@pytest.fixture
def folder(tmp_path):
    for name in ("device=b/s2.parquet", "device=b/s10.parquet", "device=a%20b/s.csv", "c.csv.gz"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_bytes(b"x" * 10)
    (tmp_path / "notes.txt").write_text("no recording")
    (tmp_path / ".1.partial.d.parquet").write_bytes(b"half")
    return tmp_path


def names(devices):
    return {d.name: [p.rpartition("/")[2] for p in d.recordings] for d in devices}


def test_a_folder_is_partitioned_by_device(folder):
    wanted = {"a b": ["s.csv"], "b": ["s2.parquet", "s10.parquet"], "c": ["c.csv.gz"]}
    assert names(devices_of([folder])) == wanted


def test_a_pattern_finds_what_a_shell_would(folder):
    assert names(devices_of([f"{folder}/**/s*.parquet"])) == {"b": ["s2.parquet", "s10.parquet"]}


def test_a_recording_named_twice_counts_once(folder):
    both = devices_of([folder / "c.csv.gz", folder / "." / "c.csv.gz"])
    assert names(both) == {"c": ["c.csv.gz"]}


def test_an_expression_names_devices(tmp_path):
    for name in ("imu7_mon.csv", "imu7_tue.csv", "imu8_mon.csv"):
        (tmp_path / name).touch()
    found = names(devices_of([tmp_path], device_from=r"imu(\d+)_"))
    assert found == {"7": ["imu7_mon.csv", "imu7_tue.csv"], "8": ["imu8_mon.csv"]}


@pytest.mark.parametrize(
    "expression, said", [("(", "expression"), ("imu", "no group"), ("(q+)", "finds no")]
)
def test_an_expression_that_cannot_do_it_is_refused(folder, expression, said):
    with pytest.raises(ZerorateError, match=said):
        devices_of([folder / "c.csv.gz"], device_from=expression)


def test_a_place_without_recordings_is_said(tmp_path):
    with pytest.raises(ZerorateError, match="no recording there"):
        devices_of([tmp_path / "*.parquet"])


def test_what_a_run_wrote_is_no_input_of_the_next(folder):
    out = folder / "out"
    (out / "devices").mkdir(parents=True)
    (out / "devices" / "s.replay.parquet").touch()
    assert "s.replay" not in names(devices_of([folder], without=out))


def test_every_device_is_in_one_batch():
    devices = [Device(str(i), ()) for i in range(1000)]
    batches = in_batches(devices, workers=2)
    assert [device for batch in batches for device in batch] == devices
    assert max(map(len, batches)) <= 64
    assert len(in_batches(devices[:20], workers=2)) >= 2


def test_large_recordings_make_small_batches(tmp_path):
    path = tmp_path / "large.parquet"
    with path.open("wb") as file:
        file.truncate(40 << 20)
    devices = [Device(str(i), (str(path),)) for i in range(30)]
    assert {len(batch) for batch in in_batches(devices, workers=1)} == {1}
