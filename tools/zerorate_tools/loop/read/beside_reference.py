"""How late readings are beside a given rate or attitude, from products summed a tick."""

import numpy as np


def change_of(t_us: np.ndarray, reference_dps: np.ndarray) -> np.ndarray:
    """(n, 3) dps a second; NaN at the ends, beside a gap and where the reference is not known."""
    change = np.full(reference_dps.shape, np.nan)
    if len(t_us) < 3:
        return change
    span_s = (t_us[2:] - t_us[:-2]) * 1e-6
    with np.errstate(invalid="ignore", divide="ignore"):
        slope = (reference_dps[2:] - reference_dps[:-2]) / span_s[:, None]
    change[1:-1] = np.where((span_s < 1.5 * np.median(span_s))[:, None], slope, np.nan)
    return change


def delay_products(miss_dps: np.ndarray, change_dps2: np.ndarray) -> np.ndarray:
    """(n, 2) from which a delay is estimated: the error (n, 3) about its mean with the rate's
    change a second (n, 3), and that squared."""
    miss = miss_dps - (miss_dps.mean(axis=0) if len(miss_dps) else 0.0)
    return np.column_stack([(miss * change_dps2).sum(axis=1), (change_dps2**2).sum(axis=1)])
