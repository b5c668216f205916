"""The settings and the state of the source in motion, made once."""

from array import array

from ..ratio import PI, Ratio

# layout: names that a board's own compiler reads
const = int
# layout: The state of the source in motion
_NODES_RING = const(443)
# layout: The settings of the source in motion
_NODE_US = const(0)
_MOTION_GAIN = const(1)
_MOTION_GAIN_SHIFT = const(2)
_MOTION_SHIFT = const(3)
_FORCE_GAIN = const(4)
_VISITS = const(5)
_MOTION_GAP_US = const(6)
_LEAST_TRAFFIC = const(7)
_NODES = const(8)
_PASSES = const(9)
_LSB_A_UNIT = const(10)
_BIAS_WALK = const(12)
_START_VARIANCE = const(14)
_LONGEST = const(16)
_SHORTEST_STAGE = const(17)
_LEAST_UP = const(18)
_PATIENCE = const(19)
_MOTION_DOCUMENT = const(20)
_HEADING_SPREAD = const(21)
_SETTLED = const(22)
_TEMP_SLOPE_START = const(23)
_BEND = const(25)
_MATRIX_ERROR = const(26)
_FORCE_ERROR = const(28)
_PUSH_START = const(30)
_USUAL = const(32)
_LEAST_TILT = const(34)
_SPEED = const(35)
_MOTION_SETTINGS_WORDS = const(37)
# layout: end
_SPARE_NODES = 6
_SHORT_GAP_US = 20000  # a hand turns by less than a tenth of a radian meanwhile
_G_M_S2 = 9.80665
# mean square of a row's shape, twice
_SHAPE = 2.66


def _real(value):
    """Return mantissa and exponent of a Ratio above 0, as real.py holds them."""
    exponent = 0
    over, under = value.over, value.under
    while over < under << 27:
        over *= 2
        exponent -= 1
    while over >= under << 28:
        under *= 2
        exponent += 1
    return over // under, exponent


def _square(value):
    return value * value


def _nearest_power(value):
    """Return the power of two that a Ratio of 1 or more is nearest to, by its logarithm."""
    power = 0
    while value.over * value.over >= value.under * value.under << 2 * power + 1:
        power += 1
    return power


