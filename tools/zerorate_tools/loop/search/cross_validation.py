"""What pieces left out tell of one recording where the likelihood cannot: its noise walks, too.

The firmware's own curve over temperature is made of bins: over a few tenths of a degree it follows
the noise, where a polynomial of its own slots does not. And a part that is heated from one side
lags behind its thermometer however the noise walks. Both are taken where they predict the pieces
left out clearly better, by the firmware's own kernels.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...model.model import MOST_SLOTS
from ...model.term import Term
from ..fit.line import ordinary
from ..fit.regression import Regression, predicted
from ..fit.single import PiecesByLine, nats_of
from ..read.sessions import Session
from .catalogue import Candidate, ranges
from .decide import Decision, family_p
from .fits_in_slots import fits_in_slots
from .selection import Found

POLYNOMIAL = "temperature-polynomial"
SEGMENTS = "temperature-segments"
_NAMES = ("", "quadratic", "curve")
#: Bends of a line of segments, at even distances, at least; with its slope they take all slots.
_LEAST_BENDS = 4
#: What may lag behind temperature, or only seem to: the start of a power-on.
MEMORIES = ("thermal-lag", "thermal-rate", "power-on-transient")
#: What also tells warming from cooling, of a width, and goes another way at another power-on.
_HYSTERESIS = "thermal-hysteresis"
#: Nats that pieces left out must gain, and what may be left of their error: of a form without
#: memory, and of one that has to be told from a walk of the noise, which a slow course feigns well.
_CLEARLY, _CLEARLY_OF_MEMORY = (2.0, 0.97), (5.0, 0.9)
#: The same of a line of segments, the best of some.
_CLEARLY_OF_SEGMENTS = (2.0, 0.9)
#: Chance by the likelihood, all that were tried paid for, above which pieces alone tell of no
#: memory: with one of real parts it is below 0.0001, with seven that noise feigned it was 1.
_LIKELY = 0.01
#: Range of temperature in which the firmware's curve is one line, learned in a few bins.
_NARROW_DEGC = 3.0
#: Share of the range of temperature beyond which the slope, or the outer segments, are held.
_BEYOND = 0.5
#: Of the error without it that an effect may be. Lags of real parts are 0.6 times; what tells a
#: start's decay from a warm-up by cancelling both is 6 times and more.
_MOST_TIMES = 2.0


def polynomial(regression, straight, found, judged, by_line, taken) -> Found | None:
    """A line, parabola or cubic over temperature with slots of its own, in the place of the bend
    found; None where it does not predict clearly better.

    judged: by the firmware's kernels; by_line: by least squares; taken: slots that others need.
    """
    every = _polynomials(regression, straight)
    best = max(every, key=lambda terms: float(by_line(straight, (), terms).sum()), default=())
    if not best or not fits_in_slots(best, taken):
        return None
    bend = [t for f in found for t in f.candidate.terms]
    gain = judged(straight, (), best) - (judged(straight, (), bend) if bend else 0.0)
    if not _is_clear(gain, regression, *_CLEARLY):
        return None
    decision = _decision(regression, straight, best[1:], len(every), gain)
    return Found(Candidate(POLYNOMIAL, best, "catalogue"), decision)


def whole_curve(regression, straight, found, judged, by_line, taken, by_error=True) -> Found | None:
    """A line over temperature that bends several times, a parabola or a cubic, in the place of all
    that was found; None where it does not predict clearly better: so many parameters follow a walk
    of the noise as well, and powers leave what was seen the faster. The line may also leave clearly
    less of the plain error, which is what counts in the end and what a few bad pieces decide.

    Arguments as for `polynomial`; by_error: whether the plain error is asked.
    """
    bent = _segments(regression, straight, MOST_SLOTS - 1 - taken)
    every = [*bent, *(_powers(regression, straight, by_line) if bent else ())]
    own = [t for f in found for t in f.candidate.terms]
    for some in (every, bent) if by_error else (every,):
        best = max(some, key=lambda terms: float(by_line(straight, (), terms).sum()), default=())
        gain = judged(straight, (), best) - (judged(straight, (), own) if own else 0.0)
        if best in bent:
            kind, clear = SEGMENTS, _is_clear(gain, regression, *_CLEARLY_OF_SEGMENTS)
            clear = clear or by_error and leaves_less(judged, straight, own, best, gain)
        else:
            kind, clear = POLYNOMIAL, _is_clear(gain, regression, *_CLEARLY_OF_MEMORY)
        if best and clear:
            decision = _decision(regression, straight, best[1:], len(every), gain)
            if decision.p_value <= _LIKELY:
                return Found(Candidate(kind, best, "catalogue"), decision)
    return None


def leaves_less(judged, straight, own, segments, gain) -> bool:
    """Whether a line of segments leaves clearly less of the plain error over the axes than what was
    found, and the pieces do not speak against it."""
    least, most_left = _CLEARLY_OF_SEGMENTS
    if gain.sum() <= least:
        return False
    mean_square = [np.nanmean(judged.residual(straight, [*t]) ** 2) for t in (segments, own)]
    return bool(mean_square[0] <= most_left**2 * mean_square[1])


def memory(regression, straight, found, pool, judged, by_line, taken) -> Found | None:
    """The lag, rate or start that predicts best beside what was found, where clearly better.

    Arguments as for `polynomial`; pool: the candidates, of which others are passed over.
    """
    beside = [t for f in found for t in f.candidate.terms]
    every = [*straight, *beside]
    own = [
        c
        for c in pool
        if c.kind in MEMORIES
        and fits_in_slots([*beside, *c.terms], taken)
        and not cancels(regression.sessions, every, c.terms)
    ]
    gains = [float(by_line(straight, beside, c.terms).sum()) for c in own]
    if not gains or max(gains) <= 0:
        return None
    best = own[gains.index(max(gains))]
    if is_like_hysteresis(straight, beside, best, pool, by_line):
        return None
    gain = judged(straight, beside, best.terms)
    decision = _decision(regression, every, best.terms, len(own), gain)
    if decision.p_value > _LIKELY or not is_clear_memory(regression, decision):
        return None
    return Found(best, decision)


def is_like_hysteresis(straight, beside, best: Candidate, pool, by_line: PiecesByLine) -> bool:
    """Whether a hysteresis of one width predicts the pieces left out as well as a lag, a rate or a
    start: one course does not tell which it is, and at another power-on they part."""
    if best.kind not in MEMORIES:
        return False
    loops = [c.terms for c in pool if c.kind == _HYSTERESIS]
    most = max((float(by_line(straight, beside, terms).sum()) for terms in loops), default=-np.inf)
    return most >= float(by_line(straight, beside, best.terms).sum())


@dataclass
class Remembering:
    """A curve over temperature, maybe none, with a memory of it, and the nats both gain; doubtful:
    it may as well be a hysteresis, whose width one course does not tell."""

    curve: tuple[Term, ...]
    memory: Candidate
    nats: float
    doubtful: bool = False


def remembering(straight, curve, pool, by_line: PiecesByLine) -> Remembering | None:
    """What of all that remembers temperature predicts best, beside the line, a parabola or a cubic.

    curve: the terms of the parabola and the cubic.
    """
    best = None
    for powers in range(len(curve) + 1):
        beside = curve[:powers]
        for c in pool:
            if c.kind in (*MEMORIES, _HYSTERESIS):
                nats = float(by_line(straight, (), (*beside, *c.terms)).sum())
                best = best if best and best.nats >= nats else Remembering(beside, c, nats)
    if best:
        alike = is_like_hysteresis(straight, best.curve, best.memory, pool, by_line)
        best.doubtful = best.memory.kind == _HYSTERESIS or alike
    return best


def of_memory(regression, straight, found, other, pool, judged, by_line, taken) -> list[Found]:
    """The curve and the memory in the place of all that was found, where that is clear, of another
    memory where it predicts better; else none.

    Arguments as for `memory`.
    """
    c, every = other.memory, [*straight, *other.curve]
    fits = fits_in_slots([*other.curve, *c.terms], taken)
    if not fits or cancels(regression.sessions, every, c.terms):
        return []
    own = [t for f in found for t in f.candidate.terms]
    instant = [t for f in found if f.candidate.kind not in MEMORIES for t in f.candidate.terms]
    with_it = judged(straight, (), [*other.curve, *c.terms])
    if own and float((with_it - judged(straight, (), own)).sum()) <= 0.0:
        return []
    gain = with_it - (judged(straight, (), instant) if instant else 0.0)
    tried = sum(x.kind in MEMORIES for x in pool)
    decision = _decision(regression, every, c.terms, tried, gain)
    if decision.p_value > _LIKELY or not is_clear_memory(regression, decision):
        return []
    curve = Candidate("temperature-" + _NAMES[len(other.curve)], other.curve, "catalogue")
    beside = _decision(regression, straight, other.curve, 1, gain)
    return [*([Found(curve, beside)] if other.curve else []), Found(c, decision)]


def cancels(sessions: Sequence[Session], beside: Sequence[Term], terms: Sequence[Term]) -> bool:
    """Whether terms are far larger than the error that they explain: then they only stand against
    others, as a start's decay against a warm-up, and not at another power-on."""
    without = _squares(sessions, beside, ordinary(beside, sessions) if beside else None, True)
    fitted = ordinary([*beside, *terms], sessions)[len(beside) :]
    return _squares(sessions, terms, fitted, False) > _MOST_TIMES**2 * without


