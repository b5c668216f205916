"""Devices whose loop is closed for the report's tests, as recordings on disk."""

import json

import numpy as np
from zerorate_tools.bench.loop.simulated import simulate
from zerorate_tools.closing import load
from zerorate_tools.loop.report.report import as_json, report
from zerorate_tools.loop.verify.measure import measure
from zerorate_tools.loop.verify.slots import model_of
from zerorate_tools.model import write_model
from zerorate_tools.recordings import Recording, Scales, open_recording, write_recording
from zerorate_tools.simulate import load_description, simulate_to_files

SCALES = Scales("MPU-6050", 1.0, 5000.0, 16384.0, 340.0, 36.53)
WITHOUT_TEMP = Scales("MPU-6050", 1.0, 5000.0, 16384.0)
HOSTILE = "<script>"
HOSTILE_FILE = '<img src=x onerror=alert(1)> & "quo\'te" \u202eltr $x$ {{7*7}}'


def recorded(session, name, channel="load", temp=True):
    """A simulated session as one sample a second, its load under a name of choice."""
    ticks = session.blocks * 20
    at = (np.arange(ticks) + 0.5) / 20 - 0.5
    columns = {"t_us": np.arange(ticks, dtype=np.int64) * 1_000_000}
    for axis, rate in zip(("gx", "gy", "gz"), session.rate_dps.T):
        lsb = np.interp(at, np.arange(session.blocks), rate) * SCALES.gyro_lsb_per_dps
        columns[axis] = np.round(lsb).astype(np.int32)
    for axis, g in zip(("ax", "ay", "az"), (0, 0, 16384)):
        columns[axis] = np.full(ticks, g, np.int32) + np.arange(ticks, dtype=np.int32) % 7
    if temp:
        degc = np.repeat(session.sources["temp"], 5)
        columns["temp"] = np.round((degc - 36.53) * 340).astype(np.int32)
    columns[channel] = np.round(np.repeat(session.sources["load"], 5) * 100).astype(np.int32)
    return Recording(columns, SCALES if temp else WITHOUT_TEMP, name)


def device(folder, seed, effects=(), names=None, channel="load", temp=True):
    """Recordings of a device: their paths, one a name."""
    made = simulate(seed, list(effects)).sessions
    paths = [folder / f"{name}.parquet" for name in names or ("a", "b", "c", "d")]
    for path, session in zip(paths, made):
        write_recording(recorded(session, path.stem, channel, temp), path)
    return paths


def bundled(folder, scenario):
    """Recordings of one of the bundled scenarios: their paths."""
    return simulate_to_files(load_description(scenario), folder / "warm.parquet")


class Closed:
    """A closed loop: its recordings, what was found, and the folder with its model."""

    def __init__(self, folder, logs):
        self.folder, self.logs = folder, logs
        found, self.scales = load(logs), open_recording(logs[0]).scales
        model = model_of(found, self.scales)
        self.analysis = measure(found, logs, model, folder / "corrected.parquet")
        write_model(model, folder)
        self.result = json.loads(json.dumps(report(self.analysis), default=as_json))
