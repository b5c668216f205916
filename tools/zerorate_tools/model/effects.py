"""What a bias can follow: each effect is one row here, and nowhere else.

The search takes its candidates from these rows, the model its slots, the report its words and its
plot, `zerorate simulate` its waveform. To add an effect, add a row (docs/extending.md). Grids are
coarse: what is found is refined afterwards.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .model import TABLE_POINTS
from .term import Term

#: Sources of a row: every recorded channel in turn; every channel whose name says it is a supply.
ANY_CHANNEL, SUPPLY = "any channel", "supply"

#: A channel that switches shows its delay to the block: between the grid's points nothing is seen.
DELAY_STEP_S = 20.0
_DELAYS_S = tuple(DELAY_STEP_S * i for i in range(1, 17))
#: Where the factors of a product are zero; each place takes another share of either factor.
_CENTRES = {"centre": ("mean", "lo", "hi"), "second_centre": ("mean", "lo", "hi")}


@dataclass(frozen=True)
class Effect:
    """kind: its name in reports; source: what it follows, several with a coefficient each; title
    and meaning: what a person calls it, and what it says of the device (of a channel's form the
    title goes behind the channel's name). fields: of its `term.Term`; grids: further fields, the
    values tried for each, `knot` as shares of the range, a centre by name. curve: (n,) -> (n,) in
    the source's unit, for what is no power: the board holds nine points of it. free: a curve of any
    form, as smooth as the recordings say (`loop/fit/smooth.py`).
    """

    kind: str
    source: str | tuple[str, ...]
    title: str
    meaning: str
    fields: Mapping[str, Any] = field(default_factory=dict)
    grids: Mapping[str, tuple[Any, ...] | str] = field(default_factory=dict)
    curve: Callable[[NDArray[Any]], NDArray[Any]] | None = None
    free: bool = False


def table_of(
    curve: Callable[[NDArray[Any]], NDArray[Any]], lo: float, hi: float
) -> tuple[float, ...]:
    """Nine points of a curve over a range, moved and scaled to reach from -1 to 1.

    NaN where the curve has no value there, or the same one everywhere.
    """
    with np.errstate(all="ignore"):
        at = np.asarray(curve(np.linspace(lo, hi, TABLE_POINTS)), float)
        least, most = at.min(), at.max()
        return tuple(np.clip((2 * at - least - most) / (most - least), -1, 1).tolist())


def curve_of(kind: str) -> Callable[[NDArray[Any]], NDArray[Any]]:
    """The curve of a row. Raises KeyError, which names what has one."""
    curves = {row.kind: row.curve for row in EFFECTS if row.curve}
    if kind not in curves:
        raise KeyError(f"no effect {kind} has a curve; these do: {', '.join(curves) or 'none'}")
    return curves[kind]


def is_free(term: Term) -> bool:
    """Whether the nine points of a term's curve were told by recordings, and by no row."""
    tables = (table_of(row.curve, term.lo, term.hi) for row in EFFECTS if row.curve)
    return term.table is not None and term.table not in tables


def of_any_channel(kind: str) -> bool:
    """Whether an effect of that kind is named with its channel: the row is for every channel."""
    return any(row.kind == kind and row.source == ANY_CHANNEL for row in EFFECTS)


EFFECTS: tuple[Effect, ...] = (
    Effect(
        *("temperature-quadratic", "temp", "Bend over temperature"),
        "The bias follows a curve over temperature, where a straight line was assumed.",
        fields={"power": 2},
    ),
    # About another centre than its own it takes a quadratic beside it, and kinks fit better.
    Effect(
        *("temperature-cubic", "temp", "S-shaped bend over temperature"),
        "The bias bends one way when cold and the other way when hot.",
        fields={"power": 3},
        grids={"centre": ("mean", "lo", "hi")},
    ),
    Effect(
        *("temperature-kink", "temp", "Kink over temperature"),
        "Above one temperature the bias follows another slope.",
        grids={"knot": (0.15, 0.25, 0.35, 0.45, 0.55, 0.65, 0.75, 0.85)},
    ),
    Effect(
        *("thermal-rate", "temp", "Rate of temperature"),
        "The bias shifts while the temperature changes, the faster the more, and comes "
        "back when it is held.",
        fields={"lag_mode": "rate"},
        grids={"lag_s": (10.0, 20.0, 40.0)},
    ),
    Effect(
        *("thermal-lag", "temp", "Lag of the thermometer"),
        "The part that makes the bias warms later, or earlier, than the thermometer shows.",
        fields={"lag_mode": "difference"},
        grids={"lag_s": (80.0, 160.0, 320.0, 640.0, 1300.0)},
    ),
    Effect(
        *("thermal-hysteresis", "temp", "Thermal hysteresis"),
        "At one temperature the bias differs between heating and cooling, however slow either is.",
        fields={"memory": "backlash"},
        grids={"width": (0.7, 1.4, 2.8, 5.6, 11.0)},
    ),
    Effect(
        *("temperature-peak", "temp", "Memory of the highest temperature"),
        "The bias depends on the hottest that the part has been since power-on.",
        fields={"memory": "peak"},
    ),
    Effect(
        *("power-on-transient", "one", "Power-on transient"),
        "The bias settles after power-on, whatever the temperature does. It follows time "
        "since power-on; the cause is not identified.",
        grids={"decay_s": (60.0, 120.0, 240.0, 480.0, 960.0, 1900.0, 3800.0)},
    ),
    Effect(
        *("time-drift", "time", "Drift with time"),
        "The bias drifts with time since power-on; the cause is not identified.",
    ),
    Effect(
        *("vibration", "vib", "Vibration"),
        "The bias shifts with the mean square of vibration (rectification).",
    ),
    Effect("supply-voltage", SUPPLY, "Supply voltage", "The bias follows the supply voltage."),
    Effect(
        *("supply-temperature", SUPPLY, "Supply voltage times temperature"),
        "The bias follows the supply voltage, by an amount that depends on temperature.",
        fields={"second": "temp"},
        grids=_CENTRES,
    ),
    Effect(
        *("linear-acceleration", ("acc_x", "acc_y", "acc_z"), "Acceleration"),
        "The bias follows acceleration, gravity's included: it depends on how the device lies.",
    ),
    Effect(
        *("squared-acceleration", ("acc_x", "acc_y", "acc_z"), "Acceleration squared"),
        "The bias follows the square of acceleration, gravity's included.",
        fields={"power": 2, "centre": 0.0},
    ),
    Effect(
        *("rate-scale", ("rate_x", "rate_y", "rate_z"), "Scale factor or cross-axis sensitivity"),
        "The error follows the rate of turn.",
    ),
    Effect("channel", ANY_CHANNEL, "in proportion", "The bias moves in proportion to it."),
    Effect(
        *("channel-lag", ANY_CHANNEL, "lagged"),
        "The bias follows it late, as through a first-order lag.",
        fields={"lag_mode": "lag"},
        grids={"lag_s": (60.0, 180.0, 540.0, 1600.0)},
    ),
    Effect(
        *("channel-product", ANY_CHANNEL, "a product"),
        "The bias follows the product of the two.",
        grids={"second": "every", **_CENTRES},
    ),
    Effect(
        *("channel-rate", ANY_CHANNEL, "its rate of change"),
        "The bias shifts while it changes.",
        fields={"lag_mode": "rate"},
        grids={"lag_s": (40.0, 160.0)},
    ),
    Effect(
        *("channel-peak", ANY_CHANNEL, "memory of its highest value"),
        "The bias depends on its highest value since power-on.",
        fields={"memory": "peak"},
    ),
    Effect(
        *("channel-delay", ANY_CHANNEL, "delayed"),
        "The bias follows it some time later.",
        grids={"delay_s": _DELAYS_S},
    ),
    Effect(
        *("channel-curve", ANY_CHANNEL, "along a curve"),
        "The bias follows it along a smooth curve.",
        free=True,
    ),
    Effect(
        *("channel-lag-curve", ANY_CHANNEL, "lagged, along a curve"),
        "The bias follows it late, as through a first-order lag, along a smooth curve.",
        fields={"lag_mode": "lag"},
        grids={"lag_s": (60.0, 180.0, 540.0)},
        free=True,
    ),
    Effect(
        *("channel-delay-curve", ANY_CHANNEL, "delayed, along a curve"),
        "The bias follows it some time later along a smooth curve.",
        grids={"delay_s": _DELAYS_S},
        free=True,
    ),
)
