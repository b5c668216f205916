"""The held-out session, looked at once: before and after, and how sure each effect is."""

from dataclasses import dataclass

import numpy as np

from ...model.term import Terms
from ..fit.common_cause import RARE, coherence
from ..fit.left_out import of_plays, session_misfit
from ..fit.noise import IS_STEEP, NATS
from ..fit.regression import Regression, predicted
from ..fit.single import PiecesByLine
from ..read.sessions import Session
from ..search.selection import Selection, deployed


@dataclass
class ResidualTest:
    """p of independence of the axes, nats by which smooth drift beats noise on the worst axis,
    direction (3,).
    """

    coherence_p: float
    steep_nats: float
    direction: np.ndarray

    @property
    def left(self) -> bool:
        """Whether something beyond the noise is left."""
        return self.common or self.smooth

    @property
    def common(self) -> bool:
        """Whether it moves the axes together."""
        return self.coherence_p < RARE

    @property
    def smooth(self) -> bool:
        """Whether it is smoother than white, flicker and random walk."""
        return self.steep_nats > NATS


def residual_test(regression: Regression, terms: Terms) -> ResidualTest:
    """Look at what the terms leave, in the sensor's own axes."""
    with regression.in_sensor_axes():
        p, covariance = coherence(regression, terms)
        loglik = regression.fit(terms).base.loglik
    steep = (loglik[:, IS_STEEP].max(axis=1) - loglik[:, ~IS_STEEP].max(axis=1)).max()
    direction = np.linalg.eigh(covariance)[1][:, -1]
    return ResidualTest(p, float(steep), direction)


@dataclass
class Judgement:
    """What the held-out sessions say. *_dps: (3,) RMS; residual_*: (n, 3) of each of them, NaN
    where unscored.
    """

    before_dps: np.ndarray
    after_dps: np.ndarray
    gains: np.ndarray
    residual_test: ResidualTest
    residual_before: list[np.ndarray]
    residual_after: list[np.ndarray]
    offsets_dps: list[np.ndarray]
    whole: Regression

    def confidence(self, i: int) -> str:
        """confirmed or tentative, of the i-th effect."""
        better = self.gains[i] > NATS and self.after_rms <= self.before_rms
        return "confirmed" if better and not self.residual_test.left else "tentative"

    @property
    def before_rms(self) -> float:
        """RMS over the axes, dps."""
        return float(np.sqrt((self.before_dps**2).mean()))

    @property
    def after_rms(self) -> float:
        """RMS over the axes, dps."""
        return float(np.sqrt((self.after_dps**2).mean()))


def judge(selection: Selection, holdout: list[Session]) -> Judgement:
    """Judge what was selected on training sessions by sessions that no fit has seen; or, where the
    one session was fitted, by pieces of it left out in turn.
    """
    train, pieces = selection.regression, _pieces(selection, holdout)
    before, after = (residuals(selection, holdout, effects) for effects in (False, True))
    both = [*selection.straight, *selection.terms]
    whole = train if pieces else Regression([*train.sessions, *holdout])
    if not pieces:
        whole.settle(both)
    gains = _of_each(selection, pieces) if pieces else _gains(whole, selection, len(train.sessions))
    return Judgement(
        rms_dps([r for r, _ in before]),
        rms_dps([r for r, _ in after]),
        gains,
        residual_test(whole, both),
        [r for r, _ in before],
        [r for r, _ in after],
        [o for _, o in after],
        whole,
    )


def _pieces(selection: Selection, holdout: list[Session]) -> PiecesByLine | None:
    fitted = selection.regression.sessions
    alone = [s.name for s in fitted] == [s.name for s in holdout]
    return PiecesByLine(fitted[0]) if alone else None


def _of_each(selection: Selection, pieces: PiecesByLine) -> np.ndarray:
    """(effects,) nats that the pieces left out lose without an effect."""
    every = range(len(selection.found))
    rest = [selection.without(i).terms for i in every]
    own = [selection.found[i].candidate.terms for i in every]
    return np.array([pieces(selection.straight, r, o).sum() for r, o in zip(rest, own)])


def residuals(
    selection: Selection, holdout: list[Session], effects: bool = True
) -> list[tuple[np.ndarray, np.ndarray]]:
    """(residual, offset) of each session held out, with the effects found or the line alone."""
    pieces = _pieces(selection, holdout)
    if pieces:
        terms, applied = (selection.terms, selection.applied) if effects else ([], None)
        return [(pieces.residual(selection.straight, terms, applied), np.zeros(3))]
    terms, coefficients = deployed(selection, effects)
    return [scored(s, predicted(terms, coefficients, s)) for s in holdout]


def scored(session: Session, model: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Residual (n, 3) with the turn-on offset taken, and that offset (3,).

    The offset is that of the session's first still minute, which is not scored.
    """
    residual = np.where(session.available[:, None], session.rate_dps - model, np.nan)
    first = session.first_still
    offset = residual[first].mean(axis=0)
    residual = residual - offset
    residual[: first[-1] + 1] = np.nan
    return residual, offset


def rms_dps(residuals: list[np.ndarray]) -> np.ndarray:
    """(3,) RMS over all blocks scored."""
    return np.sqrt(np.nanmean(np.vstack(residuals) ** 2, axis=0))


def _gains(whole: Regression, selection: Selection, trained: int) -> np.ndarray:
    """(effects,) nats that the held-out sessions lose when an effect is left out and the rest
    refitted.
    """
    every = [*selection.straight, *selection.terms]
    full = whole.fit(every).base
    holdout = range(trained, len(whole.sessions))

    def misfit(terms: Terms) -> float:
        g = whole.cross_products(terms)
        train_only = [g.of(np.r_[np.arange(trained), s]) for s in holdout]
        scales = [np.vstack([whole.scale[:trained], whole.scale[s : s + 1]]) for s in holdout]
        known = full.best, full.variance
        shrunk = of_plays(g.of(np.arange(trained)), whole.scale[:trained], terms)
        each = zip(train_only, scales)
        return sum(session_misfit(t, trained, *known, c, shrunk) for t, c in each)

    with_all = misfit(every)
    out = []
    for i in range(len(selection.found)):
        rest = [*selection.straight, *selection.without(i).terms]
        out.append(0.5 * (misfit(rest) - with_all))
    return np.array(out)
