"""Simulated sessions as recordings that the firmware can run over."""

import numpy as np
from zerorate_tools.recordings import Recording, Scales

SCALES = Scales("MPU-6050", 1.0, 1310.0, 16384.0, 340.0, 36.53)


def recording(session, scales=SCALES):
    """A simulated session as one raw sample a second, which is one tick."""
    ticks = session.blocks * 20
    at = (np.arange(ticks) + 0.5) / 20 - 0.5
    temp = session.sources["temp"]
    temp = np.interp(np.arange(ticks) / 5, np.arange(len(temp)), temp)
    columns = {"t_us": np.arange(ticks, dtype=np.int64) * 1_000_000}
    for a, name in enumerate(("gx", "gy", "gz")):
        rate = np.interp(at, np.arange(session.blocks), session.rate_dps[:, a])
        columns[name] = np.round(rate * scales.gyro_lsb_per_dps).astype(np.int32)
    for name, g in zip(("ax", "ay", "az"), (0, 0, 16384)):
        columns[name] = g + np.arange(ticks, dtype=np.int32) % 7
    columns["temp"] = np.round((temp - 36.53) * 340).astype(np.int32)
    return Recording(columns, scales, session.name)
