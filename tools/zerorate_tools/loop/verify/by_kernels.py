"""Pieces of one recording, each predicted by the firmware's own kernels from the others.

The firmware's learned curve bends already. What an effect is worth is therefore not what it gains
on a straight line, but what it gains on a firmware that has learned the other pieces without it.
"""

from collections.abc import Iterator, Sequence
from functools import partial

import numpy as np

from ...model import CannotDeploy, Model, Slot, drafted
from ...model.term import Terms
from ...recordings import Scales
from ...replay.samples import Frames
from ..fit.single import LEAST_OF_A_PIECE, PiecesByLine, is_instant
from ..read.sessions import Session
from .firmware import Firmware, Refused, at_once, rows
from .power_on import BlockMeans, PowerOn


class PiecesByKernels(PiecesByLine):
    """Judges effects on the pieces of a recording as the board would do with them.

    power_on: the recording; beside: others, to which the models are fitted as well. The devices
    learn this one alone, whose turn-on offset is in their curve.
    """

    reason = "on pieces left out it gains nothing on the firmware's own curve"

    def __init__(
        self,
        power_on: PowerOn,
        scales: Scales,
        beside: Sequence[Session] = (),
    ) -> None:
        super().__init__(power_on.session, beside)
        self.power_on, self._scales = power_on, scales

    def residual(
        self, straight: Terms, terms: Terms, applied: np.ndarray | None = None
    ) -> np.ndarray:
        """(n, 3) dps, each block by a firmware that has not learned it; all NaN where the firmware
        cannot hold the terms."""
        key = (tuple(terms), None if applied is None else applied.tobytes())
        if key not in self._known:
            try:
                devices = self.learned(self.models(straight, terms, applied))
            except (CannotDeploy, Refused):
                return np.full((self.session.blocks, 3), np.nan)
            whole = not all(is_instant(t) for t in terms)
            self._known[key] = self._left(devices, whole)
        return self._known[key]

    def models(
        self,
        straight: Terms,
        terms: Terms,
        applied: np.ndarray | None = None,
        more: Sequence[Slot] = (),
    ) -> list[Model | None]:
        """One a turn, with the terms fitted to what is not left out in it, and with more slots.

        Raises CannotDeploy.
        """
        return [self._model(straight, terms, applied, [*more], part) for part in self.parts]

    def _model(
        self,
        straight: Terms,
        terms: Terms,
        applied: np.ndarray | None,
        more: Sequence[Slot],
        part: Session,
    ) -> Model | None:
        kept, fitted = self.fitted_to(part, straight, terms, applied)
        pairs = list(zip(kept, fitted))[len(straight) :]
        slots = [Slot(t, (float(x), float(y), float(z)), "") for t, (x, y, z) in pairs]
        every = [*slots, *more]
        return drafted(every, self._scales, tick_s=part.tick_s) if every else None

    def new(self, models: Sequence[Model | None]) -> list[Firmware]:
        """A device a turn, which has learned nothing, powered on."""
        devices = [Firmware(self._scales, m, self.power_on.channels) for m in models]
        for d in devices:
            d.power_on()
        return devices

    def learned(self, models: Sequence[Model | None]) -> list[Firmware]:
        """A device a turn that has learned what is not left out in it, ready to be run frozen."""
        p, devices = self.power_on, self.new(models)
        for frames in p.frames():
            may = [part.available[p.blocks(frames)] for part in self.parts]
            at_once([partial(d.run, frames, m) for d, m in zip(devices, may)])
        for d in devices:
            d.power_on()
            d.set_offset((0, 0, 0))
        return devices

    def bias_q8(
        self, devices: Sequence[Firmware], frames: Frames, learn: bool = False
    ) -> np.ndarray:
        """(n, 3) of every sample by the device that its block was left out of, LSB in Q8.

        One device may stand for all.
        """
        turn = self.fold[self.power_on.blocks(frames)]
        each = at_once([partial(d.run, frames, learn) for d in devices])
        return np.array(each)[turn % len(each), np.arange(len(frames))]

    def _left(self, devices: Sequence[Firmware], whole: bool) -> np.ndarray:
        """(n, 3) residuals. whole: the terms remember what was before the piece."""
        p, means = self.power_on, BlockMeans(self.power_on)
        for frames in p.frames():
            if whole:
                means.add(frames, self.bias_q8(devices, frames))
                continue
            at = p.blocks(frames)
            for first, last in self._stretches(at[0], at[-1] + 1):
                lead, a, b = np.searchsorted(at, (first - LEAST_OF_A_PIECE, first, last))
                bias = devices[self.fold[first]].run(rows(frames, lead, b), learn=False)
                means.add(rows(frames, a, b), bias[a - lead :])
        left = np.where(p.scored[:, None], p.rate_dps - means.blocks_dps(), np.nan)
        return self.about_stretches(left)

    def _stretches(self, first: int, last: int) -> Iterator[tuple[int, int]]:
        """(first, one past last) of the blocks from one change of turn to the next."""
        edges = np.flatnonzero(np.diff(self.fold)) + 1
        inside = edges[(edges > first) & (edges < last)]
        return zip(np.r_[first, inside], np.r_[inside, last])
