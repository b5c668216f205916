"""An analysis without the effects that the firmware's integers cannot hold."""

from __future__ import annotations

from dataclasses import replace

from ...model import CannotDeploy
from ...recordings import Scales
from ..fit.floor import floor_dps
from .analysis import Analysis
from .judge import judge
from .slots import model_of


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
            return deployable(_without(analysis, (effects or number) - 1), scales)
    return analysis


def _without(analysis, i):
    selection = analysis.selection.without(i)
    judgement = judge(selection, analysis.locked)
    floor = floor_dps(judgement.whole, [*selection.straight, *selection.terms])
    return replace(analysis, selection=selection, judgement=judgement, floor_dps=floor)
