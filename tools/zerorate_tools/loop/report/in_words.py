"""A report in a few lines for a terminal."""

from collections.abc import Mapping, Sequence
from typing import Any

from ...numbers import fixed
from .result import Effect, Event, Split


def in_words(result: Mapping[str, Any]) -> str:
    """How good it is now, what was found and how sure, what is left, what to record next."""
    lines = [
        _judged_on(result["split"]),
        f"error before  {_axes(result['before_mdps'])}",
        f"error after   {_axes(result['after_mdps'])}",
        f"noise floor   {_axes(result['floor_mdps'])}",
    ]
    lines += [_effect(effect) for effect in result["effects"]] or [
        "found: nothing, so nothing is deployed"
    ]
    lines += [f"withdrawn: {what}: {why}" for what, why in result["gate"]["withdrawn"]]
    lines += [_event(event) for event in result["events"]]
    lines += [_line(line) for line in result["interference"]]
    unexplained = result["unexplained"]
    lines.append(f"remaining error: {unexplained['what_is_known']}")
    lines += [f"next: {what}" for what in unexplained["measure_next"]]
    lines += [f"note: {note}" for note in result["gate"]["notes"]]
    lines += [
        f"channel {n} not used: {why}" for n, why in result["gate"]["channels_dropped"].items()
    ]
    if "how_much_weaker" in result["split"]:
        lines.append(result["split"]["how_much_weaker"])
    return "\n".join(lines)


def _judged_on(split: Split) -> str:
    names = ", ".join(split["test"])
    if "how_much_weaker" in split:
        return f"judged on pieces of {names}, each by a model fitted to the others"
    said = f"judged on {names}, which nothing was fitted to"
    if "pieces_of" not in split:
        return said
    pieces = split["pieces_before_mdps"], split["pieces_after_mdps"]
    before, after = map(_axes, pieces)
    return f"{said}\nand on pieces of {', '.join(split['pieces_of'])}: {before} -> {after}"


def _axes(mdps: Sequence[float]) -> str:
    return "  ".join(f"{a} {v:8.3f}" for a, v in zip("xyz", mdps)) + "  mdps"


def _effect(effect: Effect) -> str:
    each = effect.get("probabilities", {})
    tie = ": " + ", ".join(f"{name} {p:.2g}" for name, p in each.items()) if len(each) > 1 else ""
    said = effect["said"].removeprefix(effect["effect"]).strip()
    return f"found: {effect['effect']} {said}".rstrip() + f" ({effect['confidence']}){tie}"


def _event(event: Event) -> str:
    sizes = ", ".join(fixed(v, 2, "+") for v in event["size_mdps"])
    at = event["t_us"] / 1e6
    said = f"; {event['said']}" if "said" in event else ""
    where = f"step in {event['recording']} at {at:.0f} s"
    return f"{where}: {sizes} mdps (listed, never corrected){said}"


def _line(line: Mapping[str, Any]) -> str:
    sizes = ", ".join(f"{v:.2f}" for v in line["size_mdps"])
    return (
        f"a line at {line['hz']:.5g} Hz of {sizes} mdps (listed: it averages out of the bias; one "
        "that moves when the data rate moves by 2 % is an alias)"
    )
