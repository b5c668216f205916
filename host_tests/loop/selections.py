"""Effects as a search may have found them, and recordings in which they are found."""

import numpy as np
from zerorate_tools.loop.fit.regression import Regression
from zerorate_tools.loop.search.catalogue import Candidate
from zerorate_tools.loop.search.decide import Decision
from zerorate_tools.loop.search.selection import Found, Selection


def candidate(*terms, kind="vibration", family="catalogue", refine=()):
    return Candidate(kind, terms, family, refine)


def found(*terms, kind="vibration", accepted=True, p=0.0, gains=(0.0,), **more):
    """An effect; gains: nats of each session or piece left out."""
    decision = Decision(accepted, p, 0.0, session_gains=np.array(gains))
    return Found(candidate(*terms, kind=kind), decision, **more)


def selected(sessions, *effects, line=(), **more):
    return Selection([*effects], [], 0, Regression(sessions), line, (), [], {}, **more)
