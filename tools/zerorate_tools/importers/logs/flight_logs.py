"""Logs of flight controllers: PX4's ULog, ArduPilot's DataFlash, Betaflight's blackbox."""

import struct
from collections.abc import Collection, Iterator
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from ...errors import BadRecording
from ...recordings.recording import ACCEL, GYRO
from ..tables.table import Chunk, Table, chunks_of, one_after_the_other

_SI = {
    "t_us": "us",
    **dict.fromkeys(GYRO, "rad/s"),
    **dict.fromkeys(ACCEL, "m/s2"),
    "temp": "degc",
}
# PX4 ULog: sensor_gyro with sensor_accel, or sensor_combined where that is logged far faster.
_TOPICS = ["sensor_gyro", "sensor_accel", "sensor_combined"]
#: sensor_gyro is passed over where sensor_combined has as many times its samples.
_FAR_FASTER = 10
# ArduPilot DataFlash (.bin, .log): the IMU messages of one instance.
_TYPES = ("IMU", "IMU2", "IMU3")
_FIELDS = {
    **{"gx": "GyrX", "gy": "GyrY", "gz": "GyrZ"},
    **{"ax": "AccX", "ay": "AccY", "az": "AccZ", "temp": "T"},
}
_NO_OFFSETS = "DataFlash holds rates after the autopilot's own offsets (INS_GYROFFS)"
# Betaflight's blackbox (.bbl): gyro and acceleration as the flight controller logged them.
_RATES = ("gyroUnfilt", "gyroADC")
_FORCES = ("accSmooth", "accADC")
_NO_OFFSET = "Betaflight takes its bias at rest away before it logs: what is left is seen"


def ulog(path: Path, instance: int = 0) -> Table:
    """One instance's samples. Raises BadRecording, ModuleNotFoundError."""
    from pyulog import ULog

    log = ULog(str(path), message_name_filter_list=_TOPICS)
    gyro = _topic(log, "sensor_gyro", instance)
    combined = _topic(log, "sensor_combined", instance)
    notes = []
    most = _FAR_FASTER * len(gyro["timestamp"]) if gyro else 0
    if gyro is not None and (combined is None or len(combined["timestamp"]) <= most):
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


def _topic(log: Any, name: str, instance: int) -> dict[str, np.ndarray] | None:
    for data in log.data_list:
        if data.name == name and data.multi_id == instance and len(data.data["timestamp"]):
            return data.data
    return None


def _single_sensors(
    gyro: dict[str, np.ndarray], accel: dict[str, np.ndarray] | None
) -> list[dict[str, np.ndarray]]:
    rates = {"t_us": gyro.get("timestamp_sample", gyro["timestamp"])}
    rates |= {name: gyro[axis] for name, axis in zip(GYRO, "xyz")}
    for readings in _temperature(gyro):
        rates["temp"] = readings["temp"]
    if accel is None:
        return [rates]
    force = {"t_us": accel.get("timestamp_sample", accel["timestamp"])}
    return [rates, force | {name: accel[axis] for name, axis in zip(ACCEL, "xyz")}]


def _temperature(gyro: dict[str, np.ndarray]) -> list[dict[str, np.ndarray]]:
    if "temperature" not in gyro or not np.isfinite(gyro["temperature"]).any():
        return []
    t_us = gyro.get("timestamp_sample", gyro["timestamp"])
    return [{"t_us": t_us, "temp": gyro["temperature"]}]


def _combined(data: dict[str, np.ndarray]) -> list[dict[str, np.ndarray]]:
    columns = {"t_us": data["timestamp"]}
    columns |= {name: data[f"gyro_rad[{i}]"] for i, name in enumerate(GYRO)}
    return [columns | {name: data[f"accelerometer_m_s2[{i}]"] for i, name in enumerate(ACCEL)}]


