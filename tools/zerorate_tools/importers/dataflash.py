"""ArduPilot DataFlash (.bin, .log): the IMU messages of one instance."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ..errors import BadRecording, MissingLibrary
from .foreign import Foreign
from .units import ACCEL_G, RATE_DPS

_FIELDS = ("TimeUS", "GyrX", "GyrY", "GyrZ", "AccX", "AccY", "AccZ", "T")


def read_dataflash(path: Path, instance: int = 0) -> Foreign:
    """One instance's samples; its temperature is T. Raises BadRecording, MissingLibrary."""
    try:
        from pymavlink import DFReader
    except ImportError as error:
        raise MissingLibrary("pymavlink") from error
    text = path.suffix.lower() == ".log"
    reader = DFReader.DFReader_text if text else DFReader.DFReader_binary
    try:
        rows = _rows(reader(str(path)), instance)
    except Exception as error:  # the reader raises whatever its parser stumbles over
        problem = f"no DataFlash log: {error}"
        raise BadRecording(path, problem, do="copy the file again") from error
    if not len(rows):
        do = "log IMU (LOG_BITMASK), or try --instance"
        raise BadRecording(path, f"no IMU message of instance {instance}", do=do)
    foreign = Foreign(
        time_s=rows[:, 0] * 1e-6,
        gyro=rows[:, 1:4] * RATE_DPS["rad/s"],
        accel=rows[:, 4:7] * ACCEL_G["m/s2"],
        temp=rows[:, 7] if np.isfinite(rows[:, 7]).any() else None,
        sensor="ArduPilot",
    )
    foreign.notes.append("DataFlash holds rates after the autopilot's own offsets (INS_GYROFFS)")
    return foreign


def _rows(log: Any, instance: int) -> np.ndarray:
    rows = []
    while (message := log.recv_match(type=["IMU", "IMU2", "IMU3"])) is not None:
        number = getattr(message, "I", None)
        if number is None:
            number = {"IMU": 0, "IMU2": 1, "IMU3": 2}[message.get_type()]
        if number == instance:
            rows.append([getattr(message, name, np.nan) for name in _FIELDS])
    return np.array(rows, float).reshape(-1, len(_FIELDS))
