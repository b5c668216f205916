"""Says in words what the sources that need no rest are doing: in motion, and against gravity."""

from .explain import without_sign

MOTION = (
    "no window has been seen yet",
    "the first windows grow",
    "the latest window taught a bias",
    "the latest window taught nothing: it hardly moves",
    "the latest window taught nothing: it turns and stays turned, or contradicts what is known",
    "the latest window taught nothing: it turns too fast",
    "the latest window taught nothing: the mean force is not 1 g in one direction",
    "the latest window taught nothing: samples were missing",
)
LEVEL = (
    "no half-second has been seen yet",
    "counting",
    "nothing is counted: the force is not 1 g",
    "nothing is counted: samples were missing",
)
_UNKNOWN_Q8 = 0x1FFFFFFF


def explain_sources(corrector):
    """Return the lines on the sources that are on."""
    lines = []
    if corrector.motion is not None:
        lines.append(explain_motion(corrector.motion, corrector.sensor))
    if corrector.level is not None:
        r = corrector.level
        lines.append(explain_level(r, corrector.sensor))
        lines.append(observable(r, corrector.level_settings))
    return lines


def explain_motion(m, sensor):
    """Return a line on the source in motion, whose state is `m`."""
    text = "In motion: %s (%d windows learned, %d refused)" % (MOTION[m[17]], m[67], m[68])
    return text + found(m, 70, sensor)


def explain_level(r, sensor):
    """Return a line on the source against the accelerometer, whose state is `r`."""
    return "Against gravity: %s%s" % (LEVEL[r[49]], found(r, 28, sensor))


def observable(r, c):
    """Return a line on which axes gravity showed, and for how long."""
    seen = [observed(r, c, axis) for axis in range(3)]
    return "Observable against gravity: %s." % ", ".join(seen)


def found(s, a, sensor):
    """Return the bias of each axis at word `a`, with its one sigma three words on."""
    text = []
    for axis in range(3):
        if s[a + 3 + axis] < _UNKNOWN_Q8:
            lsb = 256 * sensor.gyro_lsb_per_dps
            pair = (without_sign(s[a + axis] / lsb), s[a + 3 + axis] / lsb)
            text.append("g%s %.3f +-%.3f" % (("xyz"[axis],) + pair))
    return "; %s dps." % ", ".join(text) if text else "."


def observed(r, c, axis):
    """Return for how long the axis was observable."""
    if r[37 + axis] == 0:
        return "g%s not at all, gravity lies along it" % "xyz"[axis]
    return "g%s for %d s" % ("xyz"[axis], r[37 + axis] * c[0] // 1000000)
