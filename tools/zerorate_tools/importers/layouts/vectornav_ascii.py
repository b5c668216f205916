"""VectorNav $VNIMU lines: mag gauss, acc m/s2, gyro rad/s, degC, kPa, XOR checksum."""

from __future__ import annotations

import gzip
import re
import zlib
from collections import Counter
from functools import reduce
from operator import xor
from pathlib import Path

import numpy as np

from ...errors import BadRecording
from ..foreign import Foreign
from ..table import first_line
from ..units import ACCEL_G, RATE_DPS

_LINE = re.compile(rb"\$([^*]*)\*([0-9A-Fa-f]{2})", re.DOTALL)
# of 256 damaged lines one passes the checksum, so the fixed widths are asked for too
_FIELDS = re.compile(
    rb"VNIMU(?:,[-+]\d\d\.\d{4}){3}(?:,[-+]\d\d\.\d{3}){3}(?:,[-+]\d\d\.\d{6}){3}"
    rb",[-+]\d\d\.\d,[-+]\d{3}\.\d{3}"
)


def recognises(path: Path) -> bool:
    """By the first line's talker."""
    if path.suffix.lower() not in (".csv", ".gz", ".txt", ".log", ".asc"):
        return False
    return first_line(path).startswith("$VNIMU,")


def read(path: Path) -> Foreign:
    """Lines that are damaged or fail their checksum are dropped; the others keep their place."""
    values, index, dropped = _lines(path)
    if not values:
        raise BadRecording(path, "no line passes its checksum", do="record again")
    table = np.array(values)
    foreign = Foreign(
        gyro=table[:, 6:9] * RATE_DPS["rad/s"],
        accel=table[:, 3:6] * ACCEL_G["m/s2"],
        temp=table[:, 9],
        extra={"pressure_pa": table[:, 10] * 1000},
        index=np.array(index),
        sensor="VN-200",
        lsb={
            "gyro_lsb_per_dps": 131.0,
            "accel_lsb_per_g": 16384.0,
            "temp_lsb_per_degc": 100.0,
            "temp_offset_degc": 0.0,
        },
        dropped=dropped,
        hint_hz="give --hz, lines a second that the unit was set to send",
    )
    foreign.notes.append("131 LSB/dps: rounds by 2.2 mdps rms, a seventeenth of the noise")
    return foreign


def _lines(path: Path) -> tuple[list[list[float]], list[int], Counter[str]]:
    values: list[list[float]] = []
    index: list[int] = []
    dropped: Counter[str] = Counter()
    for number, line in enumerate(_content(path).rstrip(b"\n").split(b"\n")):
        text = line.strip(b"\r ")
        match = _LINE.fullmatch(text)
        if match is None:
            dropped["no whole line"] += 1
        elif reduce(xor, match[1], 0) != int(match[2], 16):
            dropped["the checksum fails"] += 1
        elif _FIELDS.fullmatch(match[1]) is None:
            dropped["damaged (zero bytes, fields missing), though the checksum passes"] += 1
        else:
            values.append([float(cell) for cell in match[1].split(b",")[1:]])
            index.append(number)
    return values, index, dropped


def _content(path: Path) -> bytes:
    try:
        return gzip.decompress(path.read_bytes()) if path.suffix == ".gz" else path.read_bytes()
    except (EOFError, zlib.error, gzip.BadGzipFile) as error:
        problem = "the gzip data is cut off or damaged"
        raise BadRecording(path, problem, do="copy the file again") from error
