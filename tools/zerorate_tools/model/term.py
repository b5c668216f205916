"""The float reference of an effect slot: what the firmware's integer kernels compute once per tick.

Order: clamp, centre, delay, [power first], lag or memory, knot, table or power, second source,
decay.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np


@dataclass(frozen=True)
class Term:
    """One slot without its coefficients. Units are those of the source; seconds for `*_s`.

    table: nine values within +-1 at equal distances over the term's range, which take the place of
    its power, or None.
    """

    source: str
    lo: float = -math.inf
    hi: float = math.inf
    centre: float = 0.0
    power: int = 1
    power_first: bool = False
    delay_s: float = 0.0
    lag_s: float = 0.0
    lag_mode: str = "none"  # none, lag, difference, rate
    memory: str = "none"  # none, backlash, play, peak
    width: float = 0.0
    knot: float | None = None
    second: str | None = None
    second_lo: float = -math.inf
    second_hi: float = math.inf
    second_centre: float = 0.0
    decay_s: float = 0.0
    table: tuple[float, ...] | None = None

    def to_dict(self) -> dict[str, Any]:
        """Plain values; infinite limits become None so that the result is valid JSON, and no table
        is left out."""
        values = asdict(self)
        if self.table is None:
            del values["table"]
        return {k: None if isinstance(v, float) and math.isinf(v) else v for k, v in values.items()}

    @classmethod
    def from_dict(cls, values: dict[str, Any]) -> Term:
        infinite = {"lo": -math.inf, "second_lo": -math.inf, "hi": math.inf, "second_hi": math.inf}
        filled: dict[str, Any] = {
            k: infinite[k] if v is None and k in infinite else v for k, v in values.items()
        }
        if filled.get("table"):
            filled["table"] = tuple(filled["table"])
        return cls(**filled)


#: Terms that stand side by side.
Terms = Sequence[Term]


def first_order_lag(u: np.ndarray, lag_s: float, tick_s: float) -> np.ndarray:
    """z += alpha (u - z), z starting at the first u; alpha = 1 - exp(-tick/lag)."""
    alpha = -math.expm1(-tick_s / lag_s)
    from scipy.signal import lfilter  # takes seconds to load on a small computer

    z, _ = lfilter([alpha], [1.0, alpha - 1.0], u, zi=[(1.0 - alpha) * u[0]])
    return z


def delayed(u: np.ndarray, ticks: int) -> np.ndarray:
    """u so many ticks ago; before the power-on, its first value."""
    ticks = min(max(ticks, 0), len(u))
    return np.concatenate([np.full(ticks, u[0]), u[: len(u) - ticks]])


def play(u: np.ndarray, width: float) -> np.ndarray:
    """Backlash (play) operator: p = min(max(p, u - width/2), u + width/2), p starting at the first
    u.
    """
    p, at = [], float(u[0])
    for lower, upper in zip((u - width / 2).tolist(), (u + width / 2).tolist()):
        if at < lower:
            at = lower
        elif at > upper:
            at = upper
        p.append(at)
    return np.array(p)


def _remembered(term: Term, u: np.ndarray, tick_s: float) -> np.ndarray:
    if term.lag_mode != "none":
        z = first_order_lag(u, term.lag_s, tick_s)
        if term.lag_mode == "lag":
            return z
        return u - z if term.lag_mode == "difference" else (u - z) / term.lag_s
    if term.memory in ("backlash", "play"):
        stands = play(u, term.width)
        return stands if term.memory == "play" else stands - u
    if term.memory == "peak":
        return np.maximum.accumulate(u) - u
    return u


def evaluate(term: Term, sources: Callable[[str], np.ndarray], tick_s: float) -> np.ndarray:
    """(m,) basis at each tick. `sources` is called with a name and returns the (m,) tick means."""
    u = np.clip(sources(term.source), term.lo, term.hi) - term.centre
    if term.delay_s:
        u = delayed(u, round(term.delay_s / tick_s))
    if term.power_first:
        u = u**term.power
    v = _remembered(term, u, tick_s)
    if term.knot is not None:
        v = np.maximum(v - term.knot, 0.0)
    if term.table:
        ends = term.lo - term.centre, term.hi - term.centre
        v = np.interp(v, np.linspace(*ends, len(term.table)), term.table)
    elif not term.power_first:
        v = v**term.power
    if term.second is not None:
        v = v * (np.clip(sources(term.second), term.second_lo, term.second_hi) - term.second_centre)
    if term.decay_s:
        v = v * np.exp(-(sources("time") - tick_s / 2) / term.decay_s)
    return v
