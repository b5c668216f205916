"""How often rows that are readings are taken for those of a resampled log, counted."""

import numpy as np
from scipy.signal import butter, lfilter
from zerorate_tools.importers import read_foreign
from zerorate_tools.importers.samples.resampled import base_period
from zerorate_tools.recordings import Recording

from .public_data import data_folder, recordings, told_of
from .tables import table

KINDS = (
    "white noise",
    "low-pass",
    "coloured",
    "coarse",
    "in motion",
    "smooth motion",
    "with spikes",
)
_ROWS, _DRAWS, _SEED = 2500, 50, 11
_RATIOS = (1.1, 1.3, 1.7, 2.6)


def drawn(kind: str, luck: np.random.Generator, rows: int = _ROWS) -> np.ndarray:
    """(rows, 3) rates of one kind, each a reading of its own, in units of their noise."""
    noise, at = luck.standard_normal((rows, 3)), np.arange(rows)[:, None]
    if kind == "low-pass":
        return lfilter(*butter(2, luck.uniform(0.2, 0.9)), noise, axis=0)
    if kind == "coloured":
        return lfilter([1], [1, -luck.uniform(0.3, 0.98)], noise, axis=0)
    if kind == "coarse":
        return np.rint(luck.uniform(0.3, 3) * noise)
    if kind == "in motion":
        waves = (np.sin(at * luck.uniform(0.01, 0.3) + luck.uniform(0, 6, 3)) for _ in range(4))
        return noise + sum(luck.normal(0, 30, 3) * wave for wave in waves)
    if kind == "smooth motion":
        motion = lfilter(
            *butter(4, luck.uniform(0.03, 0.1)), luck.standard_normal((2 * rows, 3)), axis=0
        )
        loud = np.exp(luck.normal(0, 1.5, 1 + rows // 250)).repeat(250)[:rows, None]
        return 1000 * loud * motion[rows:] + 0.02 * noise
    if kind == "with spikes":
        return noise + 50 * (luck.random((rows, 3)) < 0.02)
    return noise


def on_lines(rates: np.ndarray, ratio: float) -> np.ndarray:
    """The same with so many rows to a reading, on lines between the readings."""
    at = np.arange(0.3, len(rates) - 1, 1 / ratio)
    return np.transpose([np.interp(at, np.arange(len(rates)), axis) for axis in rates.T])


def digits(kind: str) -> np.ndarray:
    return np.full(3, 1.0 if kind == "coarse" else 1e-4)


def false_alarms() -> str:
    """A table: by kind of rows, how many logs there are, how many are refused as resampled, and
    how many are once they are resampled."""
    rows = []
    for kind in KINDS:
        luck, found = np.random.default_rng(_SEED), []
        for n in range(_DRAWS):
            rates = drawn(kind, luck)
            lines = on_lines(rates, _RATIOS[n % len(_RATIOS)])
            found.append([base_period(timed(some), digits(kind)) > 0 for some in (rates, lines)])
        rows.append([kind, len(found), *np.sum(found, axis=0).tolist()])
    if folder := data_folder():
        real = [read_foreign(path, **told_of(path))[0] for path in recordings(folder)]
        refused = sum(base_period(*of_a_recording(one)) > 0 for one in real)
        rows.append(["real recordings", len(real), refused, ""])
    return table(["rows", "logs", "refused", "refused once resampled"], rows)


def timed(rates: np.ndarray) -> np.ndarray:
    return np.vstack([np.arange(len(rates)), rates.T])


def of_a_recording(recording: Recording) -> tuple[np.ndarray, np.ndarray]:
    """(4, n) times and rates of its beginning, and their digits."""
    frame = np.vstack([recording.columns["t_us"], recording.gyro_dps().T])[:, :65536]
    return frame, np.full(3, 1 / recording.scales.gyro_lsb_per_dps)
