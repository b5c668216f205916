"""Turns settings in physical units into the integers that the kernels read, once."""

from array import array

from .ratio import Ratio

# layout: names that a board's own compiler reads
const = int
# layout: The corrector's state
_FIT_WEIGHTS = const(103)
# layout: The last words before the axes
_TURN_ON_OFFSET_Q8 = const(-3)
# layout: An axis
_ESTIMATORS = const(40)
# layout: An estimator
_EST_HISTOGRAM = const(5)
# layout: The corrector's settings
_AXES = const(0)
_LEAP_US = const(1)
_JUMP_LSB = const(2)
_WINDOW = const(3)
_WINDOW_SHIFT = const(4)
_SEGMENT = const(5)
_STILL_GYRO_Q8 = const(7)
_STILL_ACCEL_Q8 = const(8)
_TIP_LIMIT_Q8 = const(9)
_TILT_LIMIT_Q4 = const(10)
_TILT_NOISE_FACTOR_Q4 = const(11)
_CHANGE_LIMIT_Q8 = const(12)
_SLEW_Q8 = const(13)
_WORK_A_SAMPLE = const(14)
_AXIS_WORDS = const(15)
_FIRST_SHORT = const(16)
_ESTIMATORS_END = const(17)
_BINS = const(18)
_LOW_LSB = const(19)
_WIDTH_LSB = const(20)
_NARROWEST_LSB = const(21)
_SPLIT_RATIO = const(22)
_LITERAL = const(23)
_IGNORE_OUTSIDE = const(24)
_ENOUGH_TO_SPLIT = const(25)
_SHORT = const(26)
_ESTIMATOR_COUNT = const(27)
_ESTIMATOR_WORDS = const(28)
_STEP_LSB = const(29)
_MARGIN_LSB = const(30)
_PROMOTE = const(31)
_HALVE_AFTER = const(32)
_ENOUGH_TO_FIT = const(33)
_MOST_COUNTED = const(34)
_LOCAL = const(35)
_STABLE = const(36)
_SHARE_Q8 = const(37)
_BEYOND_Q4 = const(38)
_FLOOR_Q8 = const(39)
_GATE_Q4 = const(40)
_INSIST = const(41)
_WALK_LEAST_Q16 = const(42)
_WALK_MOST_Q16 = const(43)
_LOCAL_SHIFT = const(44)
_STALE_LSB = const(45)
_PROVISIONAL_Q8 = const(46)
_TURN_ON_VARIANCE_Q8 = const(47)
_EVERY = const(48)
_FIRST_LONG = const(49)
_MOST_SIGMA_Q6 = const(50)
_FULL_WEIGHT_Q12 = const(51)
_SLOPE_Q16 = const(52)
_NEAR = const(53)
_TURNING_LSB = const(54)
_TURN_HALVES = const(55)
_TILT_SPEED = const(56)
_ONE_G = const(57)
_QUIETEST_Q8 = const(58)
_SETTINGS_WORDS = const(59)
# layout: end
# most squared slope of gravity by noise at rest, over its variance, three axes (chi squared: 15)
_TILT_NOISE = const(5)
_QUIETEST_DPS = 0.005  # of an axis: 2 mdps a root hertz through a filter of 5 Hz
# What a user may set, in its unit. A time of readings is that many at the output data rate.
DEFAULTS = {
    "window_s": 0.25,  # a window
    "segment_s": 2.5,  # a segment: what is learned at once
    "still_dps": 0.3,  # most spread of the three rates in a still window, white noise excepted
    "still_g": 0.03,  # most spread of the accelerations in a still window
    "turn_dps": 0.03,  # a segment in which gravity shows a faster turn is not learned
    "change_dps": 0.08,  # most that the mean rate changes within a segment
    "slew_dps_per_s": 0.5,  # fastest change of the bias that is subtracted
    "range_dps": 40.0,  # reach of an empty histogram, where every reading is learned
    "narrowest_dps": 0.5,  # no bin gets narrower
    "step_degc": 1.0,  # an estimator's range of temperature
    "margin_degc": 0.15,  # how far beyond that range the estimator in use stays in use
    "promote_s": 4.0,  # readings that make an estimator worth keeping
    "halve_after_s": 3600.0,  # readings after which the counts are halved
    "fit_s": 2.0,  # readings that make an estimator a point of the line
    "counted_s": 20.0,  # more readings weigh no more in the line
    "local_degc": 3.0,  # half the width of the line's neighbourhood
    "stable_s": 2.5,  # readings with which an estimator counts as known at its temperature
    "share": 0.125,  # least share of the line's readings that such an estimator has
    "beyond_degc": 0.5,  # a bias farther outside the line's points is reported as beyond them
    "refit_degc": 0.25,  # change of temperature after which the line is fitted again
    "floor_dps": 0.002,  # flicker noise at first: by how much rests differ beyond white noise
    "gate_dps": 0.3,  # a rest this near to what was expected is plausible
    "turning_dps": 1.0,  # one sigma of what an apparent rest may turn about the vertical
    "turning_s": 100.0,  # each such time of one unbroken rest halves `turning_dps`
    "insist_s": 60.0,  # an implausible rest that lasts this long is learned
    "walk_dps": 0.0013,  # random walk of the offset at first, dps a root second
    "walk_least_dps": 0.0001,  # least random walk that is learned
    "walk_most_dps": 0.05,  # most random walk that is learned
    "turn_on_dps": 0.02,  # one sigma of the turn-on offset, until power-ons show it
    "slope_dps_per_degc": 0.02,  # how fast the bias leaves the line beyond its points, at first
    "motion_most_dps": 0.15,  # most one sigma of a bias of motion or gravity that the curve learns
    "motion_full_dps": 0.01,  # one sigma with which such a bias counts as one still reading
    "motion_start_dps": 20.0,  # one sigma of the bias in motion before anything is known
    "split_s": 0.01,  # readings in a bin that may be split, by the document
}
# By the document readings include motion, so that seconds of them tell little.
OF_THE_DOCUMENT = {
    "range_dps": 20.0,
    "promote_s": 10.0,
    "fit_s": 10.0,
    "stable_s": 10.0,
    "split_s": 1.0,
}
# What a setting may be at most, by the end of its name, and at least where that is not 0.
LEAST = {"motion_start_dps": 0.001}
MOST = {"dps": 4000.0, "g": 16.0, "degc": 200.0, "s": 86400.0, "share": 1.0}


