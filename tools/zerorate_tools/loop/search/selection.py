"""What a search over training sessions comes to."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace

import numpy as np

from ...model.term import Term
from ..fit.line import less_slope
from ..fit.regression import Regression
from .catalogue import Candidate
from .confounding import label
from .decide import Decision


@dataclass
class Found:
    """An accepted effect, with its rivals and what the locks said of it. axes: those of the
    gyroscope that it corrects, where not all do better with it.
    """

    candidate: Candidate
    decision: Decision
    confounded_with: list[str] = field(default_factory=list)
    axes: tuple[bool, ...] = (True, True, True)

    def without_axes(self, axes: Iterable[bool]) -> Found:
        """The same without what it corrects on some axes, (3,) bool."""
        kept = tuple(a and not s for a, s in zip(self.axes, axes))
        return replace(self, axes=kept)


@dataclass
class Selection:
    """What the training sessions show. line: over temperature, which the firmware learns."""

    found: list[Found]
    refused: list[tuple[str, str]]
    outliers: int
    regression: Regression
    line: tuple[Term, ...]
    bend: tuple[Term, ...]
    pool: list[Candidate]
    smallest_dps: dict[str, float]
    alone: bool = False  # whether one recording was fitted, whose pieces judged
    judged_again: bool = False  # whether another one, held out, has the last word
    withdrawn: list[tuple[str, str]] = field(default_factory=list)  # see `prune_by_holdout`

    @property
    def stands_alone(self) -> bool:
        """Whether there is no other recording."""
        return self.alone and not self.judged_again

    def first(self, effects: int) -> Selection:
        """The same with the first so many effects alone."""
        return replace(self, found=self.found[:effects])

    def without(self, effect: int) -> Selection:
        """The same without one of the effects."""
        found = [f for i, f in enumerate(self.found) if i != effect]
        return replace(self, found=found)

    def without_axes(self, effect: int, axes: Iterable[bool], reason: str) -> Selection:
        """The same with an effect taken from some axes, and withdrawn where none is left."""
        less = self.found[effect].without_axes(axes)
        if not any(less.axes):
            said = (label(less.candidate), reason)
            return replace(self.without(effect), withdrawn=[*self.withdrawn, said])
        found = [less if i == effect else f for i, f in enumerate(self.found)]
        return replace(self, found=found)

    @property
    def straight(self) -> tuple[Term, ...]:
        """The line that is fitted beside the effects: none where one of them is the slope."""
        return less_slope(self.line, self.terms)

    @property
    def applied(self) -> np.ndarray:
        """(terms, 3) one where a slot corrects an axis, else zero."""
        rows = [f.axes for f in self.found for _ in f.candidate.terms]
        return np.array(rows, float).reshape(-1, 3)

    @property
    def terms(self) -> list[Term]:
        """Slots of every found effect, in the order found."""
        return [t for f in self.found for t in f.candidate.terms]
