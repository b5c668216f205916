"""Effects as a search may have found them, and recordings in which they are found."""

import numpy as np
from zerorate_tools.loop.fit.regression import Regression
from zerorate_tools.loop.read.sessions import Session
from zerorate_tools.loop.search.catalogue import Candidate
from zerorate_tools.loop.search.decide import Decision
from zerorate_tools.loop.search.selection import Found, Selection
from zerorate_tools.loop.search.steps import Step
from zerorate_tools.loop.verify.analysis import Analysis
from zerorate_tools.loop.verify.judge import judge


def candidate(*terms, kind="vibration", family="catalogue", refine=()):
    return Candidate(kind, terms, family, refine)


def found(*terms, kind="vibration", family="catalogue", accepted=True, p=0.0, gains=(0.0,), **more):
    """An effect; gains: nats of each session or piece left out."""
    decision = Decision(accepted, p, 0.0, session_gains=np.array(gains))
    return Found(candidate(*terms, kind=kind, family=family), decision, **more)


def selected(sessions, *effects, line=(), **more):
    return Selection([*effects], [], 0, Regression(sessions), line, (), [], {}, **more)


def analysed(sessions, *effects):
    """The analysis of sessions whose last is held out."""
    train, held = sessions[:-1], sessions[-1:]
    selection = selected(train, *effects)
    return Analysis(sessions, train, held, selection, judge(selection, held), np.zeros(3))


def step(block, dps=(1.0, 1.0, 1.0), deviation_dps=(1.0, 1.0, 1.0), session=0, share=0.0):
    return Step(session, block, np.array(dps), 9.0, 0.0, np.array(deviation_dps), share=share)


def warm(blocks=50, seed=0, **more):
    """A session that warms by ten degrees, with a supply and a load beside it."""
    rng = np.random.default_rng(seed)
    sources = {
        "temp": np.linspace(20.0, 30.0, blocks),
        "acc_x": np.linspace(-0.2, 0.3, blocks),
        "acc_y": np.zeros(blocks),
        "acc_z": np.ones(blocks),
        "vib": np.full(blocks, 0.1),
        "vdd_mv": 5000 + 20 * rng.normal(size=blocks),
        "load": rng.normal(size=blocks),
        **more,
    }
    return Session(f"w{seed}", 20.0, 1, rng.normal(size=(blocks, 3)), np.ones(blocks), sources)