def power_of_two(samples):
    """Return the shift of the power of two nearest to `samples`, a Ratio, 2..8."""
    shift = 2
    while shift < 8 and samples.over * 2 > (3 << shift) * samples.under:
        shift += 1
    return shift


def has_meaning(name, document, every):
    """Return whether those rules look at the setting."""
    # The document's fit is through all estimators and readings, its bins as narrow as they get.
    if name == "range_dps":
        return every
    if name == "split_s":
        return document
    return not document or name not in ("narrowest_dps", "local_degc", "counted_s")


def chosen_of(document, every, given):
    """Return all settings by name, those of `given` as they are there. Raises ValueError."""
    chosen = dict(DEFAULTS)
    if document and every:
        chosen.update(OF_THE_DOCUMENT)
    for name in given:
        if name not in chosen:
            raise ValueError("no such setting: %s" % name)
        least, most = LEAST.get(name, 0), MOST[name.split("_")[-1]]
        if not least <= given[name] <= most:
            raise ValueError("%s must be %s..%s, not %s" % (name, least, most, given[name]))
        if not has_meaning(name, document, every):
            raise ValueError("%s means nothing with these rules: leave it out" % name)
        chosen[name] = given[name]
    return chosen


def settings(sensor, bins, short, long, document, every, ignore_outside, given):
    """Return the kernels' settings, array('i'), the first walk, and all by name.

    The arguments are the Corrector's. All that is computed is of integers: floats of any width
    give the same.
    """
    limits = chosen_of(document, every, given)
    if bins is None:
        bins = 8 if every or document else 1
    if ignore_outside is None:
        ignore_outside = document and every
    c = array("i", [0] * _SETTINGS_WORDS)
    rate = Ratio(sensor.odr_hz)
    lsb = Ratio(sensor.gyro_lsb_per_dps)
    windows(c, rate, lsb, sensor, limits)
    bins_of(c, rate, lsb, bins, every, document, limits)
    c[_IGNORE_OUTSIDE] = 1 if ignore_outside else 0
    c[_EVERY] = 1 if every else 0
    degree = Ratio(sensor.temp_lsb_per_degc or 1000)
    estimators_of(c, rate, degree, short, long, document, limits)
    recent_of(c, rate, lsb, degree, limits)
    c[_AXES] = _FIT_WEIGHTS + c[_ESTIMATOR_COUNT] - _TURN_ON_OFFSET_Q8
    c[_AXIS_WORDS] = c[_ESTIMATORS_END]
    c[_WORK_A_SAMPLE] = 12 // c[_WINDOW] + 1
    walk_q16 = (lsb * limits["walk_dps"] * 256).squared(c[_WALK_MOST_Q16])
    return c, walk_q16, limits


