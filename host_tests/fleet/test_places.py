"""Recordings in a store of objects: the fleet reads them there as it does from a disk."""

import json

import pytest
from zerorate_tools.cli import main
from zerorate_tools.errors import ZerorateError
from zerorate_tools.fleet import devices_of, fleet
from zerorate_tools.recordings import read_recording, write_recording

from .conftest import DEVICES

moto = pytest.importorskip("moto.server")
s3fs = pytest.importorskip("s3fs")


@pytest.fixture
def store(monkeypatch):
    """s3://fleet, on this machine."""
    server = moto.ThreadedMotoServer("127.0.0.1", 0, verbose=False)
    server.start()
    host, port = server.get_host_and_port()
    monkeypatch.setenv("AWS_ENDPOINT_URL", f"http://{host}:{port}")
    monkeypatch.setenv("AWS_DEFAULT_REGION", "us-east-1")
    for name in ("AWS_ACCESS_KEY_ID", "AWS_SECRET_ACCESS_KEY"):
        monkeypatch.setenv(name, "any")
    s3fs.S3FileSystem.clear_instance_cache()
    there = s3fs.S3FileSystem()
    there.makedirs("fleet", exist_ok=True)  # a new server of this process has the same memory
    yield there
    s3fs.S3FileSystem.clear_instance_cache()
    server.stop()


def test_a_folder_of_s3_gives_what_the_disk_gives(store, data, done, tmp_path, capsys):
    store.put(str(data), "fleet/data", recursive=True)
    first = next(data.rglob("*.parquet"))
    write_recording(read_recording(first), tmp_path / "run.csv")
    beside = f"fleet/data/{first.parent.name}"
    store.rm(f"{beside}/{first.name}")
    store.put([str(tmp_path / "run.csv"), str(tmp_path / "run.json")], f"{beside}/")
    out = tmp_path / "out"
    words = ["fleet", "s3://fleet/data", "--out", str(out), "--workers", "2", "--minutes", "1.5"]
    assert main(words) == 0
    report = json.loads((out / "fleet.json").read_text())
    assert (report["devices"], report["failures"]) == (DEVICES, [])
    assert report["effects"] == done[0].report["effects"]
    assert report["prior"]["benefit"] == done[0].report["prior"]["benefit"]
    assert main(words) == 0  # and does nothing again
    store.rm(f"{beside}/run.csv")
    assert len(devices_of(["s3://fleet/data/*/*.parquet"])) == DEVICES - 1


def test_what_the_store_does_not_have_is_said(store, tmp_path):
    for url in ("s3://fleet/nothing", "s3://nobody/x", "no-such-store://x/y"):
        with pytest.raises(ZerorateError, match=f"^{url}: "):
            devices_of([url])


def test_results_are_written_to_a_disk(store, data, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ZerorateError, match="a folder of this machine"):
        fleet(devices_of([data]), "s3://fleet/out")
    with pytest.raises(SystemExit):
        main(["fleet", str(data), "--out", "s3://fleet/out"])
    assert "no folder of this machine" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []
