"""What the page draws of an analysis: the only place that knows the loop's own objects."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..allan import Noise
from ..loop.fit.noise import noise_of
from ..loop.fit.regression import predicted
from ..loop.read.sessions import Session
from ..loop.verify.analysis import Analysis
from ..loop.verify.judge import scored

_MDPS = 1e3
#: Blocks on either side from which a temperature's trend is taken.
_TREND_BLOCKS = 2
_HELD_DEGC_PER_MIN = 0.06


@dataclass(frozen=True)
class HeldOut:
    """A held-out recording by blocks: minutes (n,), temp_degc (n,) or None, trend (n,) +1 heating,
    -1 cooling, 0 held; before_mdps, after_mdps (n, 3), NaN where nothing was scored.
    """

    name: str
    minutes: NDArray
    block_s: float
    temp_degc: NDArray | None
    trend: NDArray
    before_mdps: NDArray
    after_mdps: NDArray
    start_us: int


def held_out(analysis: Analysis) -> list[HeldOut]:
    """The recordings that were held out, with their error before and after."""
    judged = analysis.judgement
    return [
        HeldOut(
            name=session.name,
            minutes=minutes(session),
            block_s=session.block_s,
            temp_degc=temperature(session),
            trend=trend(session),
            before_mdps=_MDPS * before,
            after_mdps=_MDPS * after,
            start_us=session.start_us,
        )
        for session, before, after in zip(
            analysis.holdout, judged.residual_before, judged.residual_after
        )
    ]


def trained_residuals(analysis: Analysis) -> list[tuple[Session, NDArray]]:
    """(session, (n, 3) mdps left by the whole model) of what was fitted on."""
    terms = [*analysis.selection.straight, *analysis.selection.terms]
    out = []
    for session in analysis.train:
        model = predicted(terms, analysis.coefficients, session)
        out.append((session, _MDPS * scored(session, model, session)[0]))
    return out


def fitted_noise(analysis: Analysis) -> list[Noise]:
    """White noise, flicker and random walk of each axis, as the floor is taken from."""
    whole = [*analysis.selection.straight, *analysis.selection.terms]
    return noise_of(analysis.judgement.whole, whole)


def minutes(session: Session) -> NDArray:
    """(n,) middle of each block, minutes since the recording's start."""
    return (np.arange(session.blocks) + 0.5) * session.block_s / 60


def temperature(session: Session) -> NDArray | None:
    """(n,) degC by block, None without a thermometer."""
    ticks = session.sources.get("temp")
    return None if ticks is None else session.block_mean(ticks)


def trend(session: Session) -> NDArray:
    """(n,) int: 1 where the temperature rises, -1 where it falls, 0 where it is held."""
    temp = temperature(session)
    if temp is None or len(temp) < 2 * _TREND_BLOCKS + 1:
        return np.zeros(session.blocks, int)
    padded = np.pad(temp, _TREND_BLOCKS, mode="edge")
    rise = padded[2 * _TREND_BLOCKS :] - padded[: -2 * _TREND_BLOCKS]
    per_min = rise / (2 * _TREND_BLOCKS * session.block_s / 60)
    return np.where(np.abs(per_min) < _HELD_DEGC_PER_MIN, 0, np.sign(per_min)).astype(int)
