"""An analysis without the effects that the firmware's integers cannot hold."""

from dataclasses import replace

from ...model import CannotDeploy
from ...recordings import Scales
from ..fit.floor import floor_dps
from ..search.selection import Selection
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
            less = analysis.selection.without((effects or number) - 1)
            return deployable(with_selection(analysis, less), scales)
    return analysis


def with_selection(analysis: Analysis, selection: Selection) -> Analysis:
    """The analysis with fewer of its effects, judged anew."""
    judgement = judge(selection, analysis.holdout)
    floor = floor_dps(judgement.whole, [*selection.straight, *selection.terms])
    return replace(analysis, selection=selection, judgement=judgement, floor_dps=floor)
