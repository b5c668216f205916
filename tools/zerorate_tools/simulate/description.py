"""A simulated device's description: TOML, YAML or a dict, checked before anything runs."""

import dataclasses
import inspect
import textwrap
from collections.abc import Callable, Mapping
from os import PathLike
from pathlib import Path
from typing import Any

from ..bounds import bytes_of
from ..errors import BadDescription, MissingLibrary
from . import schema
from .channels import CHANNELS, seconds
from .effects import EFFECTS, TIMING
from .motion import FACES, MOTIONS
from .schema import Bias, Description, Noise, Sensor, Session, Table, Wrong

_TOP = (
    *("name", "seed", "latitude_deg", "sensor", "bias", "noise", "every_session", "session"),
    *("sessions", "channels", "effect"),
)
_SEGMENT = ("to", "s", "minutes", "hours", "degc_per_min", "tau_s", "cycle", "period_minutes")
_POSITIVE = ("s", "minutes", "hours", "degc_per_min", "tau_s", "period_minutes")
_LONGEST_S = 366 * 86400.0
_HEAD = """\
name, seed, latitude_deg (Earth's rotation is then in it), sessions = N or one [[session]] each

A path (temperature, or a channel of kind path) is a list of segments, each with s, minutes or
hours: { to } a ramp (or { to, degc_per_min }), { to, tau_s } an exponential, { cycle,
period_minutes } a sine of that amplitude, { minutes } alone a hold.
Motion is a list of bouts, each with kind and s, minutes or hours, repeated to the end.
"""
_EFFECTS = """\
An effect takes dps = [x, y, z] per unit of what follows; or rms_dps (one number or [x, y, z]), its
size over the still samples of all sessions about each session's mean, with beyond_temperature =
true of what a common parabola over temperature leaves of it. session = N: in that one alone.

  timing             delay_ms, clock_ppm, jitter_us: readings late, stamps fast, stamps unsteady
"""
_CHANNELS = """\
A channel takes recorded = false (a hidden cause), lsb = unit of a count, noise = rms of a reading.

  copy               of
"""


def load_description(source: str | PathLike[str] | Table | Description) -> Description:
    """Read .toml, .yaml or .yml, a bundled scenario's bare name, or a dict.

    Raises BadDescription naming the entry, MissingLibrary without the reader it needs.
    """
    if isinstance(source, Description):
        return source
    if isinstance(source, Mapping):
        return _from_table(source, "description")
    path = bundled(str(source)) or Path(source)
    return _from_table(parsed(path), str(path))


def bundled(name: str) -> Path | None:
    """The path of a scenario that ships with the tools, or None."""
    path = Path(__file__).parent / "scenarios" / f"{name}.toml"
    return path if "/" not in name and path.is_file() else None


def bundled_names() -> list[str]:
    return sorted(path.stem for path in (Path(__file__).parent / "scenarios").glob("*.toml"))


def parsed(path: Path) -> Any:
    """The tables of a description's file, not looked at yet. Raises as load_description."""
    do = f"name a .toml or .yaml, or one of {', '.join(bundled_names())}"
    data = bytes_of(path, do, BadDescription)
    load = _yaml if path.suffix in (".yaml", ".yml") else _toml
    try:
        return load(data)
    except RecursionError as error:
        raise BadDescription(path, "nested too deeply", do="correct the text there") from error
    except ValueError as error:
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
        raise MissingLibrary("yaml") from error
    try:
        return yaml.safe_load(data)
    except yaml.YAMLError as error:
        raise ValueError(str(error)) from error


def _from_table(top: Any, path: str) -> Description:
    with schema.read_from(path):
        return _checked(top, path)


def _checked(top: Any, path: str) -> Description:
    if not isinstance(top, Mapping):
        raise Wrong("no table of entries", "see `zerorate simulate --entries`")
    schema.known(top, _TOP, "")
    description = Description(
        sensor=schema.filled(Sensor, top.get("sensor", {}), "sensor"),
        bias=schema.filled(Bias, top.get("bias", {}), "bias"),
        noise=schema.filled(Noise, top.get("noise", {}), "noise"),
        sessions=_sessions(top),
        channels=_channels(top),
        effects=_effects(top),
        path=path,
        **_scalars(top),
    )
    for key in ("odr_hz", "gyro_lsb_per_dps", "temp_step_lsb"):
        if getattr(description.sensor, key) <= 0:
            raise Wrong(f"sensor.{key} is not above 0", "write a number above 0")
    for number, session in enumerate(description.sessions, start=1):
        _check_session(session, f"session {number}")
    return description


def _sessions(top: Table) -> list[Session]:
    every = schema.table(top.get("every_session", {}), "every_session")
    number = top.get("sessions", 1)
    if not isinstance(number, int) or not 1 <= number <= 10000:
        raise Wrong(f"sessions is {number!r}", "write 1 or more")
    given = schema.tables(top.get("session", []), "session") or [{}] * number
    return [schema.filled(Session, {**every, **one}, "session") for one in given]


