"""Thermal hysteresis as real parts have it: Prandtl-Ishlinskii, a weighted sum of play operators.

One backlash has one width; a real loop has rounded ends and inner loops of its own. Which widths,
how many, and whether lopsided (with squares) is chosen by what predicts best what is left out: the
widths by least squares over a fine geometric grid, the form by the pieces or the power-ons left out
in turn. That is what keeps it small: a form with more operators has to predict better, and its
place on the board is limited.
"""

from collections.abc import Iterator, Sequence
from itertools import combinations
from math import comb

import numpy as np

from ...model.model import MOST_PLAYS
from ...model.term import Term, Terms, play
from ..fit.likelihood import TINY
from ..fit.noise import NATS
from ..fit.regression import Regression
from ..fit.single import PiecesByLine, pass_of
from ..read.sessions import Session, block_basis
from .catalogue import Candidate, varies
from .decide import LEVEL, Decision, family_p
from .selection import Found, fits_in_slots

KIND = "thermal-hysteresis"
#: Of one width, or what else a few power-ons take a sum of many widths for.
LIKE_IT = (KIND, "temperature-peak", "thermal-lag", "thermal-rate", "power-on-transient")
#: What may lag behind temperature, or only seem to: the start of a power-on.
MEMORIES = ("thermal-lag", "thermal-rate", "power-on-transient")
#: Radii of the grid, as shares of the range of temperature: its ends, and how many.
_FINEST, _WIDEST, _GRID = 0.015, 0.65, 64
MOST_OPERATORS = min(4, MOST_PLAYS)
#: As how many widths the grid's count: neighbours are much alike.
_APART = 6
#: What is simpler.
SIMPLER = ("thermal-lag", "thermal-rate", "temperature-kink")
#: Why it was refused: both stand in the report.
AS_WELL = "a lag, a rate or a kink predicts the pieces left out as well"
BETTER = "a lag, a rate or a kink predicts the pieces left out better"
#: By which the error on pieces left out must fall where one recording stands alone. Noise that
#: walks by a third of its white part a block lets it fall by 1.2 to 1.4, by 1.9 where it walks by
#: more than its white part; a real part's loop in a chamber by 4.6.
LEAST_FACTOR = 2.5
#: Temperatures of a block when widths are looked for.
_A_BLOCK = 8


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


def best_hysteresis(
    sessions: Sequence[Session], straight: Terms, beside: Terms, judged: PiecesByLine
) -> tuple[Candidate | None, float]:
    """The sum of play operators that predicts best what is left out, and the nats that it gains;
    None where none does better.

    beside: the other terms.
    """
    if not may_show(sessions):
        return None, 0.0
    best, chosen = 0.0, tuple[Term, ...]()
    for terms in _forms(sessions, [*straight, *beside]):
        gain = float(judged(straight, beside, terms).sum())
        gain -= len({t.width for t in terms})  # nats, for each width, which was looked for
        if gain > best:
            best, chosen = gain, terms
    return (Candidate(KIND, chosen, "catalogue") if chosen else None), best


def of_one_recording(
    regression: Regression,
    straight: Terms,
    bends: Sequence[tuple[Term, ...]],
    pool: Sequence[Candidate],
    judged: PiecesByLine,
    taken: int,
) -> tuple[Found | None, str]:
    """The hysteresis of a recording that stands alone, with its bend as one effect, or why not.

    bends: of which the one that predicts best with a hysteresis is taken; pool: of which lag, rate
    and kink are asked first, for one course of temperature shows all much alike; taken: slots that
    others need. No other may predict the pieces nearly as well, and the error on them must fall by
    LEAST_FACTOR beside the bend. Pieces left out decide, as with curves, but the noise may be as
    steep as it likes: a course with few turns is much like a walk.
    """
    # beside play operators no bend is held at the edges: then none is in what they are compared to
    [session] = regression.sessions
    by_line = PiecesByLine(session, hold=False)
    best = _with_a_bend(regression, straight, bends, by_line, taken)
    if best is None:
        return None, ""
    gain, bend, candidate = best
    rival, most = _rival(straight, bend, pool, by_line)
    if most > gain - NATS:
        return None, AS_WELL if most < gain + NATS else BETTER
    p, ratio = _chance(regression, [*straight, *bend, *rival.terms], candidate)
    if p > LEVEL["catalogue"]:
        return None, "not significant"
    whole = (*bend, *candidate.terms)
    if _factor(straight, bends, whole, by_line) < LEAST_FACTOR:
        return None, "too little of the error to tell it from the noise's walk"
    nats = judged(straight, (), whole)
    if nats.sum() <= 0:
        return None, judged.reason
    decision = Decision(True, p, ratio, session_gains=nats)
    return Found(Candidate(KIND, whole, "catalogue"), decision), ""


