"""Says in words what the sources that need no rest are doing: in motion, and against gravity."""

# layout: names that a board's own compiler reads
const = int
# layout: The state of the source in motion
_MOTION_REASON = const(17)
_ACCEPTED = const(70)
_REFUSED = const(71)
_MOTION_BIAS_Q8 = const(73)
_MOTION_QUALITY_Q8 = const(76)
# layout: The state of the source against gravity
_GRAVITY_BIAS_Q8 = const(28)
_GRAVITY_QUALITY_Q8 = const(31)
_OBSERVED = const(37)
_GRAVITY_REASON = const(49)
# layout: The settings of the source against gravity
_SUB_UNIT_US = const(0)
# layout: What a window in motion taught, in words
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
# layout: What a sub-unit against gravity was, in words
LEVEL = (
    "no half-second has been seen yet",
    "counting",
    "nothing is counted: the force is not 1 g",
    "nothing is counted: samples were missing",
)
# layout: Values that stand for none
_UNKNOWN_Q8 = const(0x1FFFFFFF)
# layout: end


def explain_sources(corrector):
    """Return the lines on the sources that are on."""
    lines = []
    sensor = corrector.sensor
    m = corrector.motion
    if m is not None:
        counts = (MOTION[m[_MOTION_REASON]], m[_ACCEPTED], m[_REFUSED])
        text = "In motion: %s (%d windows learned, %d refused)" % counts
        lines.append(text + found(m, _MOTION_BIAS_Q8, _MOTION_QUALITY_Q8, sensor))
    r = corrector.gravity
    if r is not None:
        text = "Against gravity: %s" % LEVEL[r[_GRAVITY_REASON]]
        lines.append(text + found(r, _GRAVITY_BIAS_Q8, _GRAVITY_QUALITY_Q8, sensor))
        seen = [observed(r, corrector.gravity_settings, axis) for axis in range(3)]
        lines.append("Observable against gravity: %s." % ", ".join(seen))
    return lines


def found(s, bias_q8, sigma_q8, sensor):
    """Return the bias of each axis with its one sigma, from those words of `s` on."""
    text = []
    for axis in range(3):
        if s[sigma_q8 + axis] < _UNKNOWN_Q8:
            lsb = 256 * sensor.gyro_lsb_per_dps
            # what is shown as zero has no minus
            pair = (round(s[bias_q8 + axis] / lsb, 3) + 0.0, s[sigma_q8 + axis] / lsb)
            text.append("g%s %.3f +-%.3f" % (("xyz"[axis],) + pair))
    return "; %s dps." % ", ".join(text) if text else "."


def observed(r, c, axis):
    """Return for how long the axis was observable."""
    if r[_OBSERVED + axis] == 0:
        return "g%s not at all, gravity lies along it" % "xyz"[axis]
    return "g%s for %d s" % ("xyz"[axis], r[_OBSERVED + axis] * c[_SUB_UNIT_US] // 1000000)
