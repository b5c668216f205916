"""The settings and the state of the source against the accelerometer, made once."""

from array import array
from math import pi

STATE_WORDS = 55
# Of how far the deviations go, what a motion that pushes always the same way hides from their
# signs: at most a tenth on simulated strides (docs/motion.md), of which one sigma is some half.
PUSH = 16


def realtime_settings(
    odr_hz=100.0,
    gyro_lsb_per_dps=131.0,
    accel_lsb_per_g=16384.0,
    sub_unit_s=0.5,
    units=8,
    threshold=3,
    dead_dps=0.03,
    coarse_dps=0.1,
    fine_dps=0.0125,
    document=False,
):
    """Return the settings as array('i'), 12 words.

    units: sub-units an interval; threshold: what a counter must pass; coarse_dps, fine_dps: first
    and smallest step. document: one step of coarse_dps and no dead band. Raises ValueError.
    """
    if not accel_lsb_per_g:
        raise ValueError("learning by gravity needs an accelerometer")
    if not odr_hz * sub_unit_s >= 2:
        least_hz = 2 / sub_unit_s
        raise ValueError("learning by gravity needs %g Hz or more, not %g" % (least_hz, odr_hz))
    if not 0 <= threshold < units:
        raise ValueError("the threshold must be below the sub-units")
    per_lsb_us = pi / 180 / gyro_lsb_per_dps * 1e-6 * (1 << 22) / 256
    sample_us = 1e6 / odr_hz
    shift = 15
    while per_lsb_us * sample_us * (1 << shift) < 4096 and shift < 30:
        shift += 1
    gain_shift = 0
    while per_lsb_us * (1 << shift) * (1 << gain_shift) < 1024 and gain_shift < 28:
        gain_shift += 1
    q8 = gyro_lsb_per_dps * 256
    c = [0] * 12
    c[0] = int(sub_unit_s * 1e6)
    c[1] = int(per_lsb_us * (1 << shift) * (1 << gain_shift) + 0.5)
    c[2] = gain_shift
    c[3] = shift
    c[4] = units
    c[5] = threshold
    c[6] = 0 if document else int(dead_dps * sub_unit_s * pi / 180 * 8192)
    c[7] = max(1, int(coarse_dps * q8))
    c[8] = max(1, int(fine_dps * q8))
    c[9] = int(accel_lsb_per_g)
    c[10] = int(2 * sample_us)
    c[11] = 0 if document else max(1, int(4 * q8 * 180 / pi / 8192 / sub_unit_s / PUSH))
    return array("i", c)


def realtime_state(settings):
    """Return the state as array('i'), nothing known yet."""
    from .realtime import clear

    state = array("i", [0] * STATE_WORDS)
    clear(state, settings)
    return state
