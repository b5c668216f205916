"""What was fitted on what, what was found and how sure it is, and the model of it for the firmware.

Effects that do not fit are left out.
"""

from dataclasses import dataclass, field, replace

import numpy as np

from ...model import CannotDeploy, Model, Slot, build_model
from ...model.model import binding_of
from ...recordings import Scales
from ..fit.regression import floor_dps
from ..motion.scales_and_timing import InMotion, slots_of
from ..read.earth import ROTATION
from ..read.gate import GateReport
from ..read.lines import Line
from ..read.sessions import Session, common_sources
from ..search.selection import Selection, deployed
from .courses import Courses
from .judge import Judgement, judge

#: Power-ons to fit on below which nothing is confirmed: of two, one in two devices has a chance
#: agreement of all signs.
LEAST_CONFIRMING = 3


@dataclass
class Analysis:
    """What was fitted on what, what was found, and what the held-out part says of it.

    motion, lines: what is not fitted on blocks at rest, `in_motion` and `periodic`; measured: what
    the firmware's kernels made of it, None before `measure`, after which the judgement is by them.
    """

    sessions: list[Session]
    train: list[Session]
    holdout: list[Session]
    selection: Selection
    judgement: Judgement
    floor_dps: np.ndarray
    gate: GateReport = field(default_factory=GateReport)
    motion: InMotion = field(default_factory=InMotion)
    lines: list[Line] = field(default_factory=list)
    measured: Courses | None = None

    @property
    def single(self) -> bool:
        """Whether one recording was split in time."""
        return len(self.sessions) == 1

    @property
    def few(self) -> bool:
        """Whether so few power-ons were fitted that all may agree by chance."""
        return len(self.train) < LEAST_CONFIRMING

    @property
    def coefficients(self) -> np.ndarray:
        """(straight line and terms, 3) dps per unit, as deployed."""
        return deployed(self.selection)[1]

    def confidence(self, i: int) -> str:
        """confirmed or tentative; with fewer than three power-ons to fit on, for what Earth can do,
        and for time alone where no temperature was recorded, nothing is confirmed.
        """
        found = self.selection.found[i]
        unsure = self.few or ROTATION in found.confounded_with or self.may_be_heat(i)
        return "tentative" if unsure else self.judgement.confidence(i)

    def may_be_heat(self, i: int) -> bool:
        """Whether the i-th effect follows time alone, and no temperature tells it from warming."""
        blind = "temp" not in common_sources(self.sessions)
        return blind and not set(self.selection.found[i].candidate.sources) - {"time"}


def slots(selection: Selection, coefficients: np.ndarray) -> list[Slot]:
    """Slots in the order found. coefficients: (straight line and terms, 3) dps, as deployed."""
    kinds = [f.candidate.kind for f in selection.found for _ in f.candidate.terms]
    rows = coefficients[len(selection.straight) :]
    return [
        Slot(term, (float(row[0]), float(row[1]), float(row[2])), kind)
        for kind, term, row in zip(kinds, selection.terms, rows)
    ]


def model_of(analysis: Analysis, scales: Scales, effects: int | None = None) -> Model:
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
    for effects in (*range(1, number), None):
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
