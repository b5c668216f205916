"""What was fitted on what, what was found, and how sure it is."""

from dataclasses import dataclass, field

import numpy as np

from ..fit.line import deployed
from ..motion.scales_and_timing import InMotion
from ..read.earth import ROTATION
from ..read.gate import GateReport
from ..read.lines import Line
from ..read.sessions import Session
from ..search.selection import Selection
from .courses import Courses
from .judge import Judgement

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
        blind = "temp" not in self.sessions[0].sources
        return blind and not set(self.selection.found[i].candidate.sources) - {"time"}