def dataflash(path: Path, instance: int = 0) -> Table:
    """One instance's samples: of IMU by its field I, or of IMU, IMU2, IMU3 without it.

    Time is TimeUS, or TimeMS in logs before 2016. Raises BadRecording, ModuleNotFoundError.
    """
    from pymavlink import DFReader

    with open(path, "rb") as file:
        text = file.read(2) != b"\xa3\x95"
    log = (DFReader.DFReader_text if text else DFReader.DFReader_binary)(str(path))
    first = next(_rows(log, instance), None)
    if first is None:
        do = "log IMU (LOG_BITMASK), or try --instance"
        raise BadRecording(path, f"no IMU message of instance {instance}", do=do)
    size = path.stat().st_size

    def chunks(wanted: list[str]) -> Iterator[Chunk]:
        log.rewind()
        for chunk in chunks_of(lambda: _rows(log, instance), wanted):
            table.read_bytes = size * min(log.percent, 100.0) / 100.0
            yield chunk

    table = Table(list(first), chunks, si_mapping(first), sensor="ArduPilot", notes=[_NO_OFFSETS])
    return table


def _rows(log: Any, instance: int) -> Iterator[dict[str, float]]:
    while (message := log.recv_match(type=list(_TYPES))) is not None:
        number = getattr(message, "I", None)
        if number is None:
            number = _TYPES.index(message.get_type())
        if number == instance:
            row = {
                name: value
                for name, field in _FIELDS.items()
                if isinstance(value := getattr(message, field, None), (int, float))
            }
            yield {"t_us": _time_us(message), **row}


def _time_us(message: Any) -> float:
    at_us = getattr(message, "TimeUS", None)
    if at_us is not None:
        return float(at_us)
    return float(getattr(message, "TimeMS", float("nan"))) * 1e3


def blackbox(path: Path, instance: int = 0) -> Table:
    """The flight of that number in the file. Raises BadRecording, ModuleNotFoundError."""
    from orangebox import Parser

    parser = Parser.load(str(path), instance + 1)
    names = list(parser.field_names)
    if not names:
        raise BadRecording(path, "no blackbox log, or damaged", do="copy the file again")
    gyro, accel = _named(names, _RATES), _named(names, _FORCES)
    if gyro is None or "time" not in names:
        do = "log GYRO in the blackbox settings, or try --instance"
        raise BadRecording(path, f"no gyro in flight {instance}", do=do)
    one_g = parser.headers.get("acc_1G")
    accel = accel if isinstance(one_g, (int, float)) and one_g > 0 else None
    at = {"t_us": names.index("time")}
    at |= {f"g{axis}": names.index(f"{gyro}[{i}]") for i, axis in enumerate("xyz")}
    if accel is not None:
        at |= {f"a{axis}": names.index(f"{accel}[{i}]") for i, axis in enumerate("xyz")}
    factors = {"g": _dps_per_lsb(parser.headers), "a": 1.0 / one_g if accel else 1.0, "t": 1.0}

    def rows() -> Iterator[dict[str, float]]:
        for frame in Parser.load(str(path), instance + 1).frames():
            yield {name: frame.data[place] * factors[name[0]] for name, place in at.items()}

    units = {"g": "dps", "a": "g", "t": "us"}
    mapping = [f"{name}={name}:{units[name[0]]}" for name in at]
    board = str(parser.headers.get("Firmware revision", "Betaflight"))
    notes = [f"{gyro}: {_NO_OFFSET}"]
    return Table(list(at), partial(chunks_of, rows), mapping, sensor=board, notes=notes)


def _named(names: list[str], wanted: tuple[str, ...]) -> str | None:
    return next((name for name in wanted if f"{name}[2]" in names), None)


def _dps_per_lsb(headers: dict[str, Any]) -> float:
    """gyro_scale holds the bits of a float in hexadecimal: degrees a second for each count."""
    text = str(headers.get("gyro_scale", headers.get("gyro.scale", "0x3f800000")))
    try:
        bits = int(text, 16) if text.startswith("0x") else int(text)
        return struct.unpack("<f", struct.pack("<I", bits))[0]
    except (ValueError, struct.error):
        return 1.0


def si_mapping(names: Collection[str]) -> list[str]:
    """Words as of --map for those columns of a recording that an autopilot has, in SI units."""
    return [f"{name}={name}:{unit}" for name, unit in _SI.items() if name in names]
