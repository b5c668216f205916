"""Says in words what is being learned, or why nothing is."""

from .machine_code import chosen, unload

# layout: names that a board's own compiler reads
const = int
# layout: The corrector's state
_COUNTS = const(8)
_ELAPSED_US = const(16)
_WINDOW_N = const(17)
_STILLNESS = const(19)
_SEGMENT_WINDOWS = const(21)
_OUT_Q8 = const(63)
_QUALITY_Q8 = const(69)
_SOURCE = const(78)
# layout: An axis
_SUSPECT = const(30)
_BEYOND = const(32)
# layout: The corrector's settings
_AXES = const(0)
_WINDOW = const(3)
_SEGMENT = const(5)
_AXIS_WORDS = const(15)
_INSIST = const(41)
_EVERY = const(48)
# layout: What the guard says of a frame, in words
FAULTS = (
    "good frames",
    "repeated frames",
    "frames at the rail",
    "frames of all zeros",
    "frames of all ones",
    "jumps of the temperature",
    "frames at a time that stood still",
    "frames after missed samples",
)
# layout: What a window was
_STILL = const(1)
# layout: What a window was, in words
STILLNESS = (
    "No full window has been seen yet.",
    "The device rests.",
    "No rest to learn from: the gyroscope sees motion.",
    "No rest to learn from: gravity turns, so the device turns slowly.",
    "No rest to learn from: the accelerometer sees motion.",
    "No rest to learn from: the rate has shifted within it.",
    "No rest to learn from: the gyroscope has no noise, as if it were off.",
)
# layout: Where a bias comes from, in words
SOURCES = (
    "no bias yet",
    "any temperature",
    "the fit over temperature",
    "this temperature",
    "motion",
    "gravity",
)
# layout: end


def explain(corrector):
    """Return the text for a Corrector."""
    s = corrector.state
    c = corrector.settings
    sensor = corrector.sensor
    lines = [STILLNESS[s[_STILLNESS]]]
    if s[_STILLNESS] == _STILL:
        seconds = c[_WINDOW] / sensor.odr_hz
        still, needed = s[_SEGMENT_WINDOWS] * seconds, c[_SEGMENT] * seconds
        lines.append("Still for %.1f of the %.1f seconds needed." % (still, needed))
    for axis in range(3):
        lines.append(axis_text(s, c, sensor, axis))
    faults = ["%d %s" % (s[_COUNTS + i], FAULTS[i]) for i in range(1, 8) if s[_COUNTS + i]]
    if faults:
        lines.append("Not learned from: " + ", ".join(faults) + ".")
    if 0 < s[_ELAPSED_US] * sensor.odr_hz < s[_WINDOW_N] * 1e4:  # a hundredth of what it should be
        lines.append("dt_us is below 1 % of a period: give microseconds.")
    if not sensor.accel_lsb_per_g:
        lines.append("Without an accelerometer a slow turn cannot be told from a bias.")
    if not sensor.temp_lsb_per_degc:
        lines.append("Without a thermometer all temperatures count as one.")
    if corrector.motion is not None or corrector.gravity is not None:
        from .explain_sources import explain_sources

        lines.extend(explain_sources(corrector))
    if corrector.left_out:
        from .making import why_without

        unload("zerorate", "making")
        for part in corrector.left_out:
            lines.append("Left out: %s." % why_without(part))
    if corrector.schedule is not None:
        lines.append(saving_text(corrector.schedule, sensor))
    lines.extend(runs())
    return "\n".join(lines)


def runs():
    """Return a line for each way in which kernels run here, and why."""
    ways = {}  # type: ignore[var-annotated]
    for part in sorted(chosen):
        ways[chosen[part]] = ways.get(chosen[part], "") + ", " + part
    return ["%s run as %s." % (ways[way][2:], way) for way in sorted(ways)]


def saving_text(schedule, sensor):
    """Return a line on what saving costs."""
    if schedule.saves == 0:
        return "Nothing was saved yet; %d times it had to wait." % schedule.postponed
    samples = round(schedule.longest_us * sensor.odr_hz / 1e6)
    text = "Saved %d times, for %d ms at the longest: %d samples pass, which a FIFO keeps."
    return text % (schedule.saves, schedule.longest_us // 1000, samples)


def without_sign(dps):
    """Return a rate in which -0.0004, which is shown as zero, is zero."""
    return round(dps, 3) + 0.0


def axis_text(s, c, sensor, axis):
    """Return one line on one axis."""
    a = c[_AXES] + axis * c[_AXIS_WORDS]
    lsb = sensor.gyro_lsb_per_dps
    source = s[_SOURCE + axis]
    text = "g%s: bias %.3f dps from %s, +-%.3f dps" % (
        "xyz"[axis],
        without_sign(s[_OUT_Q8 + axis] / 256 / lsb),
        SOURCES[source],
        s[_QUALITY_Q8 + axis] / 256 / lsb,
    )
    if source == 0:
        seen = "few readings lie in its range" if c[_EVERY] else "nothing still was seen"
        text = "g%s: no bias yet, %s" % ("xyz"[axis], seen)
    if s[a + _SUSPECT] > 0:
        text += "; a rest far from it is held back (%d of %d)" % (s[a + _SUSPECT], c[_INSIST])
    if s[a + _BEYOND]:
        text += "; beyond the temperatures learned so far"
    return text + "."