def _with_a_bend(
    regression: Regression,
    straight: Terms,
    bends: Sequence[tuple[Term, ...]],
    by_line: PiecesByLine,
    taken: int,
) -> tuple[float, tuple[Term, ...], Candidate] | None:
    """The nats that the best bend and hysteresis gain together, and both; None where none fits."""
    best: tuple[float, tuple[Term, ...], Candidate] | None = None
    for bend in bends:
        candidate, gain = best_hysteresis(regression.sessions, straight, bend, by_line)
        gain += float(by_line(straight, (), bend).sum()) if bend else 0.0
        room = candidate and fits_in_slots([*bend, *candidate.terms], taken)
        if candidate and room and (best is None or gain > best[0]):
            best = gain, bend, candidate
    return best


def _chance(regression: Regression, beside: Terms, candidate: Candidate) -> tuple[float, float]:
    """The chance that noise gains as much by any of the forms, and the likelihood ratio."""
    ratio = float(regression.gains(beside, [candidate.terms]).sum())
    return family_p(ratio, 3 * len(candidate.terms), _tried(candidate)), ratio


def _factor(straight: Terms, bends: Sequence[Terms], whole: Terms, by_line: PiecesByLine) -> float:
    """By how much the error of pieces left out falls from that beside the best bend, geometric mean
    over the axes; the kernels, whose curve bends already, may have found none."""
    logs = [np.log(np.nanmean(by_line.residual(straight, t) ** 2, axis=0)) for t in (whole, *bends)]
    return float(np.exp(0.5 * (min(x.mean() for x in logs[1:]) - logs[0].mean())))


def _rival(
    straight: Terms, bend: Terms, pool: Sequence[Candidate], by_line: PiecesByLine
) -> tuple[Candidate, float]:
    """The simpler effect that predicts best with the bend, and the nats."""
    simpler = [c for c in pool if c.kind in SIMPLER]
    gains = [float(by_line(straight, (), (*bend, *c.terms)).sum()) for c in simpler]
    best = int(np.argmax(gains))
    return simpler[best], gains[best]


def _tried(candidate: Candidate) -> float:
    """Forms compared, times the choices among widths that differ."""
    widths = len({t.width for t in candidate.terms})
    return 2.0 * MOST_OPERATORS * comb(_APART, widths)


def _forms(sessions: Sequence[Session], beside: Terms) -> Iterator[tuple[Term, ...]]:
    """Of every number of operators, with squares and without, the widths that fit best."""
    fits = _Fits(sessions, beside)
    for powers in ((1,), (1, 2)):
        for number in range(1, MOST_OPERATORS + 1):
            yield fits.terms(fits.best(number, powers), powers)


def span_of(sessions: Sequence[Session]) -> tuple[float, float, float]:
    """Lowest, highest and mean temperature of some sessions, these weighing alike, degC."""
    degc = [s.source("temp") for s in sessions]
    lowest, highest = min(d.min() for d in degc), max(d.max() for d in degc)
    return float(lowest), float(highest), float(np.mean([d.mean() for d in degc]))


def _some_of(session: Session) -> np.ndarray:
    """(n, few) indices of ticks, evenly within each block."""
    ticks = session.ticks_per_block
    within = ((np.arange(_A_BLOCK) + 0.5) * ticks / _A_BLOCK).astype(int)
    return np.arange(session.blocks)[:, None] * ticks + within


