"""Ways to a gyroscope's bias, each a function of the sessions' samples.

A peer takes a sequence of Given, one a power-on, and returns for each the bias (n, 3) in dps that
it would have subtracted from each sample; NaN where it cannot be run (a channel is absent).
"""

from .firmware import Peer, firmware
from .given import Given, given
from .online import first_seconds, fusion, vqf_clip_raised, vqf_default

__all__ = [
    "Given", "Peer", "firmware", "first_seconds", "fusion", "given", "vqf_clip_raised",
    "vqf_default",
]  # fmt: skip
