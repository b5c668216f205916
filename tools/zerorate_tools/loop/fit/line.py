"""The straight line over temperature as the firmware's estimators learn it: equal weights, not the
noise's.

The loop's effects are fitted by generalised least squares; what is learned on the board is not, so
before and after are both judged with an ordinary least-squares line on the rates less the effects.
"""

from __future__ import annotations

import numpy as np

from ..read.sessions import block_basis
from .regression import predicted


def ordinary(terms, sessions, effects=(), coefficients=None) -> np.ndarray:
    """(terms, 3) dps per unit by least squares over blocks, an offset a session, effects subtracted
    first.
    """
    x, y = [], []
    for s in sessions:
        there = s.available
        rate = s.rate_dps - (predicted(effects, coefficients, s) if len(effects) else 0.0)
        columns = np.column_stack([block_basis(t, s) for t in terms])
        x.append(s.less_offsets(columns, there)[there])
        y.append(s.less_offsets(rate, there)[there])
    scale = np.maximum(np.vstack(x).std(axis=0), 1e-300)
    return np.linalg.lstsq(np.vstack(x) / scale, np.vstack(y), rcond=1e-12)[0] / scale[:, None]


def deployed(selection, effects: bool = True) -> tuple[list, np.ndarray]:
    """Terms and (terms, 3) coefficients as deployed: the line first, then the effects if wanted.

    Those of a single recording are learned like the line: there the noise's walk is the bend.
    """
    straight, terms = list(selection.straight), list(selection.terms) if effects else []
    sessions, every = selection.regression.sessions, [*straight, *terms]
    if not every:
        return [], np.zeros((0, 3))
    alone = selection.alone
    whole = ordinary(every, sessions) if alone else selection.regression.fit(every).coefficients
    fitted = whole[len(straight) :] * (selection.applied if effects else 1.0)
    if not straight:
        return terms, fitted
    return every, np.vstack([ordinary(straight, sessions, terms, fitted), fitted])
