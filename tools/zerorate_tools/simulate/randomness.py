"""Random streams that do not disturb each other."""

import zlib

import numpy as np


def stream(seed: int, session: int, purpose: str) -> np.random.Generator:
    """A generator for one purpose of one session.

    Noise stays the same sample for sample when an effect is added, so two runs differ by it alone.
    """
    return np.random.default_rng([seed, session, zlib.crc32(purpose.encode())])
