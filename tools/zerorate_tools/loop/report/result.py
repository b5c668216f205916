"""What `close` returns and report.json holds, name by name; and in a few lines for a terminal.

Lists of three are x y z. An error is a root mean square on the held-out part, in mdps; None of all
three axes where the loop was closed on motion alone. `ci95` is an interval of 95 %.
"""

from collections.abc import Mapping, Sequence
from typing import Any, Literal, TypedDict

from ...numbers import fixed

ThreeAxes = list[float] | list[None]


class BeforeAfter(TypedDict):
    """Low and high end of an interval, of each axis or of all together."""

    before: list[Any]
    after: list[Any]


class _Split(TypedDict):
    unit: str
    train: list[str]
    test: list[str]


class Split(_Split, total=False):
    """Names of the recordings fitted on and held out; how one recording was cut."""

    block_s: float
    blocks: dict[str, int]
    how_much_weaker: str
    pieces_of: list[str]
    pieces_before_mdps: list[float]
    pieces_after_mdps: list[float]


class _Overall(TypedDict):
    before_mdps: float
    after_mdps: float


class Overall(_Overall, total=False):
    """Root mean squares over three axes together."""

    floor_mdps: float
    ci95_mdps: BeforeAfter


class Online(TypedDict):
    """The error of the firmware that goes on learning, without the effects and with them."""

    before_mdps: list[float]
    after_mdps: list[float]
    ci95_mdps: BeforeAfter
    in_all: Overall


class _Effect(TypedDict):
    effect: str
    sources: list[str]
    parameters: list[dict[str, Any]]
    coefficients: dict[str, list[float]]
    confidence: Literal["confirmed", "tentative"]
    before_mdps: ThreeAxes
    after_mdps: ThreeAxes
    p_value: float
    confounded_with: list[str]
    said: str


class Effect(_Effect, total=False):
    """What was found: what it follows, its slots, and the error before it and with it.

    coefficients: of each slot three, dps per unit of its basis; empty where it corrects nothing;
    lost_by_projection: share of the squares of a curve that one form for all axes loses;
    probabilities: by name, of what it may be, those above 0.05.
    """

    ci95_mdps: list[list[float]]
    likelihood_ratio: float
    noise_inflation: float
    nats_on_sessions_left_out: list[float]
    nats_on_holdout: float
    deviation: dict[str, list[float]]
    amplitude_mdps: list[float]
    in_motion: dict[str, Any]
    lost_by_projection: float
    probabilities: dict[str, float]


class _Event(TypedDict):
    kind: Literal["step"]
    t_us: int
    recording: str
    size_mdps: list[float]
    ci95_mdps: list[list[float]]
    p_value: float


class Event(_Event, total=False):
    """A step of the bias: listed, never corrected."""

    said: str


class _Unexplained(TypedDict):
    what_is_known: str
    measure_next: list[str]


class Unexplained(_Unexplained, total=False):
    """What is left, and what to record next, the most useful first."""

    rms_mdps: list[float]
    cannot_be_shown_by_these_recordings: list[str]


class _LoopReport(TypedDict):
    split: Split
    floor_mdps: ThreeAxes
    before_mdps: ThreeAxes
    after_mdps: ThreeAxes
    ci95_mdps: BeforeAfter
    effects: list[Effect]
    events: list[Event]
    unexplained: Unexplained
    verdict: Literal["nothing-found", "effects-found", "unexplained-residual"]


class LoopReport(_LoopReport, total=False):
    """What `close_loop` returns, a plain dict. `in_motion` is there after motion alone, and then
    nothing that only rests show: measured_by to smallest_detectable_mdps.
    """

    measured_by: str
    in_all: Overall
    online: Online
    turn_on_offset_dps: dict[str, list[list[float]]]
    integer_rounding_mdps: list[float]
    integer_rounding_of_floor: float
    truth: dict[str, str]
    steps: list[Effect]
    interference: list[dict[str, Any]]
    gate: dict[str, Any]
    smallest_detectable_mdps: dict[str, float]
    in_motion: dict[str, Any]


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
