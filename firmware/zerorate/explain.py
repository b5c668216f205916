"""Says in words what is being learned, or why nothing is."""

FAULTS = (
    "good frames",
    "repeated frames",
    "frames at the rail",
    "frames of all zeros",
    "frames of all ones",
    "jumps of the temperature",
    "frames at a time that stood still",
    "frames after a leap of time",
)
STILLNESS = (
    "No full window has been seen yet.",
    "The device rests.",
    "No rest to learn from: the gyroscope sees motion.",
    "No rest to learn from: gravity turns, so the device turns slowly.",
    "No rest to learn from: the accelerometer sees motion.",
    "No rest to learn from: the rate has shifted within it.",
)
SOURCES = (
    "no bias yet",
    "any temperature",
    "the fit over temperature",
    "this temperature",
    "motion",
    "the accelerometer",
)


def explain(corrector):
    """Return the text for a Corrector."""
    s = corrector.state
    c = corrector.settings
    sensor = corrector.sensor
    lines = [STILLNESS[s[46]]]
    if s[46] == 1:
        lines.append("%d of %d windows of a still segment." % (s[48], c[5]))
    for axis in range(3):
        lines.append(axis_text(s, c, sensor, axis))
    faults = ["%d %s" % (s[8 + i], FAULTS[i]) for i in range(1, 8) if s[8 + i]]
    if faults:
        lines.append("Not learned from: " + ", ".join(faults) + ".")
    if not sensor.accel_lsb_per_g:
        lines.append("Without an accelerometer a slow turn cannot be told from a bias.")
    if not sensor.temp_lsb_per_degc:
        lines.append("Without a thermometer all temperatures count as one.")
    if corrector.motion is not None or corrector.level is not None:
        from .explain_sources import explain_sources

        lines.extend(explain_sources(corrector))
    return "\n".join(lines)


def without_sign(dps):
    """Return a rate in which -0.0004, which is shown as zero, is zero."""
    return round(dps, 3) + 0.0


def axis_text(s, c, sensor, axis):
    """Return one line on one axis."""
    a = c[0] + axis * c[13]
    lsb = sensor.gyro_lsb_per_dps
    text = "g%s: bias %.3f dps from %s, +-%.3f dps" % (
        "xyz"[axis],
        without_sign(s[55 + axis] / 256 / lsb),
        SOURCES[s[73 + axis]],
        s[70 + axis] / 256 / lsb,
    )
    if s[73 + axis] == 0:
        text = "g%s: no bias yet, nothing still was seen" % "xyz"[axis]
    if s[a + 27] > 0:
        text += "; a rest far from it is held back (%d of %d)" % (s[a + 27], c[39])
    if s[a + 29]:
        text += "; beyond the temperatures learned so far"
    return text + "."
