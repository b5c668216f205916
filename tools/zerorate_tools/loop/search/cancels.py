"""Whether an effect only stands against others."""

from collections.abc import Sequence

from ...model.term import Term
from ..fit.line import ordinary
from ..fit.regression import predicted
from ..read.sessions import Session

#: Of the error without it that an effect may be. Lags of real parts are 0.6 times; what tells a
#: start's decay from a warm-up by cancelling both is 6 times and more.
_MOST_TIMES = 2.0


def cancels(sessions: Sequence[Session], beside: Sequence[Term], terms: Sequence[Term]) -> bool:
    """Whether terms are far larger than the error that they explain: then they only stand against
    others, as a start's decay against a warm-up, and not at another power-on."""
    without = _squares(sessions, beside, ordinary(beside, sessions) if beside else (), True)
    fitted = ordinary([*beside, *terms], sessions)[len(beside) :]
    return _squares(sessions, terms, fitted, False) > _MOST_TIMES**2 * without


def _squares(sessions, terms, coefficients, left: bool) -> float:
    """Of what terms add to the bias, or leave of it, offsets aside, in all."""
    total = 0.0
    for s in sessions:
        added = predicted(terms, coefficients, s)
        values = s.rate_dps - added if left else added
        total += float((s.less_offsets(values, s.available)[s.available] ** 2).sum())
    return total
