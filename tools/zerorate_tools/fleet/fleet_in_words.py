"""What a run of a fleet came to: its table of devices and effects, and words for the terminal."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from ..numbers import counted, listed
from .part import Part, alone, removed_mdps, scale_of
from .population import TERMS, UNITS, Curve
from .prior import SCENARIOS, WAYS

_AXES = "xyz"
SCHEMA = pa.schema(
    [
        ("device", pa.string()),
        ("effect", pa.string()),
        ("kind", pa.string()),
        ("unit", pa.string()),
        *((f"{name}_{axis}", pa.float64()) for name in ("value", "error", "own") for axis in _AXES),
        ("unusual", pa.bool_()),
        ("p_value", pa.float64()),
        ("confidence", pa.string()),
        ("sessions", pa.int32()),
    ]
)


def table_of(results: Sequence[dict[str, Any]], part: Part | None) -> pa.Table:
    """Terms of the curve at 25 degC, then effects that `close` found, device by device.

    value: as the device alone tells it, error: its standard error, own: shrunken towards the part
    where there is one (at the same 25 degC); for effects of `close` the rms that it takes away.
    p_value: of being no more unusual than the others are, or that of the step.
    """
    numbers = {name: i for i, name in enumerate(part.names)} if part is not None else {}
    rows = []
    for result in results:
        steps = [_step_row(step) for step in result["steps"]]
        number = numbers.get(result["device"])
        if part is not None and number is not None:
            p = part.p_unusual[number]
            steps[:0] = _curve_rows(part.curves[number], part.own[number], p)
        elif result["curve"]:
            steps[:0] = _curve_rows(Curve.from_json(result["curve"]))
        of_all = {"device": result["device"], "sessions": len(result["sessions"])}
        rows += [{**of_all, **row} for row in steps]
    return pa.Table.from_pylist(rows, SCHEMA)


def _curve_rows(
    curve: Curve, own: NDArray[Any] | None = None, p: NDArray[Any] | None = None
) -> list[dict[str, Any]]:
    """A row a term that the curve shows; own (3 axes, 3 terms), p (3 terms): of one of a part."""
    values, errors = (of[0] for of in alone([curve]))
    own = np.full((3, 3), np.nan) if own is None else own
    rows = []
    for k, term in enumerate(TERMS):
        row: dict[str, Any] = {"effect": term, "kind": "curve", "unit": UNITS[k]}
        for name, of in (("value", values), ("error", errors), ("own", own)):
            row |= _by_axis(name, of[:, k] * scale_of(k))
        if p is not None:
            row.update(p_value=float(p[k]), unusual=bool(p[k] < 0.05))
        rows.append(row)
    return [row for row in rows if row["effect"] in curve.shown]


def _step_row(step: dict[str, Any]) -> dict[str, Any]:
    told = {name: step[name] for name in ("effect", "p_value", "confidence")}
    return {**told, "kind": "close", "unit": "mdps", **_by_axis("value", removed_mdps(step))}


def _by_axis(name: str, values: Iterable[float]) -> dict[str, float | None]:
    there = [None if np.isnan(v) else float(v) for v in values]
    return {f"{name}_{axis}": value for axis, value in zip(_AXES, there)}


_FAILURES, _NAMES = 10, 8


@dataclass
class Fleet:
    """What a run came to.

    report: what fleet.json holds; resumed: devices that an earlier run had done; tasks: of the
    cluster.
    """

    report: dict[str, Any] = field(default_factory=dict)
    resumed: int = 0
    tasks: int = 0


def in_words(fleet: Fleet) -> str:
    """What was done, what devices have in common, what the prior is worth, and what failed."""
    return "\n".join(_lines(fleet))


def scenario_in_words(name: str) -> str:
    return SCENARIOS[name][0]


def _lines(fleet: Fleet) -> Iterator[str]:
    report = fleet.report
    yield (
        f"{counted(report['devices'], 'device')}, {counted(report['sessions'], 'power-on')}, "
        f"{report['hours']:.1f} hours, {report['samples']:,} samples"
    )
    if fleet.resumed:
        yield f"an earlier run had done {counted(fleet.resumed, 'device')} of these"
    for effect in report["effects"]:
        yield from _effect(effect, report["reference_degc"])
    for step in report["steps"]:
        low, high = step["share_ci95"]
        yield (
            f"{step['effect']}: {step['verdict']}; in {step['devices']} of {step['of_devices']} "
            f"devices ({low:.0%} to {high:.0%})"
        )
    if report["job"] == "close" and not report["steps"]:
        yield "close found no effect in any device"
    if not report["effects"]:
        yield "nothing said of the part: that takes five devices with readings at rest"
    if report["prior"]:
        yield from _prior(report["prior"])
    yield from _failures(report["failures"])


def _effect(effect: dict[str, Any], degc: float) -> Iterator[str]:
    at = f" at {degc:g} degC" if effect["effect"] == "level" else ""
    yield f"{effect['effect']}{at}, {effect['unit']}:"
    rows = zip("xyz", effect["mean"], effect["ci95"], effect["deviation_between_devices"])
    for (axis, mean, (low, high), deviation), verdict in zip(rows, effect["verdict"]):
        yield (
            f"  {axis}: mean {mean:+.3g} ({low:+.3g} to {high:+.3g}), "
            f"devices differ by {deviation:.2g}: {verdict}"
        )
    if effect["unusual_devices"]:
        yield f"  unlike the others: {listed(effect['unusual_devices'], _NAMES)}"


def _prior(prior: dict[str, Any]) -> Iterator[str]:
    tried = prior["benefit"]
    yield f"a prior from {prior['devices']} devices: prior/model.bin"
    if not tried:
        yield "  not tried on other devices: that takes ten"
        return
    yield (
        f"  tried on {tried['devices']} devices that it was not made from: error in the first "
        f"{tried['minutes']:g} minutes, mdps, median (95 % of devices below):"
    )
    for name, reason in list(tried["failed"].items())[:_FAILURES]:
        yield f"  not tried on {name}: {reason}"
    for name, found in tried["scenarios"].items():
        both = ", ".join(
            f"{words} {_mdps(found[way]['median_mdps'])} ({_mdps(found[way]['p95_mdps'])})"
            for way, words in WAYS.items()
        )
        yield f"  {scenario_in_words(name)}: {both}"


def _mdps(value: float) -> str:
    """Three digits, and no power of ten where there are more before the point."""
    return f"{value:,.0f}" if value >= 999.5 else f"{value:.3g}"


def _failures(failures: list[dict[str, str]]) -> Iterator[str]:
    if not failures:
        return
    yield f"{len(failures)} left out:"
    for failure in failures[:_FAILURES]:
        reason = failure["reason"].removeprefix(failure["file"]).lstrip(": ")
        yield f"  {failure['file']}: {reason}"
    if len(failures) > _FAILURES:
        yield f"  and {len(failures) - _FAILURES} more, all in fleet.json"
