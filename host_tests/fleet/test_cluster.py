"""A Dask cluster of others: a worker that cannot work is named, and nothing waits for ever."""

import os
import signal
import subprocess
import sys
import textwrap
import threading
import time

import pytest
from distributed import Client
from zerorate_tools.errors import ZerorateError
from zerorate_tools.fleet import devices_of, fleet
from zerorate_tools.fleet.cluster import _workers_of

#: What a machine has on which nobody installed zerorate.
WITHOUT_ZERORATE = """
import sys
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
def others(tmp_path):
    """A cluster without workers."""
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
    busy = others.client.submit(time.sleep, 12, pure=False)
    done = fleet(devices_of([data])[:1], tmp_path / "out", scheduler=others.address, minutes=None)
    assert done.report["sessions"] == 1 and busy.done()


@pytest.mark.parametrize("victim", ["worker", "scheduler"])
def test_when_all_workers_or_the_scheduler_die_it_says_so(others, data, tmp_path, victim):
    process, address = others.worker()
    killed = process if victim == "worker" else others.processes[0]
    others.client.submit(time.sleep, 60, pure=False)  # so that the fleet's tasks wait
    threading.Timer(2, killed.kill).start()
    with pytest.raises(ZerorateError, match=address if victim == "worker" else others.address):
        fleet(devices_of([data]), tmp_path / "out", scheduler=others.address, minutes=None)


def test_a_scheduler_that_dies_while_it_is_asked_has_no_workers():
    class Dying:
        status = "running"

        def nthreads(self):
            raise OSError("Timed out trying to connect")

    assert _workers_of(Dying()) == []
