"""Simulated devices of one part: a common curve over temperature, and what is each one's own."""

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np

from ...recordings import write_recording
from ...simulate import simulate

#: Typical of an MPU-6050: devices differ in level by far more than in how they follow temperature.
LEVEL_DPS, LEVEL_DEVIATION_DPS = (0.4, -0.9, 0.2), 1.0
SLOPE_DPS_PER_DEGC, SLOPE_DEVIATION = (0.025, -0.018, 0.012), 0.006
BEND_DPS_PER_DEGC2, BEND_DEVIATION = (3e-4, -2e-4, 1e-4), 5e-5
MINUTES = 3.0
ODR_HZ = 25.0


def write_devices(folder: Path, minutes: float, numbers: Iterable[int]) -> None:
    """Write `device=NUMBER/session-1.parquet` for each: a warm-up by 12 degC, at rest."""
    for number in numbers:
        home = folder / f"device={number:05d}"
        home.mkdir(parents=True)
        recording, _ = simulate(description(number, minutes))
        write_recording(recording, home / "session-1.parquet")


def description(number: int, minutes: float = MINUTES) -> dict[str, Any]:
    """Device `number` of the part, as `zerorate simulate` takes it."""
    rng = np.random.default_rng(number)

    def own(mean: tuple[float, ...], deviation: float) -> list[float]:
        return (np.array(mean) + deviation * rng.standard_normal(3)).tolist()

    start = float(rng.uniform(20, 26))
    return {
        "name": "session-1",
        "seed": number,
        "sensor": {"odr_hz": ODR_HZ, "gyro_noise_dps": 0.05, "gyro_noise_at_hz": 100.0},
        "bias": {
            "b0": own(LEVEL_DPS, LEVEL_DEVIATION_DPS),
            "b1": own(SLOPE_DPS_PER_DEGC, SLOPE_DEVIATION),
            "b2": own(BEND_DPS_PER_DEGC2, BEND_DEVIATION),
        },
        "noise": {"bias_instability_dps": 0.002},
        "every_session": {
            "start_degc": start,
            "temperature": [{"to": start + 12.0, "tau_s": 60.0, "minutes": minutes}],
        },
    }