def motion_settings(
    odr_hz=100.0,
    gyro_lsb_per_dps=131.0,
    accel_lsb_per_g=16384.0,
    node_s=0.125,
    longest_stage=7,
    passes=3,
    document=False,
    start_dps=20.0,
    walk_dps=0.0007,
    temp_lsb_per_degc=340.0,
    slope_dps_per_degc=0.1,
    bend_degc=256.0,
    push_g=0.05,
    heading_spread=11,
    matrix_error=0.01,
    accel_bias_g=0.005,
    speed_m_s=0.3,
    usual_dps=0.5,
    least_dps=5.0,
    least_tilt_dps=0.3,
    least_up_g=0.85,
    patience=6,
    settled_dps=0.005,
):
    """Return the settings as array('i').

    odr_hz: samples a second; node_s: time of a node; longest_stage: the window is 2^that nodes;
    start_dps: one sigma of the bias before anything is known; walk_dps: its random walk a root
    second; slope_dps_per_degc: one sigma of its slope over temperature, which grows as much
    again over bend_degc; push_g: noise of the force in a row before any was seen; matrix_error:
    one sigma of an entry of scale and axes, where the rows are as noisy as that; accel_bias_g:
    so of the bias of the accelerometer; speed_m_s: so of the body along its own axes;
    heading_spread: the variance of the heading's row over that of its noise beside it;
    usual_dps: half of all parts have a smaller bias; least_dps: mean rate, of all axes
    together, below which a window is not motion, unless it mostly tilts and by least_tilt_dps
    or more. Raises ValueError.
    """
    if not accel_lsb_per_g:
        raise ValueError("learning in motion needs an accelerometer")
    if not start_dps > 0:
        raise ValueError("start_dps must be above 0, not %s" % start_dps)
    if not 4 <= longest_stage <= 8 or not 1 <= passes <= 3:
        raise ValueError("a window needs 16..256 nodes, and 1..3 passes")
    longest = 1 << longest_stage
    steps = (passes if document else 2) * longest
    rate, lsb, degree = Ratio(odr_hz), Ratio(gyro_lsb_per_dps), Ratio(*PI) / 180
    rad_per_lsb_us = degree / lsb * (1 << 24) / 1000000
    least_hz = max(1 / node_s, 0.0174533 / gyro_lsb_per_dps * 4096)
    if not odr_hz >= least_hz:
        raise ValueError("learning in motion needs %g Hz or more, not %g" % (least_hz, odr_hz))
    shift = 0
    a_sample = rad_per_lsb_us / rate * 1000000
    while (a_sample * (1 << shift)).floor() < 4096 and shift < 20:
        shift += 1
    gain = rad_per_lsb_us * (1 << shift)
    gain_shift = 0
    while (gain * (1 << gain_shift)).floor() < 1024 and gain_shift < 28:
        gain_shift += 1
    node = Ratio(node_s)
    unit = node * (1 << 24) * degree
    c = [0] * _MOTION_SETTINGS_WORDS
    c[_NODE_US] = (node * 1000000).floor()
    c[_MOTION_GAIN] = (gain * (1 << gain_shift)).nearest()
    c[_MOTION_GAIN_SHIFT] = gain_shift
    c[_MOTION_SHIFT] = shift
    c[_FORCE_GAIN] = (Ratio(1 << 25) / accel_lsb_per_g).nearest()
    c[_VISITS] = -(Ratio(-steps) / (rate * node * _SPARE_NODES)).floor()
    c[_MOTION_GAP_US] = max((Ratio(3000000) / rate).floor(), _SHORT_GAP_US)
    c[_LEAST_TRAFFIC] = (node * degree * (1 << 13) * least_dps).floor()
    c[_NODES] = longest + _SPARE_NODES
    c[_PASSES] = passes
    c[_LSB_A_UNIT], c[_LSB_A_UNIT + 1] = _real(lsb * 256 / unit)
    c[_BIAS_WALK], c[_BIAS_WALK + 1] = _real(_square(unit * walk_dps) * node)
    c[_LONGEST] = longest
    c[_SHORTEST_STAGE] = longest_stage - 3
    c[_LEAST_UP] = (Ratio(4096) * least_up_g).floor()
    c[_PATIENCE] = patience
    c[_MOTION_DOCUMENT] = 1 if document else 0
    c[_HEADING_SPREAD] = heading_spread
    # of a full window's row; the document's form knows no push
    push = Ratio(1) if document else _square(Ratio(push_g) * (1 << 24)) * longest / 2 * _SHAPE
    c[_PUSH_START], c[_PUSH_START + 1] = _real(push)
    c[_START_VARIANCE], c[_START_VARIANCE + 1] = _real(_square(unit * start_dps) / push)
    c[_MATRIX_ERROR], c[_MATRIX_ERROR + 1] = _real(_square(Ratio(matrix_error) * (1 << 24)) / push)
    c[_FORCE_ERROR], c[_FORCE_ERROR + 1] = _real(_square(Ratio(accel_bias_g) * (1 << 24)) / push)
    speed = Ratio(speed_m_s) / (node * _G_M_S2)
    c[_SPEED], c[_SPEED + 1] = _real(_square(speed * (1 << 24)) / push)
    c[_USUAL], c[_USUAL + 1] = _real(_square(unit * usual_dps))
    c[_SETTLED] = (unit * settled_dps).floor()
    least_tilt_dps = least_dps if document else least_tilt_dps
    c[_LEAST_TILT] = (node * degree * (1 << 13) * least_tilt_dps).floor()
    if temp_lsb_per_degc:
        temp = Ratio(temp_lsb_per_degc)
        c[_TEMP_SLOPE_START], c[_TEMP_SLOPE_START + 1] = _real(
            _square(unit * slope_dps_per_degc / temp)
        )
        c[_BEND] = _nearest_power(temp * bend_degc)
    return array("i", c)


def motion_state(settings):
    """Return the state as array('i'), nothing known yet."""
    from ..native.motion import clear

    state = array("i", [0] * (_NODES_RING + 3 * settings[_NODES]))
    clear(state, settings)
    return state


def join(corrector, document, start_dps):
    """Let a Corrector learn in motion as well. Raises ValueError where its sensor does not do."""
    sensor = corrector.sensor
    corrector.motion_settings = motion_settings(
        sensor.odr_hz,
        sensor.gyro_lsb_per_dps,
        sensor.accel_lsb_per_g,
        document=document,
        start_dps=start_dps,
        temp_lsb_per_degc=sensor.temp_lsb_per_degc,
    )
    from ..native.motion import update

    corrector._observe_motion = update
    corrector.motion = motion_state(corrector.motion_settings)