def windows(c, rate, lsb, sensor, limits):
    """Guard, window and stillness."""
    accel = Ratio(sensor.accel_lsb_per_g)
    c[_WINDOW_SHIFT] = power_of_two(rate * limits["window_s"])
    c[_WINDOW] = 1 << c[_WINDOW_SHIFT]
    window_s = Ratio(c[_WINDOW]) / rate
    n = max(1, min(8, (Ratio(limits["segment_s"]) / window_s).nearest()))
    c[_SEGMENT] = n
    c[_LEAP_US] = min(0x1FFFFFFF, max(100000, (Ratio(10000000) / rate).floor()))
    jump = Ratio(sensor.temp_lsb_per_degc)
    c[_JUMP_LSB] = max((jump * 400 / 340).floor(), (jump / 2 / rate).floor()) or 0xFFFF
    c[_STILL_GYRO_Q8] = (lsb * limits["still_dps"] * 16).squared()
    c[_QUIETEST_Q8] = 3 * (lsb * _QUIETEST_DPS * 16).squared(1 << 26)
    c[_STILL_ACCEL_Q8] = (accel * limits["still_g"] * 16).squared()
    # LSB that gravity may move
    a_window = window_s * limits["turn_dps"] * 0.0174533 * accel
    c[_ONE_G] = max(1, min(0x7FF, (accel / 16).nearest()))
    c[_TIP_LIMIT_Q8] = (a_window * max(1, n - 1) * 16).squared()
    c[_TILT_LIMIT_Q4] = (a_window * n * (n * n - 1) / 6 * 4).squared()
    c[_TILT_NOISE_FACTOR_Q4] = _TILT_NOISE * (n * n - 1) // 3
    c[_CHANGE_LIMIT_Q8] = (lsb * limits["change_dps"] * 16).squared()
    c[_SLEW_Q8] = max(1, min(1 << 24, (lsb * limits["slew_dps_per_s"] * 256 / rate).floor()))


