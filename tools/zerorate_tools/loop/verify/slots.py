"""The found effects as slots of a model that the firmware runs, without those that do not fit."""

from dataclasses import replace

import numpy as np

from ...model import CannotDeploy, Model, Slot, build_model
from ...model.model import binding_of
from ...recordings import Scales
from ..fit.line import deployed
from ..fit.noise import floor_dps
from ..motion.scales_and_timing import slots_of
from ..search.selection import Selection
from .analysis import Analysis
from .judge import judge


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


def deployable(analysis: Analysis, scales: Scales) -> Analysis:
    """The same where it can be deployed with the first effects, however many; else without the one
    that stands against it, judged anew and noted.

    Raises CannotDeploy for what was found in motion.
    """
    number = len(analysis.selection.found)
    for effects in (*range(1, number + 1), None):
        try:
            model_of(analysis, scales, effects)
        except CannotDeploy as problem:
            if not number:
                raise
            analysis.gate.notes.append(f"found but left out: {problem}")
            less = analysis.selection.without((effects or number) - 1)
            return deployable(with_selection(analysis, less), scales)
    return analysis


def with_selection(analysis: Analysis, selection: Selection) -> Analysis:
    """The analysis with fewer of its effects, judged anew."""
    judgement = judge(selection, analysis.holdout)
    floor = floor_dps(judgement.whole, [*selection.straight, *selection.terms])
    return replace(analysis, selection=selection, judgement=judgement, floor_dps=floor)
