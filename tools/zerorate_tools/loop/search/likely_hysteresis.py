"""Prandtl-Ishlinskii hysteresis where more than one power-on is recorded.

Play operators of fixed widths, each twice as wide and more as the last, with weights as large as is
likely (`fit/shrunk.py`), stand for any sum of play operators: no width is looked for, and what the
noise would make of widths and weights is not followed. Their likelihood, all sizes of the weights
weighed, is held against that of what else remembers temperature.
"""

from collections.abc import Iterator, Sequence
from itertools import product
from operator import itemgetter

import numpy as np

from ...model.term import Term, Terms
from ..fit.noise import NATS
from ..fit.regression import Regression
from ..fit.shrunk import evidence
from ..read.sessions import Session
from .catalogue import Candidate
from .decide import Decision
from .hysteresis import AS_WELL, BETTER, KIND, MOST_OPERATORS, SIMPLER, may_show, span_of
from .selection import Found, fits_in_slots

#: Radii of the finest operator, as shares of the range of temperature, and how many times as wide
#: each is as the last.
_FINEST, _APART = (0.0125, 0.025, 0.05), 2.3


def likeliest(regression: Regression, terms: Terms) -> tuple[Candidate | None, float]:
    """The likeliest hysteresis beside terms, and the nats by which it is likelier than none; None
    where the courses of temperature can show none, or do not.
    """
    if not may_show(regression.sessions):
        return None, 0.0
    forms = [(evidence(regression, terms, form), form) for form in _forms(regression.sessions)]
    nats, form = max(forms, key=itemgetter(0))
    return (Candidate(KIND, form, "catalogue") if nats > 0 else None), nats


def of_a_pair(
    regression: Regression, straight: Terms, bend: Terms, pool: Sequence[Candidate], taken: int
) -> tuple[Found | None, str]:
    """The hysteresis that one recording shows, or why not; another has the last word.

    bend: what was found, whose place it takes; pool: of which lag, rate and kink, beside the bend,
    must not be likelier, and are named where nearly as likely; taken: slots that others need.
    """
    candidate, nats = likeliest(regression, straight)
    if candidate is None or not fits_in_slots(candidate.terms, taken):
        return None, ""
    beside, of_bend = [*straight, *bend], evidence(regression, straight, bend) if bend else 0.0
    simpler = [(c.kind, evidence(regression, beside, c.terms)) for c in pool if c.kind in SIMPLER]
    rival, most = max(simpler, key=itemgetter(1))
    most = of_bend + max(most, 0.0)
    if most > nats:
        return None, AS_WELL if most < nats + NATS else BETTER
    if nats < NATS:
        return None, "not significant"
    # the chance that noise makes one of the forms so likely is less (Markov's inequality)
    p = min(1.0, 2 * len(_FINEST) * float(np.exp(-nats)))
    return Found(candidate, Decision(True, p, 2 * nats), {rival: most - nats}), ""


def _forms(sessions: Sequence[Session]) -> Iterator[tuple[Term, ...]]:
    """Sums of play operators, fine ones and wide, with squares and without."""
    lo, hi, centre = span_of(sessions)
    for finest, powers in product(_FINEST, ((1,), (1, 2))):
        widths = 2.0 * (hi - lo) * finest * _APART ** np.arange(MOST_OPERATORS)
        yield tuple(
            Term("temp", lo, hi, centre, power, memory="play", width=float(width))
            for width in widths
            for power in powers
        )
