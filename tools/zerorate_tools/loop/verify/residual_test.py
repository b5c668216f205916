"""Whether more is left than the noise of a part: something common to the axes, or smoother than any
noise.
"""

from dataclasses import dataclass

import numpy as np

from ..fit.common_cause import coherence
from ..fit.noise import IS_STEEP

_COHERENT_BELOW = 1e-3
_STEEP_NATS = 4.0


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
        return self.coherence_p < _COHERENT_BELOW

    @property
    def smooth(self) -> bool:
        """Whether it is smoother than white, flicker and random walk."""
        return self.steep_nats > _STEEP_NATS


def residual_test(regression, terms) -> ResidualTest:
    """Look at what the terms leave, in the sensor's own axes."""
    with regression.in_sensor_axes():
        p, covariance = coherence(regression, terms)
        loglik = regression.fit(terms).base.loglik
    steep = (loglik[:, IS_STEEP].max(axis=1) - loglik[:, ~IS_STEEP].max(axis=1)).max()
    direction = np.linalg.eigh(covariance)[1][:, -1]
    return ResidualTest(p, float(steep), direction)
