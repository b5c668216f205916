"""What a new device of the part starts from: the expected curve as the firmware reads it."""

import json
from os import PathLike
from typing import Any

import numpy as np

from ..model import Model, Slot, build_model, write_model
from ..model.term import Term
from ..recordings import Scales
from ..recordings.atomic import written_together
from .part import Part, scale_of

_POINTS = 9


def prior_model(part: Part, scales: Scales) -> Model:
    """The part's mean curve in effect slots: a level, a slope and a bend over temperature.

    Each coefficient is shrunken towards 0 by how unsure the mean is (James and Stein's positive
    part), so that noise is never handed on. The firmware subtracts the curve and learns what the
    new device differs from it by. Raises CannotDeploy.
    """
    slots = []
    for power in range(3):
        mean = np.array([axis.mean[power] for axis in part.axes])
        error = np.array([axis.mean_error[power] for axis in part.axes])
        keep = np.maximum(0.0, 1.0 - (error / np.where(mean == 0, 1e-12, mean)) ** 2)
        value = mean * keep * scale_of(power)
        if value.any() and (power == 0 or scales.temp_lsb_per_degc):
            slots.append(_slot(part, power, (float(value[0]), float(value[1]), float(value[2]))))
    return build_model(slots, scales)


def _slot(part: Part, power: int, per_unit: tuple[float, float, float]) -> Slot:
    if power == 0:
        return Slot(Term("one"), per_unit, "prior: level")
    term = Term("temp", part.low_degc, part.high_degc, part.reference_degc, power)
    return Slot(term, per_unit, f"prior: {('', 'slope', 'curvature')[power]}")


def prior_json(part: Part) -> dict[str, Any]:
    """The expected curve with its spread for people and other programs, dps per axis x y z."""
    found: dict[str, Any] = {
        "devices": int(min(axis.used.sum() for axis in part.axes)),
        "reference_degc": part.reference_degc,
    }
    warm = not np.isnan(part.low_degc)
    degc = np.linspace(part.low_degc, part.high_degc, _POINTS) if warm else np.array([25.0])
    mean, deviation = part.at(degc)
    found["curve"] = [
        {"degc": round(float(t), 2), "bias_dps": m.tolist(), "deviation_dps": d.tolist()}
        for t, m, d in zip(degc, mean, deviation)
    ]
    return found


def write_prior(part: Part, scales: Scales, folder: str | PathLike[str]) -> Model:
    """Write prior.json, model.json and model.bin into a folder: all of them, or none."""
    model = prior_model(part, scales)
    with written_together(folder) as draft:
        text = json.dumps(prior_json(part), indent=1)
        (draft / "prior.json").write_text(text, encoding="utf-8")
        write_model(model, draft)
    return model
