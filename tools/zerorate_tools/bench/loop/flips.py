"""A part turned over: an effect of acceleration, or Earth's rotation?"""

import numpy as np

from ...loop.read.earth import EARTH_DPS


def flip(session, floor_dps: float) -> str:
    """What turning the part over did to its z rate, beside what Earth's rotation can do.

    floor_dps: of the z axis: what a mean over each side is uncertain by.
    """
    up = session.block_mean(session.sources["acc_z"]) > 0
    there = session.available
    if not (up & there).any() or not (~up & there).any():
        return "not turned over"
    change = 1e3 * (
        session.rate_dps[up & there, 2].mean() - session.rate_dps[~up & there, 2].mean()
    )
    sure = 2e3 * floor_dps * np.sqrt(2.0)
    earth = 2e3 * EARTH_DPS
    said = f"{change:+.1f} +- {sure:.1f} mdps over a turn; Earth's rotation can be {earth:.1f}: "
    if abs(change) - sure <= earth:
        return said + "these data cannot tell the two apart"
    return said + f"at least {abs(change) - sure - earth:.1f} mdps are acceleration's"
