"""A trace that makes the firmware do everything it can, from integers alone.

No float stands in its recipe and no number in it leaves 31 bits, so it is the same on every
interpreter, and its frames are made in place: it runs under a locked heap. Times are of 25 Hz.
"""

UPDATES = {"default": 20000, "every": 3000, "document": 3000, "ignoring": 2000}
ACT = 64  # updates: one still segment
PERIOD_US = 40000

SENSOR = (25.0, 131.0, 16384.0, 340.0, 36.53)
# Seconds instead of minutes, so that a trace of minutes sees what a day would.
LIMITS = {
    "promote_s": 4.0,
    "halve_after_s": 60.0,
    "fit_s": 5.0,
    "insist_s": 10.0,
}
MODES = {
    "default": {"motion": False, "gravity": False},
    "every": {"every": True},
    "document": {"document": True, "ignore_outside": False, "range_dps": 40.0, "stable_s": 2.5},
    "ignoring": {"every": True, "ignore_outside": True, "range_dps": 20.0},
}

_DEGREE = 340
_STILL_ACTS = 10
_BROKEN_ACT = 14
GENERATOR = (1, 2, 1, 2)


def noise(r, most):
    """Return a number of a triangular distribution within +-most (below 2^13); r: the generator."""
    r[0] = (r[0] * 75 + 74) % 65537
    r[1] = (r[1] * 389 + 17) % 65521
    return (((r[0] - r[1]) >> 1) * most) >> 15


def repeat_or_go_on(r, repeat):
    """Take the generator back to the frame before, or note where this frame begins."""
    for i in range(2):
        if repeat:
            r[i] = r[2 + i]
        else:
            r[2 + i] = r[i]


def degree(act):
    """Return the temperature of an act in whole degrees: up and down, at first without resting."""
    step = (act if act < 8 else act // 3) % 26
    return step if step < 13 else 26 - step


def fill(x, n, r):
    """Make the frame `n` in x; return its dt_us."""
    act = n // ACT
    repeat_or_go_on(r, act % 16 == _BROKEN_ACT and n % 8 == 5)
    warm = degree(act) * _DEGREE
    x[0] = noise(r, 40)
    x[1] = noise(r, 40)
    x[2] = 16384 + noise(r, 40)
    x[3] = 2000 + warm + noise(r, 20)
    x[4] = 2600 + (warm >> 3) + noise(r, 12)
    x[5] = -5200 + (warm * warm >> 17) + noise(r, 12)
    x[6] = 30 - (warm >> 5) + noise(r, 12)
    if act >= 200:
        x[6] += 100  # a step that insists
    act = act % 16
    if act >= _STILL_ACTS and act <= _BROKEN_ACT:
        return disturb(x, n, r, act - _STILL_ACTS)
    return PERIOD_US


def disturb(x, n, r, how):
    """Do to the frame what is not a rest."""
    if how == 0:
        for i in range(4, 7):
            x[i] += noise(r, 8000)
    elif how == 1:
        x[0] += noise(r, 4000)
    elif how == 2:
        x[4] += 131
        x[1] += (n % ACT) * 11
    elif how == 3:
        x[6] += 40 * (n % ACT >> 5)
    elif n % 8 == 0:
        return break_frame(x, n // 8 % 7)
    return PERIOD_US


def break_frame(x, how):
    """Make of the frame what a bad bus makes of it; return its dt_us."""
    if how == 0:
        x[4 + x[3] % 3] = -32768
    elif how < 3:
        for i in range(7):
            x[i] = 1 - how
    elif how == 3:
        x[3] += 3000
    elif how == 4:
        return 0
    elif how == 5:
        return 2000000
    else:
        return -PERIOD_US
    return PERIOD_US
