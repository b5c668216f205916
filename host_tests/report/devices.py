"""Devices whose loop is closed for the report's tests, as recordings on disk."""

import json
from dataclasses import replace

from zerorate_bench.loop.simulated import simulate
from zerorate_tools.closing import load
from zerorate_tools.loop.report.report import as_json, report
from zerorate_tools.loop.verify.analysis import model_of
from zerorate_tools.loop.verify.run_kernels import run_kernels
from zerorate_tools.model import write_model
from zerorate_tools.recordings import Scales, open_recording
from zerorate_tools.simulate import load_description, simulate_to_files

from host_tests.loop.power_ons import recording, written

SCALES = Scales("MPU-6050", 1.0, 5000.0, 16384.0, 340.0, 36.53)
WITHOUT_TEMP = Scales("MPU-6050", 1.0, 5000.0, 16384.0)
HOSTILE = "<script>"
HOSTILE_FILE = '<img src=x onerror=alert(1)> & "quo\'te" \u202eltr $x$ {{7*7}}'


def device(folder, seed, effects=(), names=None, channel="load", temp=True):
    """Recordings of a device: their paths, one a name."""
    scales = SCALES if temp else WITHOUT_TEMP
    made = zip(names or ("a", "b", "c", "d"), simulate(seed, list(effects)).sessions)
    return written(folder, [replace(recording(s, scales, channel), name=n) for n, s in made])


def bundled(folder, scenario):
    """Recordings of one of the bundled scenarios: their paths."""
    return simulate_to_files(load_description(scenario), folder / "warm.parquet")


class Closed:
    """A closed loop: its recordings, what was found, and the folder with its model."""

    def __init__(self, folder, logs):
        self.folder, self.logs = folder, logs
        found, self.scales = load(logs), open_recording(logs[0]).scales
        model = model_of(found, self.scales)
        self.analysis = run_kernels(found, logs, model, folder / "corrected.parquet", False)
        write_model(model, folder)
        self.result = json.loads(json.dumps(report(self.analysis), default=as_json))
