"""A small fleet of simulated devices that all tests of this area run."""

from contextlib import nullcontext

import numpy as np
import pytest
from zerorate_tools.fleet import devices_of, fleet, whole_fleet
from zerorate_tools.recordings import write_recording
from zerorate_tools.simulate import simulate

DEVICES = 12


def write_devices(folder, minutes, numbers):
    """Write `device=NUMBER/session-1.parquet` for each: a warm-up by 12 degC, at rest."""
    for number in numbers:
        home = folder / f"device={number:05d}"
        home.mkdir(parents=True)
        recording, _ = simulate(_warming(number, minutes))
        write_recording(recording, home / "session-1.parquet")


def _warming(number, minutes):
    """Device `number` of the part, as `zerorate simulate` takes it. Typical of an MPU-6050: devices
    differ in level by far more than in how they follow temperature."""
    rng = np.random.default_rng(number)

    def own(mean, deviation):
        return (np.array(mean) + deviation * rng.standard_normal(3)).tolist()

    start = float(rng.uniform(20, 26))
    return {
        "name": "session-1",
        "seed": number,
        "sensor": {"odr_hz": 25.0, "gyro_noise_dps": 0.05, "gyro_noise_at_hz": 100.0},
        "bias": {
            "b0": own((0.4, -0.9, 0.2), 1.0),
            "b1": own((0.025, -0.018, 0.012), 0.006),
            "b2": own((3e-4, -2e-4, 1e-4), 5e-5),
        },
        "noise": {"bias_instability_dps": 0.002},
        "every_session": {
            "start_degc": start,
            "temperature": [{"to": start + 12.0, "tau_s": 60.0, "minutes": minutes}],
        },
    }


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
