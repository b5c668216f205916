"""How sure a share is."""

import math

_Z95 = 1.959964


def interval(hits: int, of: int) -> tuple[float, float]:
    """95 % interval of a share of `of` tries, 0..1 (Wilson 1927, J. Am. Stat. Assoc. 22, 209)."""
    if not of:
        return 0.0, 1.0
    share, z2 = hits / of, _Z95**2
    middle = (share + z2 / (2 * of)) / (1 + z2 / of)
    half = _Z95 / (1 + z2 / of) * math.sqrt(share * (1 - share) / of + z2 / (4 * of * of))
    return max(0.0, middle - half), min(1.0, middle + half)
