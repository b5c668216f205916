"""How well the motion so far shows each of the nine entries of a gyroscope's matrix.

The windows and their statement are those of `close`. The latest part of the recording is fitted
again as its windows come. What earlier parts state is kept and added, so that a look costs the same
however long the recording is.
"""

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from ..loop.motion.columns import MATRIX
from ..loop.motion.device import SIZES, Shown
from ..loop.motion.matrix import Fitted, beside
from ..loop.motion.moving import moving_of
from ..loop.motion.windows import LEAST_WINDOWS
from ..recordings import Recording, Scales, write_recording
from ..recordings.recording import GYRO, TIME, Columns

#: A posterior sigma at which an entry is known: a full turn is then right to a third of a degree.
KNOWN = 0.001
#: Before there are eight windows of 40 s, whose fit would take as long as a window is apart.
_PART_S = 105.0
_RAIL = 32767
#: An axis is asked for at least as long as the shortest window lasts.
_TURN_S = 10.0
_WIDE = np.eye(MATRIX) * SIZES[-1] ** -2


class KnownSoFar:
    """What a recording that is being made shows.

    matrix: (3, 3) the likeliest entries, axis that reads by axis that is turned; sigma: (3, 3) of
    each, under a prior as wide as data sheets allow; confirmed: the same, without that quarter of
    the latest windows whose loss is worst, as `close` judges on windows that it leaves out.
    next_axis: what to turn about; seconds: recorded so far; lately_dps: (3,) RMS of the last rates;
    clipped: samples at the rail.
    """

    def __init__(self, scales: Scales) -> None:
        self._scales = scales
        self._batches: list[Columns] = []
        self._kept = Shown()
        self._asked_s = 0.0
        self._turned_deg = np.zeros(3)
        self.seconds, self.clipped, self.next_axis = 0.0, 0, 0
        self.lately_dps, self.matrix = np.zeros(3), np.zeros((3, 3))
        self.sigma = self.confirmed = np.full((3, 3), SIZES[-1])

    def look(self, batches: list[Columns]) -> None:
        """Take samples that came since, in their order, and what they show."""
        self._feel(_joined(batches))
        self._batches += batches
        columns = _joined(self._batches)
        fitted = self._fitted(columns)
        if fitted is not None:
            self._know(fitted)
        if columns[TIME][-1] - columns[TIME][0] >= _PART_S * 1e6:
            self._kept += Shown() if fitted is None else fitted.shown(self.matrix)
            self._batches = []
        if self.seconds - self._asked_s >= _TURN_S:
            self._asked_s, self.next_axis = self.seconds, self._least_known()

    def _feel(self, new: Columns) -> None:
        words = np.column_stack([new[n] for n in GYRO])
        self.clipped += int((np.abs(words) >= _RAIL).any(axis=1).sum())
        self.lately_dps = (words / self._scales.gyro_lsb_per_dps).std(axis=0)
        before, self.seconds = self.seconds, int(new[TIME][-1]) * 1e-6
        self._turned_deg += self.lately_dps * (self.seconds - before)

    def _fitted(self, columns: Columns) -> Fitted | None:
        with TemporaryDirectory() as folder:
            path = Path(folder) / "part.parquet"
            write_recording(Recording(columns, self._scales), path)
            moving = moving_of(path)
        fitted = None if moving is None else beside(moving, self.matrix)
        return fitted if fitted is not None and len(fitted.rows.errors) >= LEAST_WINDOWS else None

    def _know(self, fitted: Fitted) -> None:
        whole = self._kept + fitted.shown(self.matrix)
        less = [self._kept + fitted.without(self.matrix, k) for k in sorted(set(fitted.folds))]
        self.sigma = _sigma(whole)
        self.confirmed = np.max([_sigma(s) for s in less], axis=0)
        self.matrix = np.linalg.solve(whole.normal + _WIDE, whole.right).reshape(3, 3)

    @property
    def all_known(self) -> bool:
        """Whether every entry is, whichever quarter is left out."""
        return bool((self.confirmed <= KNOWN).all() and (self.sigma <= KNOWN).all())

    def _least_known(self) -> int:
        """The axis of whose turns something is known worst; of equals the one turned least."""
        sigma = self.confirmed if (self.sigma <= KNOWN).all() else self.sigma
        return int(np.lexsort((self._turned_deg, -sigma.max(axis=0)))[0])


def _joined(batches: list[Columns]) -> Columns:
    return {name: np.concatenate([b[name] for b in batches]) for name in batches[0]}


def _sigma(shown: Shown) -> np.ndarray:
    return np.sqrt(np.diag(np.linalg.inv(shown.normal + _WIDE))).reshape(3, 3)
