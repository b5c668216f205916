"""What one LSB of each reading means."""

import json
from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from os import PathLike
from typing import Any

from ..errors import BadRecording

_ALWAYS = ("odr_hz", "gyro_lsb_per_dps")
_ACCEL = ("accel_lsb_per_g",)
_TEMP = ("temp_lsb_per_degc", "temp_offset_degc")
#: An MPU-6050 at +-250 dps and +-2 g, to show the form by.
EXAMPLE = {
    "sensor": "MPU-6050",
    "odr_hz": 100,
    "gyro_lsb_per_dps": 131,
    "accel_lsb_per_g": 16384,
    "temp_lsb_per_degc": 340,
    "temp_offset_degc": 36.53,
}
#: What any sensor may have, wide enough for a reading a day and narrow enough for its arithmetic.
_RANGES = {
    "odr_hz": (1e-5, 1e6),
    "gyro_lsb_per_dps": (1e-3, 1e7),
    "accel_lsb_per_g": (1e-3, 1e8),
    "temp_lsb_per_degc": (1e-3, 1e7),
    "temp_offset_degc": (-1e6, 1e6),
}
MOST_BYTES = 1_048_576


@dataclass(frozen=True)
class Scales:
    """Sensor, output data rate and scales of a recording (design.md, Recordings).

    degC = raw / temp_lsb_per_degc + temp_offset_degc. A scale whose columns are absent may be None.
    `more` keeps every other key of the JSON (units of extra channels, latitude, attitude, source).
    """

    sensor: str
    odr_hz: float
    gyro_lsb_per_dps: float
    accel_lsb_per_g: float | None = None
    temp_lsb_per_degc: float | None = None
    temp_offset_degc: float | None = None
    more: Mapping[str, Any] = field(default_factory=dict)

    def to_json(self) -> dict[str, Any]:
        """The dict that travels as JSON: absent scales left out, `more` beside the rest."""
        known = {key: getattr(self, key) for key in ("sensor", *_ALWAYS, *_ACCEL, *_TEMP)}
        return {k: v for k, v in known.items() if v is not None} | dict(self.more)

    def temp_degc(self, raw: Any) -> Any:
        """Raw temperature readings in degC. Raises ValueError where there is no such scale."""
        if self.temp_lsb_per_degc is None or self.temp_offset_degc is None:
            raise ValueError("these scales have no temperature")
        return raw / self.temp_lsb_per_degc + self.temp_offset_degc


def scales_from_text(
    text: str | bytes, path: str | PathLike[str], column_names: Collection[str] = ()
) -> Scales:
    """Scales out of JSON text, whole for these columns.

    Raises BadRecording that names `path`, line and what to do.
    """
    if len(text) > MOST_BYTES:
        raise BadRecording(
            path, f"scales of more than {MOST_BYTES >> 20} MiB", do="write them as a short JSON"
        )
    try:
        values = json.loads(text)
        json.dumps(values, ensure_ascii=False).encode()
    except json.JSONDecodeError as error:
        problem = (
            f"the scales are not JSON (line {error.lineno}, column {error.colno}: {error.msg})"
        )
        raise BadRecording(path, problem, do="correct the text there") from error
    except UnicodeError as error:  # of its bytes, or of half a character in \\u escapes
        raise BadRecording(path, "the scales are not text", do="write them as JSON") from error
    except (RecursionError, ValueError) as error:
        problem = "the scales are nested too deep, or hold a number of thousands of digits"
        raise BadRecording(path, problem, do="correct the text there") from error
    if not isinstance(values, dict):
        raise BadRecording(path, "the scales are no JSON object", do='write {"sensor": ...}')
    check_whole(values, column_names, path)
    numbers = {k: _number(values[k], k, path) for k in (*_ALWAYS, *_ACCEL, *_TEMP) if k in values}
    more = {k: v for k, v in values.items() if k not in numbers and k != "sensor"}
    return Scales(sensor=values["sensor"], more=more, **numbers)


def _number(value: Any, key: str, path: str | PathLike[str]) -> float:
    is_number = isinstance(value, (int, float)) and not isinstance(value, bool)
    low, high = _RANGES[key]
    # compared as it is: an integer of 400 digits is no float
    if not is_number or value != value:
        raise BadRecording(path, f"{key} is {_short(value)}, no number", do="write a number")
    if not low <= value <= high:
        do = f"write a number from {low:g} to {high:g}"
        raise BadRecording(path, f"{key} is {_short(value)}", do=do)
    return float(value)


def _short(value: Any) -> str:
    try:
        text = repr(value)
    except ValueError:
        return "a number of thousands of digits"
    return text if len(text) <= 40 else f"{text[:40]}..."


def check_whole(
    values: Mapping[str, Any], column_names: Collection[str], path: str | PathLike[str]
) -> None:
    """Raise BadRecording that names every key which these columns need and the scales lack."""
    lacking = [key for key in _needed(column_names) if key not in values]
    if not isinstance(values.get("sensor", ""), str):
        lacking.insert(0, "sensor")
    if lacking:
        example = json.dumps({key: EXAMPLE[key] for key in lacking})[1:-1]
        do = f"add {example} (an MPU-6050's; put your sensor's)"
        raise BadRecording(path, f"the scales lack {', '.join(lacking)}", do=do)


def example_for(column_names: Collection[str]) -> str:
    """JSON text of scales that columns of these names need, with an MPU-6050's values."""
    return json.dumps({key: EXAMPLE[key] for key in _needed(column_names)})


def _needed(column_names: Collection[str]) -> list[str]:
    accel = _ACCEL if "ax" in column_names else ()
    return ["sensor", *_ALWAYS, *accel, *(_TEMP if "temp" in column_names else ())]
