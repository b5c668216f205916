"""Pieces of one recording, each predicted by the firmware's own kernels from the others.

The firmware's learned curve bends already. What an effect is worth is therefore not what it gains
on a straight line, but what it gains on a firmware that has learned the other pieces without it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np
from scipy.ndimage import binary_dilation

from ...model import CannotDeploy, Model, Slot, build_model
from ...model.term import Term
from ...recordings import Scales
from ..fit.line import ordinary
from ..fit.single import gap_blocks, held, nats
from ..read.sessions import Session
from .firmware import Firmware, at_once, rows
from .power_on import BlockMeans, PowerOn

_LEAD_BLOCKS = 3


class PiecesByKernels:
    """Judges effects on the pieces of a session; called like `single.PiecesByLine`.

    power_on: the recording; train: the part of it that may be fitted; folds: its pieces.
    """

    reason = "on pieces left out it gains nothing on the firmware's own curve"

    def __init__(
        self, power_on: PowerOn, train: Session, folds: Sequence[Session], scales: Scales
    ) -> None:
        self._power_on, self._scales = power_on, scales
        self._pieces = [f.available for f in folds]
        near = 2 * gap_blocks(train) + 1
        self._others = [
            _only(train, ~binary_dilation(p, np.ones(near, bool))) for p in self._pieces
        ]
        self._known: dict[tuple[Term, ...], np.ndarray] = {}

    def __call__(
        self, straight: Sequence[Term], found: Sequence[Term], candidate: Sequence[Term]
    ) -> np.ndarray:
        """(folds,) nats by which each piece is better predicted with the candidate."""
        before, after = (
            self._squares(straight, terms) for terms in (tuple(found), (*found, *candidate))
        )
        return nats(before, after, [int(p.sum()) for p in self._pieces])

    def _squares(self, straight, terms):
        """(folds, 3) squares left in each piece."""
        if terms not in self._known:
            try:
                models = [self._model(straight, terms, o) for o in self._others]
            except CannotDeploy:
                return np.full((len(self._pieces), 3), np.inf)
            whole = not all(_is_instant(t) for t in terms)
            self._known[terms] = self._left(self._learned(models), whole)
        return self._known[terms]

    def _model(self, straight, terms, part) -> Model | None:
        """The terms fitted to a part of the recording."""
        if not terms:
            return None
        kept = [held(t, [part]) if _is_instant(t) else t for t in terms]
        fitted = ordinary([*straight, *kept], [part])[len(straight) :]
        slots = [Slot(t, (float(x), float(y), float(z)), "") for t, (x, y, z) in zip(kept, fitted)]
        return build_model(slots, self._scales, tick_s=part.tick_s)

    def _learned(self, models) -> list[Firmware]:
        """A device a piece that has learned the others, frozen for it."""
        p = self._power_on
        devices = [Firmware(self._scales, m, p.channels) for m in models]
        devices[0].compile(next(p.frames()))
        for d in devices:
            d.power_on()
        for frames in p.frames():
            may = [o.available[p.blocks(frames)] for o in self._others]
            at_once([partial(d.run, frames, m) for d, m in zip(devices, may)])
        for d in devices:
            d.power_on()
            d.set_offset((0, 0, 0))
        return devices

    def _left(self, devices, whole: bool) -> np.ndarray:
        """(folds, 3) squares. whole: the terms remember what was before the piece."""
        p, lead = self._power_on, self._power_on.session.blocks if whole else _LEAD_BLOCKS
        means = [BlockMeans(p) for _ in devices]
        for frames in p.frames():
            at = p.blocks(frames)
            for device, mean, piece in zip(devices, means, self._pieces):
                where = np.flatnonzero(piece)
                first, last = (where[0], where[-1]) if len(where) else (0, -1)
                a, b = np.searchsorted(at, (first - lead, last + 1))
                if a < b:
                    some = rows(frames, a, b)
                    mean.add(some, device.run(some, learn=False))
        left = [p.rate_dps - m.blocks_dps() for m in means]
        return np.array([(r[s] ** 2).sum(axis=0) for r, s in zip(left, self._pieces)])


def _is_instant(term: Term) -> bool:
    """Whether a term knows nothing of what was before."""
    remembers = term.lag_mode != "none" or term.memory != "none" or term.delay_s or term.decay_s
    return not remembers and "time" not in (term.source, term.second)


def _only(session: Session, keep: np.ndarray) -> Session:
    return replace(session, rate_dps=np.where(keep[:, None], session.rate_dps, np.nan))
