"""The floor: the noise's own colour, estimated with everything found in the model."""

import numpy as np

from ...allan import Noise
from .noise import GRID, IS_STEEP


def noise_of(regression, terms) -> list[Noise]:
    """White, flicker and random walk of each sensor axis, by maximum likelihood over the colour
    grid.

    Steep colours are left out: they stand for causes not found, and the floor is what cannot be
    removed.
    """
    with regression.in_sensor_axes():
        base = regression.fit(terms).base
    block_s = regression.sessions[0].block_s
    out = []
    for a in range(3):
        g = int(np.where(IS_STEEP, -np.inf, base.loglik[a]).argmax())
        white = np.sqrt(base.rss[a, g] / base.count)
        shape = GRID[g]
        out.append(Noise(block_s, white, white * np.sqrt(shape.flicker), white * shape.walk))
    return out


def floor_dps(regression, terms) -> np.ndarray:
    """(3,) lowest Allan deviation of each axis' noise within a session's length."""
    longest = max(s.blocks * s.block_s for s in regression.sessions)
    return np.array([n.floor_dps(longest) for n in noise_of(regression, terms)])
