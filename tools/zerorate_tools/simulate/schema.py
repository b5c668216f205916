"""The entries of a simulated device's description, with their units, and what each must be."""

import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field, fields
from typing import Any, get_origin

import numpy as np

from ..errors import BadDescription
from .channels import durations

Table = Mapping[str, Any]


@dataclass
class Sensor:
    """The part. gyro_noise_dps is the rms of a reading at gyro_noise_at_hz (default odr_hz).

    Below that rate readings are block averages: their noise falls with the root of the rate.
    gyro_noise_dps_rt_hz, where given, takes its place. temp_lag_s: the reading follows the die;
    temp_step_lsb: it moves in steps (32 on one real MPU-6050, 16 on a GY-521).
    """

    name: str = "MPU-6050"
    odr_hz: float = 100.0
    gyro_lsb_per_dps: float = 131.0
    accel_lsb_per_g: float = 16384.0
    temp_lsb_per_degc: float = 340.0
    temp_offset_degc: float = 36.53
    gyro_noise_dps: float = 0.05
    gyro_noise_at_hz: float | None = None
    gyro_noise_dps_rt_hz: float | None = None
    accel_noise_g: float = 0.004
    accel_bias_g: Any = 0.0
    temp_noise_degc: float = 0.05
    temp_lag_s: float = 0.0
    temp_step_lsb: float = 1.0
    accel: bool = True
    temp: bool = True


@dataclass
class Bias:
    """bias = b0 + b1 (T-25) + b2 (T-25)^2 + b3 (T-25)^3, dps; turn_on_dps: deviation a power-on."""

    b0: Any = 0.0
    b1: Any = 0.0
    b2: Any = 0.0
    b3: Any = 0.0
    turn_on_dps: Any = 0.0


@dataclass
class Noise:
    """Beyond white: Allan floor, random walk dps/sqrt(s), and what is worse (each may be x y z).

    telegraph_dps jumps with telegraph_mean_s; coloured_dps rms of density f**-coloured_exponent;
    outlier_dps deviation of outlier_per_hour single readings. The walk starts at 0 at power-on.
    """

    bias_instability_dps: Any = 0.0
    random_walk_dps: Any = 0.0
    telegraph_dps: Any = 0.0
    telegraph_mean_s: float = 300.0
    coloured_dps: Any = 0.0
    coloured_exponent: float = 1.5
    outlier_dps: float = 0.0
    outlier_per_hour: float = 0.0


@dataclass
class Session:
    """One power-on: how warm, how moved, how long (default: as long as the temperature path).

    vary_degc, vary_time: deviation of each temperature (degC) and duration (relative), drawn anew
    a session. motion is repeated to the end; a pair [low, high] in it is drawn anew each time.
    """

    start_degc: float = 25.0
    temperature: list[Table] = field(default_factory=list)
    motion: list[Table] = field(default_factory=list)
    face: str = "+z"
    tilt_deg: float = 0.0
    heading_deg: float = 0.0
    noise_scale: float = 1.0
    vary_degc: float = 0.0
    vary_time: float = 0.0
    s: float = 0.0
    minutes: float = 0.0
    hours: float = 0.0

    @property
    def duration_s(self) -> float:
        given = self.s + 60 * self.minutes + 3600 * self.hours
        return given or sum(durations(self.start_degc, self.temperature))


@dataclass
class Description:
    """A device with its power-ons, extra channels and effects."""

    sensor: Sensor
    bias: Bias
    noise: Noise
    sessions: list[Session]
    channels: dict[str, Table]
    effects: list[Table]
    name: str = "simulated"
    seed: int = 1
    latitude_deg: float | None = None
    path: str = "description"


class Wrong(Exception):
    """What is wrong with an entry of a description, and what to do about it."""

    def __init__(self, problem: str, do: str) -> None:
        super().__init__(problem)
        self.problem, self.do = problem, do


@contextmanager
def read_from(path: str) -> Iterator[None]:
    """Say what is Wrong of a description as a BadDescription, with its file."""
    try:
        yield
    except Wrong as wrong:
        raise BadDescription(path, wrong.problem, do=wrong.do) from wrong


def table(value: Any, where: str) -> Table:
    """The value, which must be a table."""
    if not isinstance(value, Mapping):
        raise Wrong(f"{where} is no table", f"write [{where}]")
    return value


def tables(value: Any, where: str) -> list[Table]:
    """The value, which must be a list of tables."""
    if not isinstance(value, (list, tuple)):
        raise Wrong(f"{where} is no list of tables", f"write [[{where}]]")
    return [table(entry, where) for entry in value]


def filled(cls: type, given: Any, where: str) -> Any:
    """A dataclass of the schema filled from a table, each value of its kind."""
    entries = table(given, where)
    kinds = {f.name: f.type for f in fields(cls)}
    known(entries, tuple(kinds), where)
    for key, value in entries.items():
        check_value(value, kinds[key], f"{where}.{key}")
    return cls(**entries)


def check_value(value: Any, wanted: Any, where: str) -> None:
    """Raise Wrong unless the value is of the wanted type (Any: one number or 3)."""
    if wanted is Any:
        axes(value, where)
    elif get_origin(wanted) is list:
        tables(value, where)
    elif wanted in (float, float | None) and not is_number(value):
        raise Wrong(f"{where} is {value!r}", "write a number")
    elif wanted in (str, bool) and type(value) is not wanted:
        raise Wrong(f"{where} is {value!r}", f"write a {wanted.__name__}")


def known(entries: Table, names: tuple[str, ...], where: str) -> None:
    """Raise Wrong at the first entry that is none of `names`."""
    for key in entries:
        if key not in names:
            place = f"{where}.{key}" if where else str(key)
            raise Wrong(f"{place} is unknown", f"choose of {', '.join(names)}")


def axes(value: Any, where: str = "") -> np.ndarray:
    """(3,) x y z out of one number or three. Raises Wrong."""
    values = value if isinstance(value, (list, tuple, np.ndarray)) else [value] * 3
    if len(values) != 3 or not all(is_number(v) for v in values):
        raise Wrong(f"{where} is {value!r}", "write one number or [x, y, z]")
    return np.array([float(v) for v in values])


def is_pair(value: Any) -> bool:
    """Whether it is [low, high], between which a motion's number is drawn."""
    return isinstance(value, list) and len(value) == 2


def is_number(value: Any) -> bool:
    """Whether it is a finite int or float (a bool is none, nor is one that no float can be)."""
    is_number = isinstance(value, (int, float, np.number)) and not isinstance(value, bool)
    return is_number and bool(abs(value) <= sys.float_info.max)
