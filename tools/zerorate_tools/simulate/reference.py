"""Every entry of a description with its default, read off the code that takes it."""

import dataclasses
import inspect
import textwrap
from collections.abc import Callable, Mapping
from typing import Any

from .channels import CHANNELS
from .effects import EFFECTS
from .motion import MOTIONS
from .schema import Bias, Noise, Sensor, Session

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


def reference() -> str:
    """The entries of a description in plain text."""
    tables = (("sensor", Sensor), ("bias", Bias), ("noise", Noise), ("every_session", Session))
    parts = [_HEAD, *(_table(name, cls) for name, cls in tables)]
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
    text = " ".join((inspect.getdoc(kind) or "").split())
    head = textwrap.fill(
        f"  {name:<18} {', '.join(options)}".rstrip(), 98, subsequent_indent=" " * 21
    )
    return f"{head}\n{textwrap.indent(textwrap.fill(text, 90), ' ' * 6)}\n"


def _value(default: object) -> str:
    if default is None:
        return "none"
    return str(default).lower() if isinstance(default, bool) else repr(default).replace("'", '"')
