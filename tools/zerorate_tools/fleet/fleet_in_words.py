"""What a run of a fleet came to: its table of devices and effects, and words for the terminal."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from .part import Part, alone, removed_mdps, scale_of
from .population import TERMS, UNITS, Curve

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
    of_part = _curve_rows(part) if part is not None else {}
    rows = []
    for result in results:
        name = result["device"]
        curve = Curve.from_json(result["curve"]) if result["curve"] else None
        own = of_part.get(name) or (_lone_rows(name, curve) if curve is not None else [])
        for row in [*own, *_step_rows(result)]:
            rows.append({**row, "sessions": len(result["sessions"])})
    return pa.Table.from_pylist(rows, SCHEMA)


def _curve_rows(part: Part) -> dict[str, list[dict[str, Any]]]:
    fits = [alone(part, axis) for axis in range(3)]
    own = np.stack([axis.own for axis in part.axes], axis=1) @ part.to_centre.T
    p = np.min([axis.p_unusual for axis in part.axes], axis=0)
    found: dict[str, list[dict[str, Any]]] = {}
    for i, (name, curve) in enumerate(zip(part.names, part.curves)):
        values, errors = (np.stack([t[k][i] for t in fits]) for k in (0, 1))
        rows = _rows(name, curve, values, errors, own[i])
        for row in rows:
            term = TERMS.index(row["effect"])
            row.update(p_value=float(p[i, term]), unusual=bool(p[i, term] < 0.05))
        found[name] = rows
    return found


def _lone_rows(name: str, curve: Curve) -> list[dict[str, Any]]:
    covariance = np.linalg.inv(curve.information)
    values = np.einsum("aij,aj->ai", covariance, curve.score)
    errors = np.sqrt(covariance.diagonal(axis1=1, axis2=2))
    return _rows(name, curve, values, errors, np.full((3, 3), np.nan))


def _rows(
    name: str, curve: Curve, values: NDArray[Any], errors: NDArray[Any], own: NDArray[Any]
) -> list[dict[str, Any]]:
    """values, errors, own: (3 axes, 3 terms)."""
    return [
        {
            "device": name,
            "effect": term,
            "kind": "curve",
            "unit": UNITS[k],
            **_by_axis("value", values[:, k] * scale_of(k)),
            **_by_axis("error", errors[:, k] * scale_of(k)),
            **_by_axis("own", own[:, k] * scale_of(k)),
        }
        for k, term in enumerate(TERMS)
        if term in curve.shown
    ]


def _step_rows(result: dict[str, Any]) -> list[dict[str, Any]]:
    return [
        {
            "device": result["device"],
            "effect": step["effect"],
            "kind": "close",
            "unit": "mdps",
            **_by_axis("value", removed_mdps(step)),
            "p_value": step["p_value"],
            "confidence": step["confidence"],
        }
        for step in result["steps"]
    ]


def _by_axis(name: str, values: Iterable[float]) -> dict[str, float | None]:
    there = [None if np.isnan(v) else float(v) for v in values]
    return {f"{name}_{axis}": value for axis, value in zip(_AXES, there)}


_FAILURES, _NAMES = 10, 8
_SCENARIOS = {
    "never-at-rest": "never at rest",
    "at-rest-for-10-s": "at rest for 10 s, then moving",
    "always-at-rest": "always at rest",
}
WAYS = {
    "without": "without a prior",
    "prior": "with the prior",
}


@dataclass
class Fleet:
    """What a run came to.

    report: what fleet.json holds; resumed: devices that an earlier run had done; tasks, peak_bytes
    busy_s and cpu_s: tasks of the cluster, the largest worker's memory and the seconds that all
    tasks took, by the clock and by the processor;
    start_s, work_s, conclude_s: seconds until the cluster stood, until the last device was done,
    and from then on.
    """

    report: dict[str, Any] = field(default_factory=dict)
    resumed: int = 0
    tasks: int = 0
    peak_bytes: int = 0
    busy_s: float = 0.0
    cpu_s: float = 0.0
    start_s: float = 0.0
    work_s: float = 0.0
    conclude_s: float = 0.0


def in_words(fleet: Fleet) -> str:
    """What was done, what devices have in common, what the prior is worth, and what failed."""
    return "\n".join(_lines(fleet))


def scenario_in_words(name: str) -> str:
    """A scenario of the prior's trial for people."""
    return _SCENARIOS[name]


def _lines(fleet: Fleet) -> Iterator[str]:
    report = fleet.report
    yield (
        f"{report['devices']} devices, {report['sessions']} power-ons, "
        f"{report['hours']:.1f} hours, {report['samples']:,} samples"
    )
    if fleet.resumed:
        yield f"{fleet.resumed} of these devices were done by an earlier run"
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
        yield f"  unlike the others: {_some(effect['unusual_devices'])}"


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
        yield f"  {_SCENARIOS[name]}: {both}"


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


def _some(names: list[str]) -> str:
    more = f" and {len(names) - _NAMES} more" if len(names) > _NAMES else ""
    return ", ".join(names[:_NAMES]) + more
