"""Thermal hysteresis as real parts have it: Prandtl-Ishlinskii, a weighted sum of play operators.

One backlash has one width; a real loop has rounded ends and inner loops of its own. Play operators
of fixed widths, with squares for a lopsided loop, stand for any of them: their weights are as large
as is likely (`fit/shrunk.py`), so no width is looked for, and what noise would make of the weights
is not followed.
"""

from collections.abc import Sequence
from operator import itemgetter

import numpy as np

from ...model.model import MOST_PLAYS
from ...model.term import Term, Terms
from ..fit.noise import NATS
from ..fit.regression import Regression
from ..fit.shrunk import evidence
from ..fit.single import PiecesByLine, pass_of
from ..read.sessions import Session
from .catalogue import Candidate, varies
from .decide import Decision, family_p
from .selection import Found, fits_in_slots

KIND = "thermal-hysteresis"
#: Of one width, or what else a few power-ons take a sum of many widths for.
LIKE_IT = (KIND, "temperature-peak", "thermal-lag", "thermal-rate", "power-on-transient")
#: What may lag behind temperature, or only seem to: the start of a power-on.
MEMORIES = ("thermal-lag", "thermal-rate", "power-on-transient")
#: Radii of the narrowest and the widest play operator, as shares of the range of temperature.
_RADII = 0.03, 0.5
#: Powers of an even loop, and of a lopsided one.
_FORMS = (1,), (1, 2)
#: What is simpler.
SIMPLER = ("thermal-lag", "thermal-rate", "temperature-kink")
#: Why it was refused: both stand in the report.
AS_WELL = "a lag, a rate or a kink predicts the pieces left out as well"
BETTER = "a lag, a rate or a kink predicts the pieces left out better"
#: By which the error on pieces left out must fall where one recording stands alone. Noise that
#: walks by a third of its white part a block lets it fall by 1.1 to 1.4; a real part's loop in a
#: chamber by 5.
LEAST_FACTOR = 2.5


def may_show(sessions: Sequence[Session]) -> bool:
    """Whether temperature turns back in some session: a part only warmed shows no difference
    between warming and cooling."""
    there = all("temp" in s.sources for s in sessions) and varies("temp", list(sessions))
    return there and any(pass_of(s).any() for s in sessions)


def is_like_hysteresis(
    straight: Terms,
    beside: Terms,
    best: Candidate,
    pool: Sequence[Candidate],
    sessions: list[Session],
) -> bool:
    """Whether a hysteresis of one width predicts the pieces left out of a session as well as a lag,
    a rate or a start: one course does not tell which it is, and at another power-on they part."""
    if best.kind not in MEMORIES:
        return False
    [session] = sessions
    by_line = PiecesByLine(session)
    loops = [c.terms for c in pool if c.kind == KIND]
    most = max((float(by_line(straight, beside, terms).sum()) for terms in loops), default=-np.inf)
    return most >= float(by_line(straight, beside, best.terms).sum())


def play_operators(
    sessions: Sequence[Session], powers: Sequence[int] = _FORMS[-1]
) -> tuple[Term, ...]:
    """Those of all widths, by default with squares, over the temperatures of some sessions."""
    degc = [s.source("temp") for s in sessions]
    lo, hi = float(min(d.min() for d in degc)), float(max(d.max() for d in degc))
    centre = float(np.mean([d.mean() for d in degc]))
    return tuple(
        Term("temp", lo, hi, centre, power, memory="play", width=2.0 * (hi - lo) * float(radius))
        for radius in np.geomspace(*_RADII, MOST_PLAYS)
        for power in powers
    )


def likeliest(regression: Regression, terms: Terms) -> tuple[Candidate | None, float]:
    """The hysteresis beside terms, and the nats by which it is likelier than none; None where the
    courses of temperature can show none, or do not.
    """
    if not may_show(regression.sessions):
        return None, 0.0
    forms = [play_operators(regression.sessions, powers) for powers in _FORMS]
    nats, operators = max(((evidence(regression, terms, f), f) for f in forms), key=itemgetter(0))
    return (Candidate(KIND, operators, "catalogue") if nats > 0 else None), nats


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
    p = min(1.0, len(_FORMS) * float(np.exp(-nats)))
    return Found(candidate, Decision(True, p, 2 * nats), {rival: most - nats}), ""


def of_one_recording(
    regression: Regression,
    straight: Terms,
    bend: tuple[Term, ...],
    pool: Sequence[Candidate],
    judged: PiecesByLine,
    taken: int,
) -> tuple[Found | None, str]:
    """The hysteresis of a recording that stands alone, with its bend as one effect, or why not.

    pool: of which lag, rate and kink are asked first, for one course of temperature shows all much
    alike; taken: slots that others need. No other may predict the pieces nearly as well, and the
    error on them must fall by LEAST_FACTOR beside the bend. Pieces left out decide, as with curves,
    but the noise may be as steep as it likes: a course with few turns is much like a walk.
    """
    [session] = regression.sessions
    if not may_show([session]):
        return None, ""
    operators = play_operators([session])
    whole = (*bend, *operators)
    if not fits_in_slots(whole, taken):
        return None, ""
    # beside play operators no bend is held at the edges: then none is in what they are compared to
    by_line = PiecesByLine(session, hold=False)
    gain, *others = (
        float(by_line(straight, bend, terms).sum())
        for terms in (operators, *(c.terms for c in pool if c.kind in SIMPLER))
    )
    if max(others) > gain - NATS:
        return None, AS_WELL if max(others) < gain + NATS else BETTER
    if _factor(straight, [(), bend], whole, by_line) < LEAST_FACTOR:
        return None, "too little of the error to tell it from the noise's walk"
    nats = judged(straight, (), whole)
    if nats.sum() <= 0:
        return None, judged.reason
    ratio = float(regression.gains([*straight, *bend], [operators]).sum())
    decision = Decision(True, family_p(ratio, 3 * len(operators), 1), ratio, session_gains=nats)
    return Found(Candidate(KIND, whole, "catalogue"), decision), ""


def _factor(straight: Terms, bends: Sequence[Terms], whole: Terms, by_line: PiecesByLine) -> float:
    """By how much the error of pieces left out falls from that beside the best bend, geometric mean
    over the axes; the kernels, whose curve bends already, may have found none."""
    logs = [np.log(np.nanmean(by_line.residual(straight, t) ** 2, axis=0)) for t in (whole, *bends)]
    return float(np.exp(0.5 * (min(x.mean() for x in logs[1:]) - logs[0].mean())))
