"""How far the model's integers are from its numbers."""

import numpy as np

from ...model import Model
from ...model.term import evaluate
from ...recordings import Scales
from ..read.ticks import has_one_sample
from .firmware import Firmware
from .power_on import BlockMeans, PowerOn


def rounding_dps(
    power_on: PowerOn, model: Model, terms, coefficients, scales: Scales
) -> np.ndarray:
    """(3,) RMS over a session's blocks of the firmware's effects less the same terms in floats.

    terms, coefficients: what the model was made of, (terms, 3) dps per unit. The firmware holds
    the value of a tick during the next one, and so does the reference, but where a tick is one
    sample, which it corrects by itself.
    """
    s = power_on.session
    cold = Firmware(scales, model, power_on.channels)
    means = BlockMeans(power_on)
    for frames in power_on.frames():
        means.add(frames, cold.run(frames, learn=False))
    exact = np.zeros((s.blocks * s.ticks_per_block, 3))
    for term, c in zip(terms, coefficients):
        exact += np.outer(evaluate(term, s.source, s.tick_s), c)
    if not has_one_sample(scales, s.tick_s):
        exact = np.vstack([exact[:1], exact[:-1]])
    error = means.blocks_dps() - power_on.block_means(exact)
    return np.sqrt(np.nanmean(error[s.available] ** 2, axis=0))
