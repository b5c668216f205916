"""What a search over training sessions comes to."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace

import numpy as np
from scipy.special import softmax

from ...model.model import MOST_CHANNELS, MOST_PLAYS, MOST_RINGS, MOST_SLOTS, MOST_TABLES
from ...model.term import Term, Terms
from ..fit.line import by_axis, less_slope, ordinary, shrunk, with_line
from ..fit.noise import USUAL
from ..fit.regression import Regression
from ..fit.shrunk import has_play_operators
from ..read.sessions import OWN_SOURCES
from .catalogue import Candidate
from .decide import Decision


@dataclass
class Found:
    """An accepted effect, what the locks said of it, and the nats of what may stand in its place
    above its own. axes: those of the gyroscope that it corrects, where not all do better with it.
    """

    candidate: Candidate
    decision: Decision
    rivals: dict[str, float] = field(default_factory=dict)
    axes: tuple[bool, ...] = (True, True, True)

    @property
    def probabilities(self) -> dict[str, float]:
        """The chance that it is itself, and of each that may stand in its place, by name, the
        likeliest first; others' chances below one in twenty are left out."""
        own = self.candidate.label
        nats = {own: 0.0, **self.rivals}
        names = sorted(nats, key=lambda name: -nats[name])
        chances = softmax([nats[name] for name in names])
        return {name: float(p) for name, p in zip(names, chances) if name == own or p > USUAL}

    @property
    def confounded_with(self) -> list[str]:
        """What else it may be."""
        return [name for name in self.probabilities if name != self.candidate.label]


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
        less, found = self.found[effect], list(self.found)
        kept = tuple(own and not gone for own, gone in zip(less.axes, axes))
        if not any(kept):
            said = (less.candidate.label, reason)
            return replace(self.without(effect), withdrawn=[*self.withdrawn, said])
        found[effect] = replace(less, axes=kept)
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


def fits_in_slots(terms: Terms, taken: int = 0) -> bool:
    """Whether the firmware has room for terms, a slot each, beside slots that motion needs.

    A play operator and its square have a place of their own.
    """
    channels = {n for t in terms for n in (t.source, t.second) if n and n not in OWN_SOURCES}
    delays = sum(t.delay_s > 0 for t in terms)
    plays = {replace(t, power=1) for t in terms if t.memory == "play"}
    slots = sum(t.memory != "play" for t in terms) + taken
    return (
        slots <= MOST_SLOTS
        and len(plays) <= MOST_PLAYS
        and delays <= MOST_RINGS
        and sum(t.table is not None for t in terms) <= MOST_TABLES
        and len(channels) <= MOST_CHANNELS
    )


def deployed(selection: Selection, effects: bool = True) -> tuple[list[Term], np.ndarray]:
    """Terms and (terms, 3) coefficients as deployed: the line first, then the effects if wanted.

    Those of a single recording are learned like the line: there the noise's walk is the bend.
    """
    straight, terms = list(selection.straight), list(selection.terms) if effects else []
    sessions, every = selection.regression.sessions, [*straight, *terms]
    if not every:
        return [], np.zeros((0, 3))
    applied = with_line(straight, terms, selection.applied if effects else np.ones((0, 3)))
    fitted = by_axis(_fit_of(selection), every, applied)[len(straight) :]
    if not straight:
        return terms, fitted
    return every, np.vstack([ordinary(straight, sessions, terms, fitted), fitted])


def _fit_of(selection: Selection) -> Callable[[Terms], np.ndarray]:
    regression = selection.regression
    if selection.alone:
        return lambda terms: ordinary(terms, regression.sessions)
    if has_play_operators(selection.terms):
        return lambda terms: shrunk(regression, terms)
    return lambda terms: regression.fit(terms).coefficients
