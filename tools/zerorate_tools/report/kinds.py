"""Effects and channels in plain words: what each is called, what it means, and its units."""

from typing import Any

from ..model import effects

#: What is found without a row: kind -> what a person calls it, and what it says of the device.
_FOUND_OTHERWISE = {
    "temperature-curve": (
        "Curve over temperature",
        "The bias follows a smooth curve over temperature. The first number below is its slope, "
        "each other one what a bend adds to the slope from there on.",
    ),
    "scale-factor": ("Scale factor", "The rates are too large or too small by a constant share."),
    "cross-axis": ("Cross-axis sensitivity", "A turn about one axis shows on the others."),
    "scale-factor+cross-axis": (
        "Scale factor and cross-axis sensitivity",
        "The rates are off by a constant share, and a turn about one axis shows on the others.",
    ),
    "sample-timing": (
        "Timing of the samples",
        "The readings and those of the reference are not of the same moment. This is no bias.",
    ),
    "periodic-interference": (
        "Periodic interference",
        "Something with a fixed period gets into the rate: a heater's switching, mains, a motor.",
    ),
}


def words_of(kind: str) -> tuple[str, str]:
    """(title, meaning) of a kind; itself and nothing where nobody knows it."""
    rows = {row.kind: (row.title, row.meaning) for row in effects.EFFECTS}
    return rows.get(kind) or _FOUND_OTHERWISE.get(kind, (kind, ""))


_SOURCES = {
    "temp": ("temperature", "°C"),
    "time": ("time since power-on", "s"),
    "one": ("a constant", ""),
    "vib": ("vibration", "g²"),
    **{f"acc_{a}": (f"acceleration along {a}", "g") for a in "xyz"},
    **{f"rate_{a}": (f"rate about {a}", "dps") for a in "xyz"},
}


def quantity(source: str) -> tuple[str, str]:
    """A source's name in words and its unit; a channel of the user's keeps its own name."""
    if source in _SOURCES:
        return _SOURCES[source]
    return source, "mV" if source.endswith("_mv") else ""


def kind_of(effect: str) -> str:
    """The kind in a report's `effect`, which may name channels in brackets."""
    return effect.split("(", 1)[0]


def title(effect: str, sources: list[str] | None = None) -> str:
    """What a person calls the effect."""
    kind = kind_of(effect)
    words = words_of(kind)[0]
    if not effects.of_any_channel(kind):
        return words
    named = sources or [part for part in effect.partition("(")[2].rstrip(")").split(", ") if part]
    channels = " and ".join(quantity(name)[0] for name in named) or "any recorded channel"
    return f"{channels}, {words}"


def meaning(effect: str) -> str:
    """One sentence on what the effect says of the device."""
    said = words_of(kind_of(effect))[1]
    if effects.of_any_channel(kind_of(effect)):
        said += " It is in no catalogue: the mechanism is unknown."
    return said


def per_unit(parameters: dict[str, Any]) -> str:
    """The unit of a coefficient, given a slot's parameters."""
    if parameters.get("table"):
        return "mdps from the middle of its curve to the end"
    unit = _power(quantity(parameters["source"]), parameters.get("power", 1))
    if parameters.get("lag_mode") == "rate":
        unit = f"({unit} per s)"
    if parameters.get("second"):
        unit = f"({unit} × {_power(quantity(parameters['second']), 1)})"
    return "mdps" if parameters["source"] == "one" else f"mdps per {unit}"


def _power(named: tuple[str, str], power: int) -> str:
    name, unit = named
    base = unit or f"unit of {name}"
    return base if power == 1 else f"{base if unit else f'({base})'}{'²' if power == 2 else '³'}"


#: Parameter of a slot -> what it is called, its unit, and the value at which it says nothing.
_PARAMETERS = (
    ("lag_s", "time constant", "s", 0.0),
    ("delay_s", "delay", "s", 0.0),
    ("width", "width", None, 0.0),
    ("knot", "threshold above the centre", None, None),
    ("decay_s", "decay time", "s", 0.0),
    ("limit_dps", "held at the edge beyond", "dps", None),
    ("hz", "frequency", "Hz", None),
    ("period_s", "period", "s", None),
    ("deviation_s", "standard deviation of it", "s", None),
)


def parameters(slot: dict[str, Any]) -> list[tuple[str, float, str]]:
    """(name, value, unit) of what describes the slot beside its coefficients."""
    own = quantity(slot.get("source", ""))[1]
    return [
        (name, slot[key], own if unit is None else unit)
        for key, name, unit, idle in _PARAMETERS
        if slot.get(key, idle) not in (None, idle)
    ]
