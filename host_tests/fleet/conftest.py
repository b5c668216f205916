"""A small fleet of simulated devices that all tests of this area run."""

import pytest
from distributed import LocalCluster
from zerorate_bench.fleet import write_devices
from zerorate_tools.fleet import devices_of, fleet

DEVICES = 12


@pytest.fixture(scope="session")
def data(tmp_path_factory):
    """A data set partitioned by device, a minute and a half each."""
    folder = tmp_path_factory.mktemp("fleet") / "data"
    write_devices(folder, 1.5, range(DEVICES))
    return folder


@pytest.fixture(scope="session")
def done(data, tmp_path_factory):
    """(what came of running it, the folder with what was written)."""
    out = tmp_path_factory.mktemp("fleet") / "out"
    return fleet(devices_of([data]), out, workers=2, minutes=1.5), out


@pytest.fixture(scope="module")
def scheduler():
    """The address of a cluster of one worker, which starts once: it imports for seconds.

    It ends with the file, for its threads would see what other tests put in the place of the clock.
    """
    with LocalCluster(n_workers=1, threads_per_worker=1, dashboard_address="127.0.0.1:0") as there:
        yield there.scheduler_address
        assert len(there.workers) == 1
