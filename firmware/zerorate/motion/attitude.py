"""Orientation in integers: a unit quaternion in Q28, advanced by one increment at a time.

The quaternion turns body vectors into the tilt frame of the window. Q28 words advanced by Q16
steps stay within 0.03 deg of a float64 quaternion over 128 increments of up to 1 rad.
"""

from ..arithmetic.atan2 import atan2_q13

# layout: names that a board's own compiler reads
const = int
ptr32 = None
# layout: The state of the source in motion
_HALF = const(18)
_REAL = const(21)
_Q = const(24)
_QX = const(25)
_QY = const(26)
_QZ = const(27)
_START = const(28)
_START_X = const(29)
_START_Y = const(30)
_START_Z = const(31)
_R = const(32)
# layout: end
_ONE_Q14 = const(0x4000)


def sines(s: ptr32):
    """Turn the half angles at _HALF, Q14 rad, into the vector and real part of a step, Q16."""
    # The real part is stored less one. The series leave 2e-4 at a half angle of 1 rad.
    square = (s[_HALF] * s[_HALF] + s[_HALF + 1] * s[_HALF + 1] + s[_HALF + 2] * s[_HALF + 2]) >> 14
    fourth = ((square >> 1) * (square >> 1)) >> 12
    factor = _ONE_Q14 - ((square * 2731) >> 14) + ((fourth * 137) >> 14)
    for i in range(3):
        s[_HALF + i] = (s[_HALF + i] * factor + 0x800) >> 12
    factor = (((fourth >> 2) * (square >> 2)) >> 10) * 23
    s[_REAL] = ((fourth * 2731) >> 14) - (square << 1) - (factor >> 12)


def turn(s: ptr32):
    """Multiply the quaternion by the step at _HALF from the right."""
    w = (s[_Q] + 0x4000) >> 15
    x = (s[_QX] + 0x4000) >> 15
    y = (s[_QY] + 0x4000) >> 15
    z = (s[_QZ] + 0x4000) >> 15
    s[_Q] = s[_Q] + ((w * s[_REAL] - x * s[_HALF] - y * s[_HALF + 1] - z * s[_HALF + 2]) >> 1)
    s[_QX] = s[_QX] + ((x * s[_REAL] + w * s[_HALF] + y * s[_HALF + 2] - z * s[_HALF + 1]) >> 1)
    s[_QY] = s[_QY] + ((y * s[_REAL] + w * s[_HALF + 1] + z * s[_HALF] - x * s[_HALF + 2]) >> 1)
    s[_QZ] = s[_QZ] + ((z * s[_REAL] + w * s[_HALF + 2] + x * s[_HALF + 1] - y * s[_HALF]) >> 1)


def normalise(s: ptr32):
    """Bring the quaternion back to length one, to first order."""
    excess = -0x10000000
    for i in range(4):
        part = (s[_Q + i] + 0x2000) >> 14
        excess += part * part
    excess = excess >> 14
    for i in range(4):
        s[_Q + i] = s[_Q + i] - ((((s[_Q + i] + 0x2000) >> 14) * excess) >> 1)


def rotation(s: ptr32):
    """Write the quaternion's rotation matrix at _R, Q14, by rows."""
    w = (s[_Q] + 0x2000) >> 14
    x = (s[_QX] + 0x2000) >> 14
    y = (s[_QY] + 0x2000) >> 14
    z = (s[_QZ] + 0x2000) >> 14
    s[_R] = _ONE_Q14 - ((y * y + z * z) >> 13)
    s[_R + 1] = (x * y - w * z) >> 13
    s[_R + 2] = (x * z + w * y) >> 13
    s[_R + 3] = (x * y + w * z) >> 13
    s[_R + 4] = _ONE_Q14 - ((x * x + z * z) >> 13)
    s[_R + 5] = (y * z - w * x) >> 13
    s[_R + 6] = (x * z - w * y) >> 13
    s[_R + 7] = (y * z + w * x) >> 13
    s[_R + 8] = _ONE_Q14 - ((x * x + y * y) >> 13)


def heading_q12(s: ptr32) -> int:
    """Return how far it has turned about the vertical since _START, Q12 rad, -2pi..2pi."""
    # The twist about the vertical of the rotation from the start, which a returning motion brings
    # back; the integral of the vertical rate it would not.
    w = (s[_Q] + 0x2000) >> 14
    x = (s[_QX] + 0x2000) >> 14
    y = (s[_QY] + 0x2000) >> 14
    z = (s[_QZ] + 0x2000) >> 14
    real = w * s[_START] + x * s[_START_X] + y * s[_START_Y] + z * s[_START_Z]
    z = z * s[_START] - w * s[_START_Z] - x * s[_START_Y] + y * s[_START_X]
    return atan2_q13(z, real)
