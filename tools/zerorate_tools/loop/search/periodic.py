"""Lines of all sessions together: slow ones from ticks, quick ones from samples."""

from collections.abc import Sequence

import numpy as np

from ...model.term import Terms, evaluate
from ..read.blocks import BRIDGED_SHARE
from ..read.lines import MOST, Line, Spectrum, find, spectrum
from ..read.sessions import Session

_SLOWEST_CYCLES = 10
_LEAST_TICKS = 400
_HANN_BINS = 2.0
_SUBTRACTED = 0.25  # share of a line's power that what was subtracted may have there
#: From here on a line is in the samples and averages out of the bias; slower ones are in the bias.
QUICK_HZ = 0.5


def periodic(
    train: Sequence[Session], holdout: Sequence[Session], terms: Terms, coefficients: np.ndarray
) -> list[Line]:
    """Lines at rest beside what the terms, (terms, 3) dps per unit, explain."""
    quick = _welch(train, holdout)
    slow = _slow(train, holdout, terms, coefficients)
    step_s = train[0].tick_s
    known_hz = train[0].welch.step_hz if train[0].welch else 0.0
    own = (s for s in slow if not any(_folds(q, s, step_s, known_hz) for q in quick))
    return [*quick, *own][:MOST]


def _folds(quick: Line, slow: Line, step_s: float, known_hz: float) -> bool:
    """Whether a slow line is a quick one, whose frequency is known so well, as means over ticks
    show it."""
    alias = abs(quick.hz - round(quick.hz * step_s) / step_s)
    return abs(alias - slow.hz) < known_hz


def _slow(
    train: Sequence[Session], holdout: Sequence[Session], terms: Terms, coefficients: np.ndarray
) -> list[Line]:
    every = [*train, *holdout]
    rates = [r for s in every if (r := _left(s, terms, coefficients)) is not None]
    if len(rates) < len(every):
        return []
    longest = max(len(r) for r in rates)
    length = 1 << int(np.ceil(np.log2(longest)))
    step_s = train[0].tick_s
    spectra = [spectrum(r, step_s, length) for r in rates]
    shortest = min(len(r) for r in rates)
    wide = _HANN_BINS * length / shortest
    slowest = _SLOWEST_CYCLES / (shortest * step_s)
    found = find(spectra[: len(train)], spectra[len(train) :], wide, slowest)
    models = [spectrum(_model(s, terms, coefficients), step_s, length) for s in train]
    return [line for line in found if not _of_models(line, models)]


def _of_models(line: Line, models: list[Spectrum]) -> bool:
    """Whether what was subtracted has as much there: steps of a ramping temperature, for one."""
    at = round(line.hz / models[0].step_hz)
    subtracted = np.mean([2 * m.power[at] for m in models], axis=0)
    return bool(subtracted.sum() > _SUBTRACTED * (line.amplitude_dps**2).sum())


def _model(session: Session, terms: Terms, coefficients: np.ndarray) -> np.ndarray:
    """(m, 3) dps that the terms explain of each tick."""
    out = np.zeros((session.blocks * session.ticks_per_block, 3))
    for term, c in zip(terms, coefficients):
        out += np.outer(evaluate(term, session.source, session.tick_s), c)
    return out


def _left(session: Session, terms: Terms, coefficients: np.ndarray) -> np.ndarray | None:
    """(m, 3) rate of ticks at rest less what the terms explain, None where there is too little."""
    rate = session.ticks_dps
    if rate is None or len(rate) < _LEAST_TICKS:
        return None
    if (~np.isfinite(rate).all(axis=1)).mean() > BRIDGED_SHARE:
        return None
    return rate - _model(session, terms, coefficients)


def _welch(train: Sequence[Session], holdout: Sequence[Session]) -> list[Line]:
    every = [*train, *holdout]
    spectra = [s.welch for s in every if s.welch is not None]
    if len(spectra) < len(every) or len({s.step_hz for s in spectra}) > 1:
        return []
    return find(spectra[: len(train)], spectra[len(train) :], _HANN_BINS, QUICK_HZ)
