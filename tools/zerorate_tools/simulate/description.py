"""A simulated device's description: TOML, YAML or a dict, checked before anything runs."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass, field
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import BadDescription, MissingLibrary
from .motion import MOTIONS
from .paths import durations, seconds

Table = Mapping[str, Any]


@dataclass
class Sensor:
    """The part. gyro_noise_dps is the rms of a reading at gyro_noise_at_hz (default odr_hz).

    Below that rate readings are block averages: their noise falls with the root of the rate.
    gyro_noise_dps_rt_hz, where given, takes its place. temp_lag_s: the reading follows the die.
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
    temp_noise_degc: float = 0.02
    temp_lag_s: float = 0.0
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
        """Seconds of this power-on."""
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


_TOP = (
    *("name", "seed", "latitude_deg", "sensor", "bias", "noise", "every_session", "session"),
    *("sessions", "channels", "effect"),
)


def load_description(source: str | PathLike[str] | Table | Description) -> Description:
    """Read .toml, .yaml or .yml, a bundled scenario's bare name, or a dict.

    Raises BadDescription naming the entry, MissingLibrary without the reader it needs.
    """
    if isinstance(source, Description):
        return source
    if isinstance(source, Mapping):
        return _from_table(source, "description")
    path = bundled(str(source)) or Path(source)
    return _from_table(_parsed(path), str(path))


def bundled(name: str) -> Path | None:
    """The path of a scenario that ships with the tools, or None."""
    path = Path(__file__).parent / "scenarios" / f"{name}.toml"
    return path if "/" not in name and path.is_file() else None


def bundled_names() -> list[str]:
    """Names of the scenarios that ship with the tools."""
    return sorted(path.stem for path in (Path(__file__).parent / "scenarios").glob("*.toml"))


def _parsed(path: Path) -> Any:
    try:
        data = path.read_bytes()
    except OSError as error:
        do = f"name a .toml or .yaml, or one of {', '.join(bundled_names())}"
        raise BadDescription(path, error.strerror or "cannot be read", do=do) from error
    load = _yaml if path.suffix in (".yaml", ".yml") else _toml
    try:
        return load(data)
    except (ValueError, UnicodeDecodeError) as error:
        raise BadDescription(path, str(error), do="correct the text there") from error


def _toml(data: bytes) -> Any:
    try:
        import tomllib
    except ImportError:
        import tomli as tomllib
    return tomllib.loads(data.decode())


def _yaml(data: bytes) -> Any:
    try:
        import yaml
    except ImportError as error:
        do = "pip install pyyaml, or write the description as TOML"
        raise MissingLibrary(f"YAML needs PyYAML: {do}") from error
    try:
        return yaml.safe_load(data)
    except yaml.YAMLError as error:
        raise ValueError(str(error)) from error


def _from_table(top: Any, path: str) -> Description:
    if not isinstance(top, Mapping):
        raise BadDescription(path, "no table of entries", do="see `zerorate simulate --help`")
    _known(top, _TOP, "", path)
    description = Description(
        sensor=_filled(Sensor, top.get("sensor", {}), "sensor", path),
        bias=_filled(Bias, top.get("bias", {}), "bias", path),
        noise=_filled(Noise, top.get("noise", {}), "noise", path),
        sessions=_sessions(top, path),
        channels=dict(top.get("channels", {})),
        effects=list(top.get("effect", [])),
        path=path,
        **{key: top[key] for key in ("name", "seed", "latitude_deg") if key in top},
    )
    for number, session in enumerate(description.sessions, start=1):
        _check_session(session, f"session {number}", path)
    return description


def _sessions(top: Table, path: str) -> list[Session]:
    every = top.get("every_session", {})
    given = top.get("session") or [{}] * int(top.get("sessions", 1))
    return [_filled(Session, {**every, **table}, "session", path) for table in given]


def _check_session(session: Session, where: str, path: str) -> None:
    for segment in session.temperature:
        known = ("to", "s", "minutes", "hours", "degc_per_min", "tau_s", "cycle", "period_minutes")
        _known(segment, known, f"{where}, temperature", path)
        if seconds(segment) is None and not {"to", "degc_per_min"} <= set(segment):
            raise BadDescription(path, f"{where}: a temperature has no duration", do="add minutes")
    for bout in session.motion:
        if bout.get("kind") not in MOTIONS:
            problem = f"{where}: motion {bout.get('kind')!r} is unknown"
            raise BadDescription(path, problem, do=f"choose of {', '.join(MOTIONS)}")
        if not seconds({k: v[0] if isinstance(v, list) else v for k, v in bout.items()}):
            raise BadDescription(path, f"{where}: a motion has no duration", do="add s = 20")
    if session.duration_s <= 0:
        raise BadDescription(path, f"{where} has no duration", do="add minutes = 60")


def _filled(cls: type, table: Any, where: str, path: str) -> Any:
    if not isinstance(table, Mapping):
        raise BadDescription(path, f"{where} is no table", do=f"write [{where}]")
    fields = {f.name: f for f in dataclasses.fields(cls)}
    _known(table, tuple(fields), where, path)
    for key, value in table.items():
        wanted = fields[key].type
        if wanted.startswith("float") and not _is_number(value):
            raise BadDescription(path, f"{where}.{key} is {value!r}", do="write a number")
        if wanted == "Any":
            axes(value, f"{where}.{key}", path)
    return cls(**table)


def _known(table: Table, known: tuple[str, ...], where: str, path: str) -> None:
    for key in table:
        if key not in known:
            place = f"{where}.{key}" if where else str(key)
            raise BadDescription(path, f"{place} is unknown", do=f"choose of {', '.join(known)}")


def axes(value: Any, where: str, path: str) -> np.ndarray:
    """(3,) x y z out of one number or three. Raises BadDescription."""
    values = value if isinstance(value, (list, tuple, np.ndarray)) else [value] * 3
    if len(values) != 3 or not all(_is_number(v) for v in values):
        raise BadDescription(path, f"{where} is {value!r}", do="write one number or [x, y, z]")
    return np.array([float(v) for v in values])


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float, np.number)) and not isinstance(value, bool)
