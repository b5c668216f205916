"""What a search over training sessions comes to."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from ...model.term import Term
from ..fit.regression import Regression
from .catalogue import Candidate
from .decide import Decision
from .steps import Step


@dataclass
class Found:
    """An accepted effect, with its rivals and what the locks said of it."""

    candidate: Candidate
    decision: Decision
    confounded_with: list[str] = field(default_factory=list)


@dataclass
class Selection:
    """What the training sessions show."""

    found: list[Found]
    steps: list[Step]
    refused: list[tuple[str, str]]
    outliers: int
    regression: Regression
    straight: tuple[Term, ...]
    bend: tuple[Term, ...]
    pool: list[Candidate]
    smallest_dps: dict[str, float]
    bends: int = 0  # of the effects found, how many at the start are bends of a single recording
    withdrawn: list[tuple[str, str]] = field(default_factory=list)  # see `uphold`

    def first(self, effects: int) -> Selection:
        """The same with the first so many effects alone."""
        return replace(self, found=self.found[:effects], bends=min(effects, self.bends))

    def without(self, effect: int) -> Selection:
        """The same without one of the effects."""
        found = [f for i, f in enumerate(self.found) if i != effect]
        return replace(self, found=found, bends=self.bends - (effect < self.bends))

    @property
    def terms(self) -> list[Term]:
        """Slots of every found effect, in the order found."""
        return [t for f in self.found for t in f.candidate.terms]
