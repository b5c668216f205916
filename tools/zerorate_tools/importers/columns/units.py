"""Physical units into those of a recording: dps, g, degC and seconds."""

import math
import re

STANDARD_GRAVITY = 9.80665
TIME_S = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}
RATE_DPS = {"dps": 1.0, "deg/s": 1.0, "mdps": 1e-3, "rad/s": 180 / math.pi}
ACCEL_G = {"g": 1.0, "mg": 1e-3, "m/s2": 1 / STANDARD_GRAVITY}
TEMP_DEGC = {"degc": (1.0, 0.0), "c": (1.0, 0.0), "k": (1.0, -273.15), "degf": (5 / 9, -160 / 9)}
RAW = "lsb"
KINDS = {"t": "time", "g": "gyro", "a": "accel"}

_WRITTEN = {
    **{"°/s": "dps", "deg/sec": "dps", "degs": "dps", "degpersec": "dps", "mdeg/s": "mdps"},
    **{"rads": "rad/s", "rad/sec": "rad/s", "radpersec": "rad/s", "radps": "rad/s", "rps": "rad/s"},
    **{"m/s^2": "m/s2", "m/s²": "m/s2", "m/s/s": "m/s2", "mss": "m/s2", "ms2": "m/s2"},
    **{"mps2": "m/s2", "°c": "degc", "celsius": "degc", "℃": "degc", "°f": "degf", "f": "degf"},
    **{"kelvin": "k", "sec": "s", "seconds": "s", "secs": "s", "second": "s", "msec": "ms"},
    **{"millis": "ms", "milliseconds": "ms", "usec": "us", "micros": "us", "µs": "us", "μs": "us"},
    **{"microseconds": "us", "nsec": "ns", "nanosec": "ns", "nanoseconds": "ns", "nsecs": "ns"},
    **{"counts": "lsb", "raw": "lsb"},
}
_BY_NAME = {"timeus": "us", "timems": "ms", "seconds_elapsed": "s", "__time": "s"}
_BRACKETS = re.compile(r"[\[({<]\s*([^\])}>]*?)\s*[\])}>]\s*$")


def kind_of(target: str) -> str:
    """time, gyro, accel or temp: of which a column of a recording is."""
    return "temp" if target == "temp" else KINDS[target[0]]


def factors_of(target: str) -> dict[str, tuple[float, float]]:
    """Unit -> (factor, offset) into the unit of a recording."""
    if target == "temp":
        return TEMP_DEGC
    table = {"time": TIME_S, "gyro": RATE_DPS, "accel": ACCEL_G}[kind_of(target)]
    return {unit: (factor, 0.0) for unit, factor in table.items()}


def units_of(target: str) -> tuple[str, ...]:
    """The unit names that a column of a recording may come in."""
    return (*factors_of(target), *(() if target == "t_us" else (RAW,)))


def unit_in_name(target: str, column: str) -> str | None:
    """The unit that a column's own name ends with (gx_dps, ax [m/s2], temp_C), or None."""
    name = column.strip().lower()
    if target == "t_us" and name in _BY_NAME:
        return _BY_NAME[name]
    in_brackets = _BRACKETS.search(name)
    ending = in_brackets[1] if in_brackets else re.split(r"[_\s.]", name)[-1]
    if ending == name and in_brackets is None:
        return None
    unit = _WRITTEN.get(ending, ending)
    return unit if unit in units_of(target) else None
