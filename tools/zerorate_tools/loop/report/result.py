"""What `close` returns and report.json holds, name by name.

Lists of three are x y z. An error is a root mean square on the held-out part, in mdps; None of all
three axes where the loop was closed on motion alone. `ci95` is an interval of 95 %.
"""

from typing import Any, Literal, TypedDict

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
