"""A report in plain words: names, meanings and units of effects, and its sentences."""

from collections.abc import Mapping
from typing import Any

from ..loop.motion.by_windows import GIVEN
from ..model import effects
from ..numbers import counted, figure

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


Report = Mapping[str, Any]


#: Less than this share of the error before is left: most of it is explained, or a board gains.
_MOST, _WORTH = 0.5, 0.8


def headline(result: Report) -> str:
    """The answer, plain text: effect, gain on held-out data, gain of a board that learns."""
    return ". ".join(filter(None, (on_held_out(result), on_the_board(result))))


def on_held_out(result: Report) -> str:
    """What was found, and the error without and with it on data that it was not fitted to."""
    whole = result["in_all"]
    before, after, floor = (figure(whole[k]) for k in ("before_mdps", "after_mdps", "floor_mdps"))
    unexplained = result["verdict"] == "unexplained-residual"
    found = [title(e["effect"], e["sources"]) for e in result["effects"] if corrects_at_rest(e)]
    names = list(dict.fromkeys(found))
    left = f"{after} mdps on held-out data (noise floor {floor})"
    if not names:
        nothing = "that the firmware does not already correct"
        why = "that explains the error" if unexplained else nothing
        return f"Nothing was found {_what(result)} {why}: {left}"
    named = capital(", ".join(names[:-1]) + " and " * (len(names) > 1) + names[-1])
    if whole["after_mdps"] >= whole["before_mdps"]:
        return f"{named}: no gain, {before} to {left}"
    share = "most" if whole["after_mdps"] < _MOST * whole["before_mdps"] else "part"
    verb = "explains" if len(names) == 1 else "explain"
    rest = ". No recorded channel explains the rest" if unexplained else ""
    return f"{named} {verb} {share} of the error: {before} to {left}{rest}"


def on_the_board(result: Report) -> str:
    """What is left where the firmware goes on learning; nothing where it was not run."""
    if "online" not in result:
        return ""
    before, after = (result["online"]["in_all"][k] for k in ("before_mdps", "after_mdps"))
    who = "A board that keeps learning at rest"
    if not any(map(corrects_at_rest, result["effects"])):
        return f"{who} leaves {figure(after)} mdps"
    gain = "nothing" if after >= before else "little" if after > _WORTH * before else "too"
    return f"{who} gains {gain}: {figure(before)} to {figure(after)} mdps"


def why_both(result: Report) -> str:
    """Why a report has both figures; nothing where the firmware was not run."""
    if "online" not in result:
        return ""
    if "how_much_weaker" in result["split"]:
        return (
            "The figure of the board includes the first minutes, in which it knows nothing. The "
            "held-out figure is for pieces of the recording, with a model fitted to the others."
        )
    left, held_out = (r["in_all"]["after_mdps"] for r in (result["online"], result))
    little = ", so little error is left with or without a model" if left < held_out else ""
    alone = (
        ", so only the model corrects it" if any(map(corrects_at_rest, result["effects"])) else ""
    )
    return (
        f"A board measures the bias at every rest{little}. The held-out figures are for a device "
        f"that never rests after its first minute{alone}."
    )


def corrects_at_rest(effect: Report) -> bool:
    """Whether it changes what is left at rest: not what shows in motion, or is said only."""
    return bool(effect["coefficients"]) and "in_motion" not in effect


def _what(result: Report) -> str:
    """What was looked at: rests, or motion too, where the true rate is known."""
    beside = result.get("truth", {}).get("in_motion") == GIVEN
    return "in the bias, beside the reference," if beside else "at rest"


def how_sure(effect: Report) -> str:
    """What confirmed or tentative means here."""
    if effect["confidence"] != "confirmed":
        return (
            "Tentative: the fitted recordings show it, but the held-out data do not confirm it. "
            "Record more before you rely on it."
        )
    if not corrects_at_rest(effect):
        return "Confirmed: the held-out data, which took no part in finding it, show it too."
    return (
        "Confirmed: it also lowers the error of the held-out recording, which took no part in "
        "finding it. No smooth or common error beyond the noise is left there."
    )


def uncorrected(effect: Report) -> str:
    """On which axes it is not corrected, and why; empty where on all."""
    _, known, axes = effect["said"].partition("not corrected on ")
    return known + axes


def found_in_short(result: Report) -> str:
    """One sentence on what was found."""
    names = [f"{title(s['effect'], s['sources'])} ({s['confidence']})" for s in result["effects"]]
    if not names:
        return "No effect was found beyond the line over temperature that the firmware learns."
    return f"{counted(len(names), 'effect')} found: {'; '.join(names)}."


def capital(text: str) -> str:
    """With a capital at its beginning."""
    return text[:1].upper() + text[1:]


def sentence(text: str) -> str:
    """With a capital at its beginning and a full stop at its end."""
    return capital(text) + ("" if text.endswith((".", "!", "?")) else ".")
