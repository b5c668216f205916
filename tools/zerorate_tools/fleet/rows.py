"""The fleet's one table: a row for each device and effect."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import pyarrow as pa

from .curve import TERMS, UNITS, Curve
from .part import Part, alone, removed_mdps, scale_of

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
    told = [alone(part, axis) for axis in range(3)]
    own = np.stack([axis.own for axis in part.axes], axis=1) @ part.to_centre.T
    p = np.min([axis.p_unusual for axis in part.axes], axis=0)
    found: dict[str, list[dict[str, Any]]] = {}
    for i, (name, curve) in enumerate(zip(part.names, part.curves)):
        values, errors = (np.stack([t[k][i] for t in told]) for k in (0, 1))
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


def _rows(name, curve, values, errors, own) -> list[dict[str, Any]]:
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


def _by_axis(name: str, values) -> dict[str, float | None]:
    there = [None if np.isnan(v) else float(v) for v in values]
    return {f"{name}_{axis}": value for axis, value in zip(_AXES, there)}
