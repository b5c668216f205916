"""Physical units into those of a recording: dps, g, degC and microseconds."""

from __future__ import annotations

import math

STANDARD_GRAVITY = 9.80665
TIME_S = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}
RATE_DPS = {"dps": 1.0, "deg/s": 1.0, "mdps": 1e-3, "rad/s": 180 / math.pi}
ACCEL_G = {"g": 1.0, "mg": 1e-3, "m/s2": 1 / STANDARD_GRAVITY}
TEMP_DEGC = {"degc": (1.0, 0.0), "c": (1.0, 0.0), "k": (1.0, -273.15), "degf": (5 / 9, -160 / 9)}
RAW = "lsb"

_BY_NAME = {
    "t_s": "s",
    "time_s": "s",
    "t_ms": "ms",
    "t_us": "us",
    "timeus": "us",
    "timestamp_us": "us",
}


def units_of(target: str) -> tuple[str, ...]:
    """The unit names that a column of a recording may come in."""
    if target == "t_us":
        return tuple(TIME_S)
    table = {"g": RATE_DPS, "a": ACCEL_G}.get(target[0], TEMP_DEGC)
    return (*table, RAW)


def unit_in_name(target: str, column: str) -> str | None:
    """The unit that a column's own name ends with (gx_dps, ax [m/s2], temp_C), or None."""
    name = column.strip().lower().rstrip("])").replace("[", "_").replace("(", "_")
    if target == "t_us" and name in _BY_NAME:
        return _BY_NAME[name]
    known = {*units_of(target)}
    ending = name.rpartition("_")[2].replace("²", "2").replace("^2", "2").replace("°", "deg")
    ending = {"degs": "deg/s", "rads": "rad/s", "mss": "m/s2", "ms2": "m/s2"}.get(ending, ending)
    return ending if ending in known else None
