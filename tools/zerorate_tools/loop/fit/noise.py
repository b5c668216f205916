"""The colour of the noise in the DCT of a session: white + flicker + random walk, or something
steeper.

Random walk is exactly diagonal in a DCT-II without its mean (the DCT-II diagonalises D'D of the
first difference D), white noise too; flicker is taken as the square root of the random walk's
spectrum, a Whittle approximation.
"""

from dataclasses import dataclass

import numpy as np
from scipy.fft import dct

#: Corner frequencies that are tried, in radians per block; none, where it is 0.
_CORNERS = (0.0, 0.004, 0.01, 0.03, 0.08, 0.2, 0.5, 1.3, 3.5)


@dataclass(frozen=True)
class Shape:
    """Noise spectrum relative to its white part: corner frequencies, in radians per block."""

    flicker: float
    walk: float
    steep: float
    slope: int  # of the steep part: 3 or 4; 0 when there is none


def shapes() -> list[Shape]:
    """The grid over which the noise is refitted with every candidate."""
    plain = [Shape(f, r, 0.0, 0) for f in _CORNERS for r in _CORNERS]
    steep = [Shape(0.0, 0.0, c, a) for a in (3, 4) for c in _CORNERS if c]
    return plain + steep


GRID = shapes()
IS_STEEP = np.array([bool(s.slope) for s in GRID])
#: Odds of twenty to one, as a difference of log likelihoods: by less nothing is told from what
#: competes with it. Steep noise, which can stand for any smooth effect, starts so far behind. As a
#: chance, the usual level of one test.
NATS = 3.0
USUAL = float(np.exp(-NATS))
LOG_PRIOR = -NATS * IS_STEEP


def frequency(n: int) -> np.ndarray:
    """(n - 1,) 2 sin(pi k / 2n), k = 1..n-1: the DCT's frequencies for a first difference."""
    return 2.0 * np.sin(np.pi * np.arange(1, n) / (2 * n))


def spectra(n: int) -> np.ndarray:
    """(shapes, n - 1) relative variance of each DCT coefficient of a session of n blocks."""
    phi = frequency(n)
    rows = []
    for s in GRID:
        row = 1.0 + s.flicker / phi + (s.walk / phi) ** 2
        rows.append(row + (s.steep / phi) ** s.slope if s.slope else row)
    return np.array(rows)


def transform(columns: np.ndarray) -> np.ndarray:
    """Orthonormal DCT-II along the first axis, its mean (the turn-on offset) left out."""
    return dct(columns, axis=0, norm="ortho")[1:]