def _squares(sessions, terms, coefficients, left: bool) -> float:
    """Of what terms add to the bias, or leave of it, offsets aside, in all."""
    total = 0.0
    for s in sessions:
        added = predicted(terms, coefficients, s) if len(terms) else 0.0
        values = s.rate_dps - added if left else added
        total += float((s.less_offsets(values, s.available)[s.available] ** 2).sum())
    return total


def is_clear_memory(regression: Regression, decision: Decision) -> bool:
    """Whether pieces gain what they must of an effect that remembers temperature."""
    return _is_clear(decision.session_gains, regression, *_CLEARLY_OF_MEMORY)


def _is_clear(gain, regression, least_nats: float, most_left: float) -> bool:
    blocks = int(regression.sessions[0].available.sum())
    return float(gain.sum()) > max(least_nats, nats_of(1.0 / most_left, blocks))


def _decision(regression, nuisances, terms, tried: int, gain) -> Decision:
    """Accepted by the pieces; the likelihood is only told."""
    if not terms:
        return Decision(True, 1.0, 0.0, 1.0, gain)
    ratio = float(regression.gains(nuisances, [tuple(terms)]).sum())
    return Decision(True, family_p(ratio, 3 * len(terms), tried), ratio, 1.0, gain)


def _polynomials(regression, straight) -> list[tuple[Term, ...]]:
    """Of one to three powers; the slope reaches beyond what was seen, as the firmware's does."""
    if not straight:
        return []
    lo, hi, _ = ranges(regression.sessions)["temp"]
    if hi - lo > _NARROW_DEGC:
        return []
    slope = _reaching(straight[0], lo, hi, _BEYOND * (hi - lo))
    powers = [slope, *(replace(straight[0], lo=lo, hi=hi, power=k) for k in (2, 3))]
    return [tuple(powers[:n]) for n in (1, 2, 3)]