class _Fits:
    """Least squares over the blocks of some sessions, an offset each, beside other terms."""

    def __init__(self, sessions: Sequence[Session], beside: Terms) -> None:
        self._sessions = sessions
        self._span = self._lo, self._hi, self._centre = span_of(sessions)
        self._columns: dict[tuple[float, int], np.ndarray] = {}
        rate = [s.rate_dps[s.available] for s in sessions]
        self.rows = sum(map(len, rate))
        columns = [np.column_stack([block_basis(t, s) for t in beside]) for s in sessions]
        basis = self._stacked(columns)
        self._q = np.linalg.qr(basis / np.maximum(basis.std(axis=0), 1e-300))[0]
        self._y = self._beside(np.vstack([r - r.mean(axis=0) for r in rate]))
        # a few temperatures a block tell widths apart as well as every tick
        self._degc = [s.source("temp")[_some_of(s)] for s in sessions]
        self._grid = np.geomspace(_FINEST, _WIDEST, _GRID) * (self._hi - self._lo)

    def _stacked(self, columns: Sequence[np.ndarray]) -> np.ndarray:
        """Rows of the blocks with a rate, less each session's mean."""
        there = [c[s.available] for c, s in zip(columns, self._sessions)]
        return np.vstack([c - c.mean(axis=0) for c in there])

    def _beside(self, columns: np.ndarray) -> np.ndarray:
        """What the other terms leave of columns."""
        return columns - self._q @ (self._q.T @ columns)

    def term(self, radius: float, power: int) -> Term:
        """A play operator of temperature, or its square."""
        return Term("temp", *self._span, power, memory="play", width=2.0 * float(radius))

    def terms(self, radii: Sequence[float], powers: Sequence[int]) -> tuple[Term, ...]:
        """Those of some radii, each with its powers."""
        return tuple(self.term(r, p) for r in sorted(radii) for p in powers)

    def _column(self, radius: float, power: int) -> np.ndarray:
        if (radius, power) not in self._columns:
            unit = (self._hi - self._lo) / 2
            stands = [(play(d.ravel(), 2 * radius) - self._centre) / unit for d in self._degc]
            for n in (1, 2):
                means = [(p.reshape(-1, _A_BLOCK) ** n).mean(axis=1, keepdims=True) for p in stands]
                self._columns[radius, n] = self._beside(self._stacked(means))[:, 0]
        return self._columns[radius, power]

    def best(self, number: int, powers: Sequence[int]) -> list[float]:
        """The radii of the grid that leave least: evenly apart, then with two in the places
        of any others, until none leaves less. One by one they stop short of it."""
        x = np.column_stack([self._column(r, p) for p in powers for r in self._grid])
        products, xy = x.T @ x, x.T @ self._y
        best, least = np.linspace(0, _GRID - 1, number).round().astype(int), np.inf
        while True:
            choices = _exchanged(best)
            at = np.hstack([choices + _GRID * i for i in range(len(powers))])
            left = self._left(products[at[:, :, None], at[:, None, :]], xy[at])
            if left.min() >= least:
                return [float(r) for r in self._grid[best]]
            least, best = left.min(), choices[left.argmin()]

    def _left(self, products: np.ndarray, xy: np.ndarray) -> np.ndarray:
        """(...,) sum over the axes of the logarithm of the squares left."""
        ridge = TINY * self.rows * np.eye(products.shape[-1])
        fitted = np.linalg.solve(products + ridge, xy)
        whole = (self._y**2).sum(axis=0)
        left = whole - (fitted * (2 * xy - products @ fitted)).sum(axis=-2)
        return np.log(np.maximum(left, 1e-9 * whole)).sum(axis=-1)


def _exchanged(choice: np.ndarray) -> np.ndarray:
    """(n, number) places of the grid, of which all but two at most are those of a choice."""
    new = min(2, len(choice))
    every = np.array(list(combinations(range(_GRID), new)))
    rows = []
    for kept in combinations(choice, len(choice) - new):
        free = every[~np.isin(every, kept).any(axis=1)]
        rows.append(np.hstack([np.tile(np.array(kept, int), (len(free), 1)), free]))
    return np.vstack(rows)
