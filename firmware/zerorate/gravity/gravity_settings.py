"""The settings and the state of the source against gravity, made once."""

from array import array

from ..ratio import PI, Ratio

# layout: names that a board's own compiler reads
const = int
# layout: The state of the source against gravity
_GRAVITY_WORDS = const(59)
# layout: The settings of the source against gravity
_SUB_UNIT_US = const(0)
_GRAVITY_GAIN = const(1)
_GRAVITY_GAIN_SHIFT = const(2)
_GRAVITY_SHIFT = const(3)
_UNITS = const(4)
_THRESHOLD = const(5)
_DEAD_Q13 = const(6)
_COARSE_Q8 = const(7)
_FINE_Q8 = const(8)
_ONE_G_LSB = const(9)
_GRAVITY_GAP_US = const(10)
_PUSH_Q2 = const(11)
_TURN_Q12 = const(12)
_GRAVITY_SETTINGS_WORDS = const(13)
# layout: end
_SHORT_GAP_US = 20000  # a hand turns by less than a tenth of a radian meanwhile
# with what is passed over, _LATE_US at most, its product with the gain fits 31 bits
_LONG_GAP_US = 400000
_PASSED_OVER_US = 100000
_MOST_TURN = 64  # of an LSB meanwhile, Q14 rad: a rate at the rail fits 31 bits
_MOST_TURN_Q12 = 4096  # a radian a sub-unit
# Of how far the deviations go, what a motion that pushes always the same way hides from their
# signs: at most a tenth on simulated strides (docs/motion.md), of which one sigma is some half.
PUSH = 16


def gravity_settings(
    odr_hz=100.0,
    gyro_lsb_per_dps=131.0,
    accel_lsb_per_g=16384.0,
    sub_unit_s=None,
    units=8,
    threshold=None,
    dead_dps=0.03,
    coarse_dps=0.1,
    fine_dps=0.0125,
    turning_dps=1.0,
    document=False,
):
    """Return the settings as array('i').

    units: sub-units an interval; threshold: what a counter must pass; coarse_dps, fine_dps: first
    and smallest step; turning_dps: one sigma of a turn about gravity, as for a rest. document: one
    step of coarse_dps, no dead band and no threshold, and by default sub-units of 0.25 s, not 0.5:
    it gives no numbers, and with these it errs least (docs/motion.md). Raises ValueError.
    """
    if sub_unit_s is None:
        sub_unit_s = 0.25 if document and odr_hz >= 8 else 0.5
    if threshold is None:
        threshold = 0 if document else 3
    if not accel_lsb_per_g:
        raise ValueError("learning by gravity needs an accelerometer")
    rate, lsb, degree = Ratio(odr_hz), Ratio(gyro_lsb_per_dps), Ratio(*PI) / 180
    per_lsb_us = degree / lsb * (1 << 14) / 1000000
    most_us = (Ratio(_MOST_TURN) / per_lsb_us).floor() - _PASSED_OVER_US
    least_hz = max(2 / sub_unit_s, 1500000 / most_us)
    if not odr_hz >= least_hz:
        raise ValueError("learning by gravity needs %g Hz or more, not %g" % (least_hz, odr_hz))
    if not 0 <= threshold < units:
        raise ValueError("the threshold must be below the sub-units")
    a_sample = per_lsb_us / rate * 1000000
    shift = 15
    while (a_sample * (1 << shift)).floor() < 4096 and shift < 30:
        shift += 1
    gain = per_lsb_us * (1 << shift)
    gain_shift = 0
    while (gain * (1 << gain_shift)).floor() < 1024 and gain_shift < 28:
        gain_shift += 1
    q8 = lsb * 256
    sub_unit = Ratio(sub_unit_s)
    c = [0] * _GRAVITY_SETTINGS_WORDS
    c[_SUB_UNIT_US] = (sub_unit * 1000000).floor()
    c[_GRAVITY_GAIN] = (gain * (1 << gain_shift)).nearest()
    c[_GRAVITY_GAIN_SHIFT] = gain_shift
    c[_GRAVITY_SHIFT] = shift
    c[_UNITS] = units
    c[_THRESHOLD] = threshold
    c[_DEAD_Q13] = 0 if document else (sub_unit * dead_dps * degree * 8192).floor()
    c[_COARSE_Q8] = max(1, (q8 * coarse_dps).floor())
    c[_FINE_Q8] = max(1, (q8 * fine_dps).floor())
    c[_ONE_G_LSB] = Ratio(accel_lsb_per_g).floor()
    gap_us = max((Ratio(3000000) / rate).floor(), _SHORT_GAP_US)
    c[_GRAVITY_GAP_US] = min(gap_us, _LONG_GAP_US, most_us)
    push = q8 / degree / (2048 * PUSH) / sub_unit
    c[_PUSH_Q2] = 0 if document else max(1, push.floor())
    c[_TURN_Q12] = min((sub_unit * turning_dps * degree * 4096).floor(), _MOST_TURN_Q12)
    return array("i", c)


def gravity_state(settings):
    """Return the state as array('i'), nothing known yet."""
    from ..native.gravity import clear

    state = array("i", [0] * _GRAVITY_WORDS)
    clear(state, settings)
    return state


def join(corrector, document, _):
    """Let a Corrector learn against gravity. Raises ValueError where its sensor does not do."""
    sensor = corrector.sensor
    corrector.gravity_settings = gravity_settings(
        sensor.odr_hz, sensor.gyro_lsb_per_dps, sensor.accel_lsb_per_g, document=document
    )
    from ..native.gravity import update

    corrector._observe_gravity = update
    corrector.gravity = gravity_state(corrector.gravity_settings)