def _powers(regression, straight, by_line: PiecesByLine) -> list[tuple[Term, ...]]:
    """A parabola and a cubic, held at the edges of what was seen or going on as far beyond as
    pieces left out can judge."""
    lo, hi, _ = ranges(regression.sessions)["temp"]
    slopes = [_reaching(straight[0], lo, hi, margin) for margin in (0.0, _furthest(by_line))]
    each = [[replace(slope, power=k) for k in (1, 2, 3)] for slope in slopes]
    return [tuple(powers[:n]) for powers in each for n in (2, 3)]


def _segments(regression, straight, most_bends: int) -> list[tuple[Term, ...]]:
    """Lines with so many bends and fewer; their outer segments go on beyond what was seen, for
    nothing else does where a model has the slope, or are held there."""
    if not straight:
        return []
    lo, hi, _ = ranges(regression.sessions)["temp"]
    every = []
    for bends in range(_LEAST_BENDS, most_bends + 1):
        at = np.linspace(lo, hi, bends + 2)[1:-1] - straight[0].centre
        for share in (_BEYOND, 0.0):
            slope = _reaching(straight[0], lo, hi, share * (hi - lo))
            every.append((slope, *(replace(slope, knot=float(knot)) for knot in at)))
    return every


def _reaching(line: Term, lo: float, hi: float, margin: float) -> Term:
    return replace(line, lo=lo - margin, hi=hi + margin)


def _furthest(by_line: PiecesByLine) -> float:
    """By how much a piece left out leaves the range of temperature of the others, at most."""
    degc = by_line.session.block_mean(by_line.session.source("temp"))
    whole = degc[by_line.session.available]
    seen = [degc[part.available] for part in by_line.parts]
    return float(max(max(s.min() - whole.min(), whole.max() - s.max()) for s in seen))
