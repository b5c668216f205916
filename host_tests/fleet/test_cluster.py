"""Workers and stores of others: what fails is named, and nothing waits for ever."""

import json
import os
import signal
import subprocess
import sys
import textwrap
import threading
import time
from pathlib import Path

import pytest
from distributed import Client
from zerorate_tools.cli import main
from zerorate_tools.errors import MissingLibrary, ZerorateError
from zerorate_tools.fleet import devices_of, fleet
from zerorate_tools.fleet.cluster import _safe_path, cluster, run_all
from zerorate_tools.fleet.devices import here, size_and_change, urls_of
from zerorate_tools.recordings import read_recording, write_recording

from .conftest import DEVICES, run_here

#: What a machine has on which nobody installed zerorate.
WITHOUT_ZERORATE = """
import sys
from functools import partial
from pathlib import Path
sys.path[:] = [p for p in sys.path if not (Path(p) / "zerorate_tools").exists()]
sys.meta_path[:] = [f for f in sys.meta_path if "editable" not in str(f)]
"""


class Cluster:
    """A scheduler and workers as one starts them by hand, each a process."""

    def __init__(self, folder):
        self.folder, self.processes = folder, []
        address = folder / "scheduler.json"
        self._start("scheduler", "--port", "0", "--no-dashboard", "--scheduler-file", address)
        self.client = Client(scheduler_file=str(address), timeout=60)
        self.address = self.client.scheduler.address

    def _start(self, *words, **environment):
        command = [sys.executable, "-m", "distributed.cli.dask_" + words[0], *map(str, words[1:])]
        environment = {**os.environ, **environment}
        log = open(self.folder / "log", "a")
        started = subprocess.Popen(command, env=environment, stdout=log, stderr=log)
        self.processes.append(started)
        return started

    def worker(self, **environment):
        """Start one of one thread and no nanny; returns (the process, its address)."""
        before = set(self.client.nthreads())
        words = ("--nthreads", "1", "--no-nanny", "--no-dashboard", "--death-timeout", "60")
        started = self._start("worker", self.address, *words, **environment)
        self.client.wait_for_workers(len(before) + 1, timeout=60)
        return started, (set(self.client.nthreads()) - before).pop()

    def end(self):
        self.client.close()
        for process in self.processes:
            process.kill()
            process.wait()


@pytest.fixture
def others(tmp_path, monkeypatch):
    """A cluster without workers, which is given up sooner than a user's."""
    monkeypatch.setattr("zerorate_tools.fleet.cluster._CONNECT_S", 4)
    cluster = Cluster(tmp_path)
    yield cluster
    cluster.end()


def test_a_worker_without_zerorate_is_named(others, data, tmp_path):
    (tmp_path / "site").mkdir()
    (tmp_path / "site" / "sitecustomize.py").write_text(textwrap.dedent(WITHOUT_ZERORATE))
    others.worker()
    _, bare = others.worker(PYTHONPATH=str(tmp_path / "site"))
    with pytest.raises(ZerorateError, match=f"worker {bare} lacks zerorate_tools; pip install"):
        fleet(devices_of([data]), tmp_path / "out", scheduler=others.address)
    assert not (tmp_path / "out").exists()


def test_a_worker_that_stands_still_is_named(others, data, tmp_path):
    process, address = others.worker()
    process.send_signal(signal.SIGSTOP)
    with pytest.raises(ZerorateError, match=f"worker {address} does not answer"):
        fleet(devices_of([data]), tmp_path / "out", scheduler=others.address)


def test_a_worker_that_is_busy_for_long_is_no_fault(others, data, tmp_path):
    others.worker()
    busy = others.client.submit(time.sleep, 5, pure=False)
    done = fleet(devices_of([data])[:1], tmp_path / "out", scheduler=others.address, minutes=None)
    assert done.report["sessions"] == 1 and busy.done()


@pytest.mark.parametrize(
    ("victim", "by"),
    [("worker", signal.SIGKILL), ("scheduler", signal.SIGKILL), ("scheduler", signal.SIGSTOP)],
)
def test_when_all_workers_or_the_scheduler_die_it_says_so(others, data, tmp_path, victim, by):
    process, address = others.worker()
    named, process = {
        "worker": (f"its workers are gone .{address}", process),
        "scheduler": (f"{others.address}: the scheduler is gone", others.processes[0]),
    }[victim]
    others.client.submit(time.sleep, 60, pure=False)  # so that the fleet's tasks wait
    died_s = []

    def die():
        tasks = lambda dask_scheduler: len(dask_scheduler.tasks)  # noqa: E731
        while others.client.run_on_scheduler(tasks) < 2:
            time.sleep(0.1)
        process.send_signal(by)
        died_s.append(time.monotonic())

    threading.Thread(target=die).start()
    with pytest.raises(ZerorateError, match=named):
        fleet(devices_of([data]), tmp_path / "out", scheduler=others.address, minutes=None)
    assert time.monotonic() - died_s[0] < 15


def test_without_a_cache_it_runs_and_says_so_once(data, tmp_path):
    home = tmp_path / "not a folder"
    home.write_text("")
    environment = {name: text for name, text in os.environ.items() if name != "XDG_CACHE_HOME"}
    environment.update(HOME=str(home), ZERORATE_CACHE="")
    folders = sorted(str(path.parent) for path in data.rglob("*.parquet"))[:2]
    command = [sys.executable, "-m", "zerorate_tools.cli", "fleet", *folders, "--workers", "1"]
    command += ["--out", str(tmp_path / "out"), "--minutes", "1"]
    ran = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    assert ran.stderr.count("no cache can be kept (Not a directory)") == 1
    report = json.loads((tmp_path / "out" / "fleet.json").read_text())
    assert (report["devices"], report["failures"]) == (2, [])