def bins_of(c, rate, lsb, bins, every, document, limits):
    """The histograms."""
    if bins != 1 and not 4 <= bins < 20:
        raise ValueError("bins must be 1 or 4..19, not %d" % bins)
    half = min(32000, (lsb * limits["range_dps"]).floor())
    # an edge beside a reading at the rail stays below 2^16, and 2^14 of them below 2^30
    most = 0xFFFE // (bins + 1)
    narrow = max(4, min(most, (lsb * limits["narrowest_dps"]).floor()))
    c[_BINS] = bins
    width = max(1, 2 * half // bins) if every else narrow
    c[_WIDTH_LSB] = width
    # the first reading stands in the middle of a bin, not on an edge
    c[_LOW_LSB] = -(width * bins) // 2 if every else -(bins // 2) * width - width // 2
    c[_NARROWEST_LSB] = 1 if document else narrow
    c[_SPLIT_RATIO] = 2 if document else 4
    c[_LITERAL] = 1 if document else 0
    c[_ENOUGH_TO_SPLIT] = max(1, (rate * limits["split_s"]).floor()) if document else 64


def estimators_of(c, rate, degree, short, long, document, limits):
    """The estimators and the line through them."""
    if not 1 <= short <= 6 or not 1 <= long or short + long > 18:
        raise ValueError("short must be 1..6 and short + long at most 18")
    c[_SHORT] = short
    c[_ESTIMATOR_COUNT] = 1 + short + long
    words = _EST_HISTOGRAM + 2 * c[_BINS] + 1
    c[_ESTIMATOR_WORDS] = words
    c[_FIRST_SHORT] = _ESTIMATORS + words
    c[_FIRST_LONG] = _ESTIMATORS + (1 + short) * words
    c[_ESTIMATORS_END] = _ESTIMATORS + c[_ESTIMATOR_COUNT] * words
    c[_STEP_LSB] = max(2, (degree * limits["step_degc"]).floor())
    c[_MARGIN_LSB] = max(1, (degree * limits["margin_degc"]).floor())
    c[_PROMOTE] = max(2, (rate * limits["promote_s"]).floor())
    c[_HALVE_AFTER] = max(16, min(1 << 28, (rate * limits["halve_after_s"]).floor()))
    c[_ENOUGH_TO_FIT] = max(2, (rate * limits["fit_s"]).floor())
    c[_MOST_COUNTED] = (
        0xFFFFF // max(8, short + long)
        if document
        else max(16, min(8192, (rate * limits["counted_s"]).floor()))
    )
    shift = 0
    while (degree * 16).floor() >> shift >= 16:
        shift += 1
    c[_LOCAL_SHIFT] = shift
    unit = degree * 16 / (1 << shift)
    c[_LOCAL] = 0 if document else (unit * limits["local_degc"]).squared(1 << 14)
    c[_NEAR] = c[_LOCAL] * max(1, 2048 // c[_MOST_COUNTED])
    c[_STABLE] = max(2, (rate * limits["stable_s"]).floor())
    c[_SHARE_Q8] = (Ratio(256) * limits["share"]).floor()
    c[_BEYOND_Q4] = (degree * limits["beyond_degc"] * 16).floor()
    c[_STALE_LSB] = max(1, (degree * limits["refit_degc"]).floor())


def recent_of(c, rate, lsb, degree, limits):
    """The offset that follows what the curve does not explain."""
    segment_s = Ratio(c[_SEGMENT] * c[_WINDOW]) / rate
    c[_FLOOR_Q8] = (lsb * limits["floor_dps"] * 16).squared(1 << 14)
    c[_GATE_Q4] = max(1, min(0x7FFF, (lsb * limits["gate_dps"] * 16).floor()))
    c[_INSIST] = max(3, (Ratio(limits["insist_s"]) / segment_s).nearest())
    c[_TURNING_LSB] = max(1, min(0x3FFF, (lsb * limits["turning_dps"]).floor()))
    c[_TURN_HALVES] = max(1, min(400, (Ratio(limits["turning_s"]) / segment_s).nearest()))
    c[_TILT_SPEED] = max(1, min(4095, (lsb * 57.2958 / segment_s / 16).nearest()))
    c[_WALK_MOST_Q16] = (lsb * limits["walk_most_dps"] * 256).squared(1 << 23)
    c[_WALK_LEAST_Q16] = (lsb * limits["walk_least_dps"] * 256).squared(c[_WALK_MOST_Q16])
    c[_PROVISIONAL_Q8] = max(1, min(1 << 28, (lsb * limits["turn_dps"] * 256).floor()))
    c[_TURN_ON_VARIANCE_Q8] = (lsb * limits["turn_on_dps"] * 16).squared(1 << 27)
    slope = lsb * limits["slope_dps_per_degc"] / degree
    c[_SLOPE_Q16] = max(1, min(4095, (slope * 65536).floor()))
    c[_MOST_SIGMA_Q6] = max(1, min(8191, (lsb * limits["motion_most_dps"] * 64).floor()))
    full = (lsb * limits["motion_full_dps"] * 64).squared()
    c[_FULL_WEIGHT_Q12] = min(1 << 29, 256 * full)
