"""PX4 ULog: sensor_gyro with sensor_accel, or sensor_combined."""

from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from ...errors import BadRecording
from ..tables.table import Table
from .streams import one_after_the_other, si_mapping

KIND = "ULog"
_TOPICS = ["sensor_gyro", "sensor_accel", "sensor_combined"]
_GYRO, _ACCEL = ("gx", "gy", "gz"), ("ax", "ay", "az")


def read(path: Path, instance: int = 0) -> Table:
    """One instance's samples. Raises BadRecording, ModuleNotFoundError."""
    from pyulog import ULog

    log = ULog(str(path), message_name_filter_list=_TOPICS)
    gyro = _topic(log, "sensor_gyro", instance)
    if gyro is not None:
        streams = _single_sensors(gyro, _topic(log, "sensor_accel", instance))
    else:
        combined = _topic(log, "sensor_combined", instance)
        if combined is None:
            problem = f"neither sensor_gyro nor sensor_combined, instance {instance}"
            raise BadRecording(path, problem, do="log them (SDLOG_PROFILE), or try --instance")
        streams = _combined(combined)
    names = list(dict.fromkeys(name for stream in streams for name in stream))
    chunks = partial(one_after_the_other, streams)
    sensor = str(log.msg_info_dict.get("ver_hw", "PX4"))
    return Table(names, chunks, si_mapping(names), sensor=sensor)


def _topic(log: Any, name: str, instance: int) -> dict[str, np.ndarray] | None:
    for data in log.data_list:
        if data.name == name and data.multi_id == instance and len(data.data["timestamp"]):
            return data.data
    return None


def _single_sensors(gyro: dict, accel: dict | None) -> list[dict[str, np.ndarray]]:
    rates = {"t_us": gyro.get("timestamp_sample", gyro["timestamp"])}
    rates |= {name: gyro[axis] for name, axis in zip(_GYRO, "xyz")}
    if "temperature" in gyro and np.isfinite(gyro["temperature"]).any():
        rates["temp"] = gyro["temperature"]
    if accel is None:
        return [rates]
    force = {"t_us": accel.get("timestamp_sample", accel["timestamp"])}
    return [rates, force | {name: accel[axis] for name, axis in zip(_ACCEL, "xyz")}]


def _combined(data: dict[str, np.ndarray]) -> list[dict[str, np.ndarray]]:
    columns = {"t_us": data["timestamp"]}
    columns |= {name: data[f"gyro_rad[{i}]"] for i, name in enumerate(_GYRO)}
    return [columns | {name: data[f"accelerometer_m_s2[{i}]"] for i, name in enumerate(_ACCEL)}]
