"""PX4 ULog: sensor_gyro with sensor_accel, or sensor_combined where that is logged far faster."""

from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from ...errors import BadRecording
from ..tables.table import Table
from .streams import one_after_the_other, si_mapping

KIND = "ULog"
_TOPICS = ["sensor_gyro", "sensor_accel", "sensor_combined"]
#: sensor_gyro is passed over where sensor_combined has as many times its samples.
_FAR_FASTER = 10
_GYRO, _ACCEL = ("gx", "gy", "gz"), ("ax", "ay", "az")


def read(path: Path, instance: int = 0) -> Table:
    """One instance's samples. Raises BadRecording, ModuleNotFoundError."""
    from pyulog import ULog

    log = ULog(str(path), message_name_filter_list=_TOPICS)
    gyro = _topic(log, "sensor_gyro", instance)
    combined = _topic(log, "sensor_combined", instance)
    notes = []
    if gyro is not None and (combined is None or not _far_faster(combined, gyro)):
        streams = _single_sensors(gyro, _topic(log, "sensor_accel", instance))
    elif combined is not None:
        streams = _combined(combined)
        if gyro is not None:
            streams += _temperature(gyro)
            notes = [
                "sensor_gyro is logged too seldom (SDLOG_PROFILE), so sensor_combined is taken: "
                "its rates are after PX4's own offsets"
            ]
    else:
        problem = f"neither sensor_gyro nor sensor_combined, instance {instance}"
        raise BadRecording(path, problem, do="log them (SDLOG_PROFILE), or try --instance")
    names = list(dict.fromkeys(name for stream in streams for name in stream))
    chunks = partial(one_after_the_other, streams)
    sensor = str(log.msg_info_dict.get("ver_hw", "PX4"))
    return Table(names, chunks, si_mapping(names), sensor=sensor, notes=notes)


def _far_faster(one: dict, other: dict) -> bool:
    return len(one["timestamp"]) > _FAR_FASTER * len(other["timestamp"])


def _topic(log: Any, name: str, instance: int) -> dict[str, np.ndarray] | None:
    for data in log.data_list:
        if data.name == name and data.multi_id == instance and len(data.data["timestamp"]):
            return data.data
    return None


def _single_sensors(gyro: dict, accel: dict | None) -> list[dict[str, np.ndarray]]:
    rates = {"t_us": gyro.get("timestamp_sample", gyro["timestamp"])}
    rates |= {name: gyro[axis] for name, axis in zip(_GYRO, "xyz")}
    for readings in _temperature(gyro):
        rates["temp"] = readings["temp"]
    if accel is None:
        return [rates]
    force = {"t_us": accel.get("timestamp_sample", accel["timestamp"])}
    return [rates, force | {name: accel[axis] for name, axis in zip(_ACCEL, "xyz")}]


def _temperature(gyro: dict) -> list[dict[str, np.ndarray]]:
    if "temperature" not in gyro or not np.isfinite(gyro["temperature"]).any():
        return []
    t_us = gyro.get("timestamp_sample", gyro["timestamp"])
    return [{"t_us": t_us, "temp": gyro["temperature"]}]


def _combined(data: dict[str, np.ndarray]) -> list[dict[str, np.ndarray]]:
    columns = {"t_us": data["timestamp"]}
    columns |= {name: data[f"gyro_rad[{i}]"] for i, name in enumerate(_GYRO)}
    return [columns | {name: data[f"accelerometer_m_s2[{i}]"] for i, name in enumerate(_ACCEL)}]
