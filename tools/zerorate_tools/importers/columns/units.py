"""Physical units into those of a recording: dps, g, degC and seconds."""

import math
import re

import numpy as np

STANDARD_GRAVITY = 9.80665
TIME_S = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}
RATE_DPS = {
    **{"dps": 1.0, "deg/s": 1.0, "mdps": 1e-3},
    **{"rad/s": 180 / math.pi, "mrad/s": 0.18 / math.pi},
}
ACCEL_G = {"g": 1.0, "mg": 1e-3, "ug": 1e-6, "m/s2": 1 / STANDARD_GRAVITY}
TEMP_DEGC = {"degc": (1.0, 0.0), "c": (1.0, 0.0), "k": (1.0, -273.15), "degf": (5 / 9, -160 / 9)}
RAW = "lsb"
KINDS = {"t": "time", "g": "gyro", "a": "accel"}

#: Digits that are raised, and the letters of рад/с, м/с² and сек.
_PLAIN = str.maketrans("⁻¹²радмсек", "-12radmsec")
_SEC = "(?:seconds?|secs?|s)"
_PER_SEC = rf"(?:(?:[\s_]*(?:/|per)[\s_]*|_){_SEC}|[\s_*·.]{_SEC}\^?-1)"
_SQUARED = r"(?:/s|\^?2|[\s_]*squared|[\s_]*/[\s_]*s)"
_METRE = "m(?:et(?:er|re)s?)?"
#: A unit as people write it, whatever its case.
_WRITTEN = {
    "dps": rf"dps|degs|d/s|(?:°|deg(?:ree)?s?){_PER_SEC}",
    "mdps": rf"mdps|m(?:illi)?(?:°|deg(?:ree)?s?){_PER_SEC}",
    "rad/s": rf"rads|rps|rad(?:ian)?s?ps|radpersec|rad(?:ian)?s?{_PER_SEC}",
    "mrad/s": rf"m(?:illi)?rad(?:ian)?s?{_PER_SEC}",
    "m/s2": rf"mss|ms/?2|mps2|{_METRE}(?:[\s_]*(?:/|per)[\s_]*|_){_SEC}{_SQUARED}"
    rf"|m[\s_*·.]{_SEC}\^?-2",
    "g": "gs?|gees?",
    "mg": r"m(?:illi[\s_-]?)?g",
    "ug": "[uµμ]g",
    "degc": "°c|degc|celsius|℃",
    "c": "c",
    "degf": "°f|degf|f",
    "k": "k|kelvin",
    "s": _SEC,
    "ms": "m(?:seconds?|secs?|s)|millis(?:econds?|ecs?)?",
    "us": "[uµμ](?:seconds?|secs?|s)|micros(?:econds?|ecs?)?",
    "ns": "n(?:seconds?|secs?|s)|nanos(?:econds?|ecs?)?",
    "lsb": "lsb|counts|raw|no units",
}
_WRITTEN_BY_KIND = {
    "time": ("s", "ms", "us", "ns"),
    "gyro": ("mdps", "dps", "mrad/s", "rad/s", "lsb"),
    "accel": ("m/s2", "mg", "ug", "g", "lsb"),
    "temp": ("degc", "degf", "c", "k", "lsb"),
}
#: Whole names that tell a unit; T(°) is what WitMotion writes.
_BY_NAME = {
    "time": {"seconds_elapsed": "s", "__time": "s", "itow": "ms"},
    "temp": {"t(°)": "degc"},
}  # fmt: skip
#: Turns a minute, degrees an hour, and so many of a unit: 0.1 dps.
_OTHER_SIZE = re.compile(r"rpm|dph|\d[\d.^*x-]*\s*(?:dps|°/s|(?:deg|rad)/s|[mu]?g)")
#: Of a column of an array.
_INDEX = re.compile(r"\[\d+\]$")
#: m/(sec^2), as Shimmer writes; no unit in brackets.
_DENOMINATOR = re.compile(r"/\(([^()]*)\)$")
_BRACKETS = re.compile(r"[\[({<]\s*(?:in\s)?([^\])}>]*?)\s*[\])}>]\s*$")


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
    name = _DENOMINATOR.sub(r"/\1", _INDEX.sub("", column.strip().lower().translate(_PLAIN)))
    kind = kind_of(target)
    if kind == "time" and (found := re.search("time([mun]s)$", name)):
        return found[1]
    if name in _BY_NAME.get(kind, {}):
        return _BY_NAME[kind][name]
    in_brackets = _BRACKETS.search(name)
    if in_brackets or kind == "time" and len(name) > 1:  # a time is called millis, too
        text, units = in_brackets[1] if in_brackets else name, _WRITTEN_BY_KIND[kind]
        unit = next((u for u in units if re.fullmatch(_WRITTEN[u], text)), None)
        if unit or in_brackets:
            return unit
    return next((u for u, ending in _ENDINGS[kind].items() if ending.search(name)), None)


def other_unit(column: str) -> str | None:
    """What a name ends with if that is a unit of another size: a quotient in brackets, as no
    channel's number is, or rpm, say."""
    in_brackets = _BRACKETS.search(column.strip())
    text = in_brackets[1] if in_brackets else re.split(r"[\s_.]", column.strip())[-1]
    other = in_brackets and "/" in text or _OTHER_SIZE.fullmatch(text.lower())
    return text if other else None


def without_unit(name: str) -> str:
    """A lower-case name without the unit in brackets, or of words, at its end."""
    name = _DENOMINATOR.sub(r"/\1", name)
    in_brackets = _BRACKETS.search(name)
    if in_brackets:
        return name[: in_brackets.start()].strip()
    endings = [ending for kind in _ENDINGS.values() for ending in kind.values()]
    at = [found.start() for found in (ending.search(name) for ending in endings) if found]
    return name[: min(at)] if at else name


_ENDINGS = {
    kind: {unit: re.compile(rf"(?<=.)[_\s.](?:{_WRITTEN[unit]})$") for unit in units}
    for kind, units in _WRITTEN_BY_KIND.items()
}


#: Of gyroscopes of 16 bits, by their ranges, and of ST's, by their data sheets: 125 to 4000 dps.
_LSB_PER_DPS = np.r_[32768 / 125, 1 / 0.004375][:, None] / 2.0 ** np.arange(6)
#: Logarithm of what printed digits and data sheets round; distances of levels that tell a step,
#: those of so few steps; and what is a digit of floating point.
_ONE_STEP, _LEVELS, _FEW_STEPS, _ROUNDED = 0.003, 16, 8, 1e-7


def unit_by_steps(rates: np.ndarray) -> str | None:
    """The unit in which rates have the steps of a gyroscope of 16 bits."""
    levels = np.unique(rates[np.isfinite(rates)])
    apart = np.diff(levels)
    apart = apart[apart > _ROUNDED * np.abs(levels).max(initial=0.0)]
    if len(apart) < _LEVELS:
        return None
    apart = apart[apart < _FEW_STEPS * apart.min()]
    counts = np.round(apart / apart.min())
    step = apart.sum() / counts.sum()
    if len(apart) < _LEVELS or (np.abs(apart - counts * step) > step / 20).any():
        return None
    off = {u: np.abs(np.log(step * one * _LSB_PER_DPS)).min() for u, one in RATE_DPS.items()}
    unit = min(off, key=off.__getitem__)
    return unit if off[unit] < _ONE_STEP else None
