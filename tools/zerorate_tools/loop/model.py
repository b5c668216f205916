"""The found effects as slots of a model that the firmware runs."""

from __future__ import annotations

import numpy as np

from ..model import Model, Slot, build_model
from .select import Selection


def slots(selection: Selection, coefficients: np.ndarray) -> list[Slot]:
    """Slots in the order found. coefficients: (straight line and terms, 3) dps, as deployed."""
    kinds = [f.candidate.kind for f in selection.found for _ in f.candidate.terms]
    rows = coefficients[len(selection.straight) :]
    return [
        Slot(term, tuple(float(c) for c in row), kind)
        for kind, term, row in zip(kinds, selection.terms, rows)
    ]


def model_of(analysis, scales) -> Model:
    """The model of an analysis, every number as the integers hold it. Raises CannotDeploy."""
    found = slots(analysis.selection, analysis.coefficients)
    return build_model(found, scales, tick_s=analysis.sessions[0].tick_s)
