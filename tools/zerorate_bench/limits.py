"""What the figures of cost and accuracy must be, and whether they are."""

from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from typing import Any

from .tables import number, table

OURS = "zerorate"
SESSION_2 = {
    "all": {"warm-up-a": 1.2, "warm-up-b": 3.5, "warm-up-c": 14.0},
    "first": {"warm-up-a": 3.0, "warm-up-b": 10.0, "warm-up-c": 15.0},
}
_PARTS = {"all": "RMS", "first": "first 15 s"}


@dataclass(frozen=True)
class Limit:
    """A figure's bound. measured: takes all figures, raises KeyError or TypeError without it."""

    figure: str
    bound: float
    unit: str
    measured: Callable[[Mapping[str, Any]], float]
    at_least: bool = False

    def verdict(self, found: Mapping[str, Any]) -> dict[str, Any]:
        """figure, measured, at_most or at_least, unit, met; None where nothing was measured."""
        value, met = None, None
        with suppress(KeyError, TypeError):
            value = float(self.measured(found))
            met = value >= self.bound if self.at_least else value <= self.bound
        kind = "at_least" if self.at_least else "at_most"
        bound = {"figure": self.figure, "measured": value, kind: self.bound}
        return {**bound, "unit": self.unit, "met": met}


def _native(figure: str, how: str = "alone") -> Callable[[Mapping[str, Any]], float]:
    return lambda found: found["native"]["thumb"][how][figure]


def _against_c(processor: str, how: str) -> Callable[[Mapping[str, Any]], float]:
    def ratio(found: Mapping[str, Any]) -> float:
        one = found["native"][processor][how]
        return one["instructions"] / one["instructions_c"]

    return ratio


def _growth(found: Mapping[str, Any]) -> float:
    peaks = [of["peak_bytes"] for of in found["replay_by_hours"].values()]
    return peaks[-1] / peaks[0]


def _error(name: str, part: str) -> Callable[[Mapping[str, Any]], float]:
    return lambda found: found["session_2_rms_mdps"][name][OURS][part]


COST = (
    *(
        Limit(f"instructions against C -O2, {name}, {how}", 1.05, "x", _against_c(processor, how))
        for processor, name in (("thumb", "Cortex-M0+"), ("rv32", "RV32"))
        for how in ("alone", "bursts")
    ),
    Limit("cycles in the kernel alone, median", 600, "cycles", _native("cycles")),
    Limit("cycles in the kernel alone, worst", 13000, "cycles", _native("cycles_worst")),
    Limit("cycles a sample in bursts", 500, "cycles", _native("cycles", "bursts")),
    Limit("heap an update", 0, "bytes", lambda f: f["heap_bytes_per_update"]),
    Limit("replay on one core", 2e6, "samples/s", lambda f: f["replay_samples_per_s"], True),
    Limit("replay's memory, longest against shortest", 1.2, "x", _growth),
)
ACCURACY = tuple(
    Limit(f"session 2, {_PARTS[part]}, {name[-1].upper()}", bound, "mdps", _error(name, part))
    for part, bounds in SESSION_2.items()
    for name, bound in bounds.items()
)


def verdicts(found: Mapping[str, Any], limits: tuple[Limit, ...]) -> list[dict[str, Any]]:
    """Each limit beside its figure, as `Limit.verdict` has it."""
    return [limit.verdict(found) for limit in limits]


def limits_table(found: list[dict[str, Any]]) -> str:
    """Markdown: figure, measured, bound, met."""
    rows = []
    for verdict in found:
        value, unit = verdict["measured"], verdict["unit"]
        measured = "not measured" if value is None else f"{number(value)} {unit}"
        kind = "at_least" if "at_least" in verdict else "at_most"
        bound = f"{kind.replace('_', ' ')} {verdict[kind]:,.10g} {unit}"
        met = {True: "yes", False: "**no**", None: "-"}[verdict["met"]]
        rows.append([verdict["figure"], measured, bound, met])
    return table(["figure", "measured", "must be", "met"], rows)
