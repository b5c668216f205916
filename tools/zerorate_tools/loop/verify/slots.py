"""The found effects as slots of a model that the firmware runs."""

import numpy as np

from ...model import Model, Slot, build_model
from ...model.binding import binding_of
from ..fit.line import deployed
from ..motion.in_motion import slots_of
from ..search.selection import Selection


def slots(selection: Selection, coefficients: np.ndarray) -> list[Slot]:
    """Slots in the order found. coefficients: (straight line and terms, 3) dps, as deployed."""
    kinds = [f.candidate.kind for f in selection.found for _ in f.candidate.terms]
    rows = coefficients[len(selection.straight) :]
    return [
        Slot(term, (float(row[0]), float(row[1]), float(row[2])), kind)
        for kind, term, row in zip(kinds, selection.terms, rows)
    ]


def model_of(analysis, scales, effects: int | None = None) -> Model:
    """The model of an analysis, every number as the integers hold it. Raises CannotDeploy.

    effects: the first so many effects alone, fitted by themselves; None: all, with those of motion.
    """
    if effects is None:
        found = [*slots(analysis.selection, analysis.coefficients), *slots_of(analysis.motion)]
    else:
        first = analysis.selection.first(effects)
        found = slots(first, deployed(first)[1])
    tick_s = analysis.sessions[0].tick_s
    return build_model(found, scales, binding=binding_of(scales), tick_s=tick_s)
