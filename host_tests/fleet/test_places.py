"""Recordings in a store of objects: the fleet reads them there as it does from a disk."""

import json
from pathlib import Path

import pytest
from zerorate_tools.cli import main
from zerorate_tools.errors import ZerorateError
from zerorate_tools.fleet import devices_of, fleet
from zerorate_tools.fleet.places import here, size_and_change, urls_of
from zerorate_tools.recordings import read_recording, write_recording

from .conftest import DEVICES


@pytest.fixture
def s3(monkeypatch):
    """s3://fleet, on this machine."""
    moto, s3fs = pytest.importorskip("moto.server"), pytest.importorskip("s3fs")
    server = moto.ThreadedMotoServer("127.0.0.1", 0, verbose=False)
    server.start()
    host, port = server.get_host_and_port()
    monkeypatch.setenv("AWS_ENDPOINT_URL", f"http://{host}:{port}")
    monkeypatch.setenv("AWS_DEFAULT_REGION", "us-east-1")
    for name in ("AWS_ACCESS_KEY_ID", "AWS_SECRET_ACCESS_KEY"):
        monkeypatch.setenv(name, "any")
    s3fs.S3FileSystem.clear_instance_cache()
    yield s3fs.S3FileSystem()
    s3fs.S3FileSystem.clear_instance_cache()
    server.stop()


@pytest.fixture
def gs(monkeypatch):
    """gs://fleet, on this machine."""
    # before its import: what asks a second service, over gRPC, for the kind of a bucket
    monkeypatch.setenv("GCSFS_EXPERIMENTAL_ZB_HNS_SUPPORT", "false")
    emulator = pytest.importorskip("gcp_storage_emulator.server")
    gcsfs = pytest.importorskip("gcsfs")
    server = emulator.create_server("127.0.0.1", 0, in_memory=True)
    server.start()
    host, port = server._api._httpd.server_address
    monkeypatch.setenv("STORAGE_EMULATOR_HOST", f"http://{host}:{port}")
    gcsfs.GCSFileSystem.clear_instance_cache()
    yield gcsfs.GCSFileSystem(token="anon")
    gcsfs.GCSFileSystem.clear_instance_cache()
    server.stop()


def test_a_folder_of_s3_gives_what_the_disk_gives(s3, data, done, tmp_path, capsys):
    s3.makedirs("fleet", exist_ok=True)  # a new server of this process has the same memory
    s3.put(str(data), "fleet/data", recursive=True)
    first = next(data.rglob("*.parquet"))
    write_recording(read_recording(first), tmp_path / "run.csv")
    beside = f"fleet/data/{first.parent.name}"
    s3.rm(f"{beside}/{first.name}")
    s3.put([str(tmp_path / "run.csv"), str(tmp_path / "run.json")], f"{beside}/")
    folder, out = "s3://fleet/data", tmp_path / "out"
    words = ["fleet", folder, "--out", str(out), "--workers", "2", "--minutes", "1.5"]
    assert main(words) == 0
    report = json.loads((out / "fleet.json").read_text())
    assert (report["devices"], report["failures"]) == (DEVICES, [])
    assert report["effects"] == done[0].report["effects"]
    assert report["prior"]["benefit"] == done[0].report["prior"]["benefit"]
    assert main(words) == 0  # and does nothing again
    s3.rm(f"{beside}/run.csv")
    assert len(devices_of([f"{folder}/*/*.parquet"])) == DEVICES - 1


def test_a_file_of_gs_is_found_copied_and_seen_to_change(gs, tmp_path):
    gs.mkdir("fleet")
    gs.pipe({"fleet/a/run.csv": b"t_us\n", "fleet/a/run.json": b"{}", "fleet/a/note.txt": b""})
    (url,) = urls_of("gs://fleet/a")
    assert url == "gs://fleet/a/run.csv"
    with here(url, tmp_path) as copy:
        assert Path(copy).read_bytes() == b"t_us\n"
        assert Path(copy).with_name("run.json").read_bytes() == b"{}"
    before = size_and_change(url)
    gs.pipe("fleet/a/run.csv", b"t_us,gx\n")
    type(gs).clear_instance_cache()  # as in another run
    assert size_and_change(url) != before


def test_a_store_whose_package_is_missing_names_it():
    with pytest.raises(ZerorateError, match="^abfs://fleet/x: .*: pip install adlfs$"):
        devices_of(["abfs://fleet/x"])


@pytest.mark.parametrize("store", ["s3", "gs"])
def test_what_the_store_does_not_have_is_said(store, request):
    request.getfixturevalue(store)
    for url in (f"{store}://fleet/nothing", f"{store}://nobody/x", "no-such-store://x/y"):
        with pytest.raises(ZerorateError, match=f"^{url}: "):
            devices_of([url])


def test_results_are_written_to_a_disk(s3, data, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ZerorateError, match="a folder of this machine"):
        fleet(devices_of([data]), "s3://fleet/out")
    with pytest.raises(SystemExit):
        main(["fleet", str(data), "--out", "s3://fleet/out"])
    assert "no folder of this machine" in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []
