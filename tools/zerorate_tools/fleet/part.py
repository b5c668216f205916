"""What a fleet of one part has in common, and what belongs to single devices."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy import stats

from . import population

_SHOWN = 0.05
_MOSTLY = 0.75


@dataclass(frozen=True)
class Part:
    """The curve over temperature of a part, estimated from its devices.

    axes: a Population for each axis, of the coefficients at reference_degc; names: of its devices;
    low_degc, high_degc: between these temperatures nearly all devices were seen.
    """

    names: list[str]
    curves: list[population.Curve]
    axes: list[population.Population]
    reference_degc: float
    low_degc: float
    high_degc: float

    @property
    def to_centre(self) -> np.ndarray:
        """(3, 3) that takes coefficients at the reference to those at 25 degC, exactly."""
        return np.linalg.inv(_moved(self.reference_degc))

    @property
    def own(self) -> np.ndarray:
        """(n, 3 axes, 3 terms) each device's shrunken coefficients at 25 degC."""
        return np.stack([axis.own for axis in self.axes], axis=1) @ self.to_centre.T

    @property
    def p_unusual(self) -> np.ndarray:
        """(n, 3 terms) of the axis that lies furthest from the others."""
        return np.min([axis.p_unusual for axis in self.axes], axis=0)

    def at(self, degc: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Mean curve and its deviation between devices, (n, 3) dps each, at temperatures (n,)."""
        basis = np.vander(
            (np.asarray(degc, float) - self.reference_degc) * population.PER_DEGC, 3, True
        )
        mean = np.stack([basis @ axis.mean for axis in self.axes], axis=1)
        variance = [np.einsum("ni,ij,nj->n", basis, axis.spread, basis) for axis in self.axes]
        return mean, np.sqrt(np.stack(variance, axis=1))


def part_of(names: Sequence[str], curves: Sequence[population.Curve]) -> Part | None:
    """Estimate a part; None for fewer than five devices."""
    if len(names) < population.LEAST_DEVICES:
        return None
    seen = np.array([[c.low_degc, c.high_degc] for c in curves])
    reference, low, high = population.CENTRE_DEGC, float("nan"), float("nan")
    if not np.isnan(seen).any():
        reference = float(np.round(np.median(seen.mean(axis=1))))
        low, high = float(np.quantile(seen[:, 0], 0.05)), float(np.quantile(seen[:, 1], 0.95))
    back = np.linalg.inv(_moved(reference))
    information = np.stack([back.T @ c.information @ back for c in curves])
    score = np.stack([c.score @ back for c in curves])
    axes = [population.population(information[:, a], score[:, a]) for a in range(3)]
    return Part(list(names), list(curves), axes, reference, low, high)


def _moved(reference_degc: float) -> np.ndarray:
    """(3, 3) that takes coefficients at the centre to those at the reference."""
    by = (reference_degc - population.CENTRE_DEGC) * population.PER_DEGC
    return np.array([[1, by, by**2], [0, 1, 2 * by], [0, 0, 1]])


def scale_of(term: int) -> float:
    """From a coefficient per tens of degC to one per degC."""
    return population.PER_DEGC**term


def curve_effects(part: Part) -> list[dict[str, Any]]:
    """Per term of the curve what the part has in common, plain values, per axis x y z.

    verdict: `common` where the mean is shown (p < 0.05, corrected for all nine) and larger than
    the deviation between devices; `common, and by device` where it is shown but smaller; `by
    device` where only devices that differ are shown, by more than by noise; else `not shown`.
    share_beyond_noise: of the devices' variance (I^2 of Higgins and Thompson 2002).
    """
    effects = []
    for term, (name, unit) in enumerate(zip(population.TERMS, population.UNITS)):
        if not any(name in c.shown for c in part.curves):
            continue
        scale = scale_of(term)
        of_axes = [
            {
                "mean": float(axis.mean[term] * scale),
                "ci95": (axis.interval()[term] * scale).tolist(),
                "deviation_between_devices": float(axis.deviation[term] * scale),
                "p_mean": min(1.0, 9 * float(axis.p_mean()[term])),
                **_differ(part, number, term),
            }
            for number, axis in enumerate(part.axes)
        ]
        effects.append(
            {
                "effect": name,
                "unit": unit,
                **{key: [of[key] for of in of_axes] for key in of_axes[0]},
                "verdict": [_verdict(of) for of in of_axes],
                "devices": sum(name in c.shown for c in part.curves),
                "unusual_devices": _unusual(part, term),
            }
        )
    return effects


def _verdict(of: dict[str, Any]) -> str:
    if of["p_mean"] < _SHOWN:
        larger = abs(of["mean"]) > of["deviation_between_devices"]
        return "common" if larger else "common, and by device"
    # slow noise of one power-on looks like a curve, and an error told by it alone is too small
    differ = of["p_devices_differ"] < _SHOWN and of["share_beyond_noise"] > _MOSTLY
    return "by device" if differ else "not shown"


def _differ(part: Part, axis: int, term: int) -> dict[str, float]:
    """Cochran's Q: probability of devices so different by noise alone (of nine such tests), and
    the share of their variance beyond it."""
    curves = [c for c in part.curves if population.TERMS[term] in c.shown]
    if len(curves) < 2:
        return {"p_devices_differ": 1.0, "share_beyond_noise": 0.0}
    values, errors = (of[:, axis, term] for of in alone(curves))
    weight = errors**-2.0
    mean = (weight * values).sum() / weight.sum()
    q = (weight * (values - mean) ** 2).sum()
    expected = len(curves) - 1
    return {
        "p_devices_differ": min(1.0, 9 * float(stats.chi2.sf(q, expected))),
        "share_beyond_noise": float(1 - expected / max(q, expected)),
    }


def alone(curves: Sequence[population.Curve]) -> tuple[np.ndarray, np.ndarray]:
    """(n, 3 axes, 3 terms) coefficients at 25 degC as each device alone tells them, and errors."""
    covariance = np.linalg.inv(np.stack([c.information for c in curves]))
    values = np.einsum("naij,naj->nai", covariance, np.stack([c.score for c in curves]))
    return values, np.sqrt(covariance.diagonal(axis1=2, axis2=3))


def _unusual(part: Part, term: int) -> list[str]:
    """Devices that differ from all others, for which nothing common explains them."""
    rows = zip(part.names, part.curves, part.p_unusual[:, term])
    return [name for name, curve, p in rows if p < _SHOWN and population.TERMS[term] in curve.shown]


def step_effects(results: Sequence[dict[str, Any]]) -> list[dict[str, Any]]:
    """Per effect that `close` found in some device: in how many, with an interval, how large.

    verdict: `common` where at least half of such devices have it beyond doubt (Wilson's interval of
    95 %), `of single devices` where fewer than half, else `undecided`.
    """
    found: dict[str, list[tuple[str, dict[str, Any]]]] = {}
    for result in results:
        for step in {s["effect"]: s for s in result["steps"]}.values():
            found.setdefault(step["effect"], []).append((result["device"], step))
    total = len(results)
    return [_step_effect(label, rows, total) for label, rows in sorted(found.items())]


def _step_effect(label: str, rows: list[tuple[str, dict[str, Any]]], total: int) -> dict[str, Any]:
    interval = stats.binomtest(len(rows), total).proportion_ci(method="wilson")
    removed = np.array([removed_mdps(step) for _, step in rows])
    verdict = "undecided"
    if interval.low >= 0.5:
        verdict = "common"
    elif interval.high < 0.5:
        verdict = "of single devices"
    return {
        "effect": label,
        "unit": "mdps",
        "devices": len(rows),
        "of_devices": total,
        "share_ci95": [float(interval.low), float(interval.high)],
        "confirmed": sum(step["confidence"] == "confirmed" for _, step in rows),
        "removed_mdps_median": np.median(removed, axis=0).tolist(),
        "verdict": verdict,
        "found_in": [name for name, _ in rows],
    }


def removed_mdps(step: dict[str, Any]) -> list[float]:
    """Per axis the rms that a step of `close` takes away on its held-out data; below 0 it adds."""
    before, after = np.array(step["before_mdps"]), np.array(step["after_mdps"])
    square = before**2 - after**2
    return (np.sign(square) * np.sqrt(np.abs(square))).tolist()
