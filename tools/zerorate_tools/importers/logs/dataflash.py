"""ArduPilot DataFlash (.bin, .log): the IMU messages of one instance."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

from ...errors import BadRecording
from ..tables.table import Chunk, Table
from .streams import chunks_of, si_mapping

KIND = "DataFlash log"
_TYPES = ("IMU", "IMU2", "IMU3")
_FIELDS = {
    **{"gx": "GyrX", "gy": "GyrY", "gz": "GyrZ"},
    **{"ax": "AccX", "ay": "AccY", "az": "AccZ", "temp": "T"},
}
_NO_OFFSETS = "DataFlash holds rates after the autopilot's own offsets (INS_GYROFFS)"


def read(path: Path, instance: int = 0) -> Table:
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
