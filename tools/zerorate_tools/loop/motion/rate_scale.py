"""What motion says of scale factor and axes: what the gyroscope adds in proportion to the rate."""

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class RateScale:
    """What the windows of the training recordings say, and what those held out say of it.

    matrix: (3, 3) dps per dps, what the gyroscope adds; p_value: of no such matrix; kind:
    scale-factor, cross-axis, turned-axes or several; reference: what it was measured against;
    gains: by how much windows left out are better, each way to tell it; before, after: RMS of what
    turns them, in `unit`; fastest_dps: (3,) up to which it was seen; unseen: (3, 3) bool, entries
    that the motion did not show; level: of p; share: how much of the matrix is deployed.
    """

    matrix: np.ndarray
    deviation: np.ndarray
    p_value: float
    kind: str
    reference: str
    gains: np.ndarray
    before: float
    after: float
    unit: str
    runs: int
    fastest_dps: np.ndarray
    unseen: np.ndarray
    level: float
    share: float = 1.0

    @property
    def found(self) -> bool:
        """Whether M is significant and what was left out is better with it."""
        return self.p_value < self.level and bool((self.gains > 0).all())

    @property
    def deployed(self) -> np.ndarray:
        """(3, 3) of the matrix, what is taken out."""
        return self.share * self.matrix

    @property
    def confirmed(self) -> bool:
        """Whether the windows held out, of which there must be some, are better with it."""
        return self.found and bool(np.isfinite(self.after)) and self.after < self.before