def test_without_dask_nothing_is_left_behind(data, tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "dask", None)
    with pytest.raises(MissingLibrary):
        fleet(devices_of([data]), tmp_path / "out")
    assert not (tmp_path / "out").exists()


def double_or_die(batch):
    if "die" in batch:
        os._exit(1)
    return [2 * item for item in batch]


@pytest.mark.parametrize("before", [None, "0"])
def test_the_callers_environment_is_afterwards_as_it_was(before, monkeypatch):
    monkeypatch.delenv("PYTHONSAFEPATH", raising=False)
    if before is not None:
        monkeypatch.setenv("PYTHONSAFEPATH", before)
    with pytest.raises(KeyError), _safe_path():
        assert os.environ["PYTHONSAFEPATH"] == "1"
        raise KeyError
    assert os.environ.get("PYTHONSAFEPATH") == before


def test_a_batch_whose_worker_dies_costs_only_the_item_that_killed_it(monkeypatch):
    import distributed

    monkeypatch.setattr("zerorate_tools.fleet.cluster.MOST_WAITING", 3)
    batches = [["a", "die", "b"], *([letter] for letter in "cdefghij")]
    with cluster(workers=1) as client:
        results = {tuple(b): result for b, result in run_all(client, double_or_die, batches)}
    died = results.pop(("die",))
    assert isinstance(died, distributed.scheduler.KilledWorker)
    assert results == {(letter,): [2 * letter] for letter in "abcdefghij"}


@pytest.mark.parametrize(("asked", "start"), [(None, 2), (1, 1), (10**8, 2)])
def test_at_most_all_cores_work(monkeypatch, asked, start):
    def started(_, workers):
        raise ZerorateError(f"{workers} start")

    monkeypatch.setattr("zerorate_tools.fleet.cluster._started", started)
    monkeypatch.setattr("os.cpu_count", lambda: 2)
    with pytest.raises(ZerorateError, match=f"^{start} start"), cluster(workers=asked):
        pass


def test_a_scheduler_that_does_not_answer_is_said(data, tmp_path, monkeypatch):
    monkeypatch.setattr("zerorate_tools.fleet.cluster._CONNECT_S", 0.2)
    with pytest.raises(ZerorateError, match="no Dask scheduler answers"):
        fleet(devices_of([data])[:1], tmp_path, scheduler="tcp://127.0.0.1:9")


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


def test_a_folder_of_s3_gives_what_the_disk_gives(s3, data, done, tmp_path, capsys, monkeypatch):
    run_here(monkeypatch)
    s3.makedirs("fleet", exist_ok=True)  # a new server of this process has the same memory
    s3.put(str(data), "fleet/data", recursive=True)
    first = next(data.rglob("*.parquet"))
    write_recording(read_recording(first), tmp_path / "run.csv")
    beside = f"fleet/data/{first.parent.name}"
    s3.rm(f"{beside}/{first.name}")
    s3.put([str(tmp_path / "run.csv"), str(tmp_path / "run.json")], f"{beside}/")
    folder, out = "s3://fleet/data", tmp_path / "out"
    words = ["fleet", folder, "--out", str(out), "--minutes", "1.5"]
    assert main(words) == 0
    report = json.loads((out / "fleet.json").read_text())
    assert (report["devices"], report["failures"]) == (DEVICES, [])
    assert report["effects"] == done[0].report["effects"]
    assert report["prior"]["benefit"] == done[0].report["prior"]["benefit"]
    s3.rm(f"{beside}/run.csv")
    assert len(devices_of([f"{folder}/*/*.parquet"])) == DEVICES - 1


def test_a_file_of_gs_is_found_copied_and_seen_to_change(gs, tmp_path):
    gs.mkdir("fleet")
    found_copied_and_changed(gs, "gs://fleet/a", tmp_path)


def test_a_store_in_memory_is_searched_like_any(tmp_path):
    import fsspec

    found_copied_and_changed(fsspec.filesystem("memory"), "memory:///fleet/a", tmp_path)
    for url in ("memory://fleet/*/run.csv", "memory://fleet/a/run.csv"):
        assert urls_of(url) == ["memory:///fleet/a/run.csv"]
    with here("memory:///fleet/b/run.parquet", tmp_path) as copy:
        assert sorted(p.name for p in Path(copy).parent.iterdir()) == ["run.parquet"]
    assert size_and_change("memory://fleet/none.csv") == (0, "")
    with pytest.raises(ZerorateError, match="memory://nobody: no recording there"):
        devices_of(["memory://nobody"])


def found_copied_and_changed(store, folder, tmp_path):
    """Of a store's folder the one recording is found, comes with its scales, and may change."""
    text = {"a/run.csv": b"t_us\n", "a/run.json": b"{}", "a/note.txt": b""}
    text |= {"b/run.parquet": b"PAR1", "b/run.json": b"{}"}
    store.pipe({f"fleet/{name}": content for name, content in text.items()})
    (url,) = urls_of(folder)
    assert url == f"{folder}/run.csv"
    with here(url, tmp_path) as copy:
        assert Path(copy).read_bytes() == b"t_us\n"
        assert Path(copy).with_name("run.json").read_bytes() == b"{}"
    assert list(tmp_path.iterdir()) == [] and size_and_change(url)[0] == 5
    before = size_and_change(url)
    store.pipe("fleet/a/run.csv", b"t_us,gx\n")
    type(store).clear_instance_cache()  # as in another run
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
