"""A small fleet of simulated devices that all tests of this area run."""

from contextlib import nullcontext

import pytest
from zerorate_tools.fleet import devices_of, fleet, whole_fleet

from host_tests.golden.fleets import write_devices

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
    with pytest.MonkeyPatch.context() as patch:
        run_here(patch)
        return fleet(devices_of([data]), out), out


def run_here(patch):
    """Let this process do the tasks of a fleet, one after the other, without a cluster."""

    def run(client, function, batches):
        return ((batch, function(batch)) for batch in batches)

    for name, instead in (
        ("cluster", lambda *of: nullcontext()),
        ("size_of", lambda client: 1),
        ("run_all", run),
    ):
        patch.setattr(whole_fleet, name, instead)
