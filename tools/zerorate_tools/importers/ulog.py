"""PX4 ULog: sensor_gyro with the nearest sensor_accel, or sensor_combined."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ..errors import BadRecording, MissingLibrary
from .foreign import Foreign
from .units import ACCEL_G, RATE_DPS

_TOPICS = ["sensor_gyro", "sensor_accel", "sensor_combined"]


def read_ulog(path: Path, instance: int = 0) -> Foreign:
    """One instance's samples. Raises BadRecording, MissingLibrary."""
    try:
        from pyulog import ULog
    except ImportError as error:
        raise MissingLibrary("pyulog") from error
    try:
        log = ULog(str(path), message_name_filter_list=_TOPICS)
    except Exception as error:  # pyulog raises whatever its parser stumbles over
        raise BadRecording(path, f"no ULog: {error}", do="copy the file again") from error
    gyro = _topic(log, "sensor_gyro", instance)
    if gyro is not None:
        foreign = _from_single_sensors(gyro, _topic(log, "sensor_accel", instance))
    else:
        combined = _topic(log, "sensor_combined", instance)
        if combined is None:
            problem = f"neither sensor_gyro nor sensor_combined, instance {instance}"
            raise BadRecording(path, problem, do="log them (SDLOG_PROFILE), or try --instance")
        foreign = _from_combined(combined)
    foreign.sensor = str(log.msg_info_dict.get("ver_hw", "PX4"))
    return foreign


def _topic(log: Any, name: str, instance: int) -> dict[str, np.ndarray] | None:
    for data in log.data_list:
        if data.name == name and data.multi_id == instance and len(data.data["timestamp"]):
            return data.data
    return None


def _xyz(data: dict[str, np.ndarray], *names: str) -> np.ndarray:
    return np.stack([data[name] for name in names], axis=1).astype(float)


def _from_single_sensors(gyro: dict, accel: dict | None) -> Foreign:
    stamp = gyro.get("timestamp_sample", gyro["timestamp"])
    foreign = Foreign(
        gyro=_xyz(gyro, "x", "y", "z") * RATE_DPS["rad/s"],
        time_s=stamp * 1e-6,
        temp=gyro["temperature"].astype(float) if "temperature" in gyro else None,
    )
    if accel is not None:
        stamps = accel.get("timestamp_sample", accel["timestamp"]).astype(float)
        force = _xyz(accel, "x", "y", "z") * ACCEL_G["m/s2"]
        foreign.accel = force[nearest(stamps, stamp.astype(float))]
        foreign.notes.append("each rate has the nearest acceleration beside it")
    if foreign.temp is not None and not np.isfinite(foreign.temp).any():
        foreign.temp = None
    return foreign


def _from_combined(data: dict[str, np.ndarray]) -> Foreign:
    gyro = _xyz(data, *(f"gyro_rad[{i}]" for i in range(3))) * RATE_DPS["rad/s"]
    accel = _xyz(data, *(f"accelerometer_m_s2[{i}]" for i in range(3))) * ACCEL_G["m/s2"]
    return Foreign(gyro=gyro, accel=accel, time_s=data["timestamp"] * 1e-6)


def nearest(stamps: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """Index into sorted `stamps` of the one nearest to each of `wanted`."""
    after = np.clip(np.searchsorted(stamps, wanted), 1, max(len(stamps) - 1, 1))
    if len(stamps) == 1:
        return np.zeros(len(wanted), int)
    return np.where(wanted - stamps[after - 1] <= stamps[after] - wanted, after - 1, after)