def _channels(top: Table) -> dict[str, Table]:
    given = schema.table(top.get("channels", {}), "channels")
    return {name: schema.table(one, f"channels.{name}") for name, one in given.items()}


def _effects(top: Table) -> list[Table]:
    given = schema.tables(top.get("effect", []), "effect")
    for effect in given:
        kind = effect.get("kind")
        if kind == "timing":
            schema.known(effect, ("kind", *TIMING), "effect timing")
            for key in TIMING:
                schema.check_value(effect.get(key, 0.0), float, f"effect timing.{key}")
        elif str(kind) not in EFFECTS:
            raise Wrong(f"effect {kind!r} is unknown", f"choose of {', '.join(EFFECTS)}, timing")
    return given


def _scalars(top: Table) -> dict[str, Any]:
    given = {key: top[key] for key in ("name", "seed", "latitude_deg") if key in top}
    if not isinstance(given.get("name", ""), str):
        raise Wrong(f"name is {given['name']!r}", "write it in quotes")
    seed = given.get("seed", 0)
    if not isinstance(seed, int) or seed < 0:
        raise Wrong(f"seed is {seed!r}", "write an integer of 0 or more")
    if not schema.is_number(given.get("latitude_deg", 0)):
        raise Wrong(f"latitude_deg is {given['latitude_deg']!r}", "write degrees")
    return given


def _check_session(session: Session, where: str) -> None:
    if session.face not in FACES:
        raise Wrong(f"{where}: face is {session.face!r}", f"choose of {', '.join(FACES)}")
    for segment in session.temperature:
        _check_segment(segment, f"{where}, temperature")
    for bout in session.motion:
        _check_bout(bout, where)
    if not 0 < session.duration_s < _LONGEST_S:
        raise Wrong(f"{where} has no duration", "add minutes = 60")


def _check_segment(segment: Table, where: str) -> None:
    schema.known(segment, _SEGMENT, where)
    for key, value in segment.items():
        if not schema.is_number(value) or (key in _POSITIVE and value <= 0):
            above = " above 0" if key in _POSITIVE else ""
            raise Wrong(f"{where}: {key} is {value!r}", f"write a number{above}")
    if "cycle" in segment and "period_minutes" not in segment:
        raise Wrong(f"{where}: a cycle has no period", "add period_minutes = 20")
    if seconds(segment) is None and not {"to", "degc_per_min"} <= set(segment):
        raise Wrong(f"{where}: a temperature has no duration", "add minutes = 10")


def _check_bout(bout: Table, where: str) -> None:
    kind = bout.get("kind")
    if str(kind) not in MOTIONS:
        raise Wrong(f"{where}: motion {kind!r} is unknown", f"choose of {', '.join(MOTIONS)}")
    for key, value in bout.items():
        if schema.is_pair(value) and not (
            all(map(schema.is_number, value)) and value[0] <= value[1]
        ):
            raise Wrong(f"{where}: {key} is {value!r}", "write [low, high]")
    lengths = [bout[key] for key in ("s", "minutes", "hours") if key in bout]
    shortest = [value[0] if schema.is_pair(value) else value for value in lengths]
    if not lengths or not all(schema.is_number(value) and value > 0 for value in shortest):
        raise Wrong(f"{where}: a motion has no duration", "add s = 20")


def reference() -> str:
    """The entries of a description in plain text."""
    schemas = (("sensor", Sensor), ("bias", Bias), ("noise", Noise), ("every_session", Session))
    parts = [_HEAD, *(_table(name, cls) for name, cls in schemas)]
    parts.append("motion = [{ kind = ... }]\n\n" + _kinds(MOTIONS))
    parts.append("[channels.NAME]\n" + _CHANNELS + _kinds(CHANNELS))
    parts.append("[[effect]]\n" + _EFFECTS + _kinds(EFFECTS))
    return "\n".join(parts)


def _table(name: str, cls: type) -> str:
    entries = [
        f"  {field.name} = {_value(field.default)}"
        for field in dataclasses.fields(cls)
        if field.default is not dataclasses.MISSING
    ]
    return f"[{name}]  {inspect.getdoc(cls)}\n\n" + "\n".join(entries) + "\n"


def _kinds(kinds: Mapping[str, Callable[..., Any]]) -> str:
    return "".join(_kind(name, kind) for name, kind in kinds.items())


def _kind(name: str, kind: Callable[..., Any]) -> str:
    options = [
        option.name if option.default is option.empty else f"{option.name}={_value(option.default)}"
        for option in inspect.signature(kind).parameters.values()
        if option.kind is option.KEYWORD_ONLY
    ]
    head = textwrap.fill(
        f"  {name:<18} {', '.join(options)}".rstrip(), 98, subsequent_indent=" " * 21
    )
    text = textwrap.fill(" ".join((inspect.getdoc(kind) or "").split()), 90)
    return f"{head}\n{textwrap.indent(text, ' ' * 6)}\n"


def _value(default: object) -> str:
    if default is None:
        return "none"
    return str(default).lower() if isinstance(default, bool) else repr(default).replace("'", '"')
