"""Betaflight's blackbox (.bbl): gyro and acceleration as the flight controller logged them."""

import struct
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import Any

from ...errors import BadRecording
from ..tables.table import Table
from .streams import chunks_of

KIND = "blackbox log"
_RATES = ("gyroUnfilt", "gyroADC")
_FORCES = ("accSmooth", "accADC")
_NO_OFFSET = "Betaflight takes its bias at rest away before it logs: what is left is seen"


def read(path: Path, instance: int = 0) -> Table:
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
