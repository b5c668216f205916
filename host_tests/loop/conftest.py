"""A device with hysteresis, closed once for all who look at what came out."""

import pytest
from zerorate_tools.bench.loop.simulated import simulate
from zerorate_tools.closing import close
from zerorate_tools.recordings import write_recording

from .power_ons import recording


@pytest.fixture(scope="session")
def logs(tmp_path_factory):
    folder = tmp_path_factory.mktemp("device")
    paths = []
    for s in simulate(7, [("thermal-hysteresis", 5.0)]).sessions:
        paths.append(folder / f"{s.name}.parquet")
        write_recording(recording(s), paths[-1])
    return paths


@pytest.fixture(scope="session")
def closed(logs, tmp_path_factory):
    folder = tmp_path_factory.mktemp("closed")
    return close(logs, folder, online=True), folder
