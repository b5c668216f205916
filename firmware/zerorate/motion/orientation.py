"""The corrected orientation, with which US 10,451,438 ends, for who asks for it."""

from math import cos, pi, sin, sqrt

TYPE_CHECKING = False
if TYPE_CHECKING:
    from ..corrector import Corrector

# layout: names that a board's own compiler reads
const = int
# layout: The corrector's state
_OUT_Q8 = const(63)
# layout: The state of the source in motion
_NODE_ELAPSED_US = const(0)
_NODE_ANGLE_Q24 = const(2)
_HEAD = const(8)
_FILLED = const(9)
_NODES_RING = const(443)
# layout: The settings of the source in motion
_NODE_US = const(0)
_NODES = const(8)
_LONGEST = const(16)
# layout: end
_LEAST_NODES = const(8)  # a second, whose mean force says where up is


def orientation(corrector: "Corrector") -> "tuple[float, float, float, float] | None":
    """Return the orientation now, a unit quaternion (w, x, y, z), or None while too little is held.

    It turns body vectors into a level frame, z up, whose heading is that of the body up to 16 s
    ago. Those seconds are integrated without the corrector's bias, and levelled by their mean
    force: forces that do not return lean it. Floats: not for every sample.
    """
    m = corrector.motion
    if m is None or m[_FILLED] < _LEAST_NODES:
        return None
    c = corrector.motion_settings
    count = min(m[_FILLED], c[_LONGEST])
    scale = pi / 180 / corrector.sensor.gyro_lsb_per_dps * 1e-6
    bias = [corrector.state[_OUT_Q8 + axis] / 256 * scale for axis in range(3)]  # rad a us
    q, up = (1.0, 0.0, 0.0, 0.0), [0.0, 0.0, 0.0]
    for n in range(count):
        at = _NODES_RING + 3 * ((m[_HEAD] - count + n) % c[_NODES])
        force = turned(q, [((m[at + i] & 0x7FFF) ^ 0x4000) - 0x4000 for i in range(3)])
        up = [up[i] + force[i] for i in range(3)]
        turn = [(m[at + i] >> 15) / 8192 - bias[i] * c[_NODE_US] for i in range(3)]
        q = multiplied(q, exponential(turn))
    rest_us = m[_NODE_ELAPSED_US]
    turn = [m[_NODE_ANGLE_Q24 + i] / (1 << 24) - bias[i] * rest_us for i in range(3)]
    return unit(multiplied(level(up), multiplied(q, exponential(turn))))


def multiplied(p, q):
    """Return the product of two quaternions."""
    return (
        p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3],
        p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
        p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1],
        p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0],
    )


def exponential(turn):
    """Return the quaternion of a rotation vector, rad."""
    angle = sqrt(turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2])
    part = sin(angle / 2) / angle if angle > 1e-6 else 0.5
    return (cos(angle / 2), turn[0] * part, turn[1] * part, turn[2] * part)


def turned(q, v):
    """Return the vector turned by the quaternion."""
    there = multiplied(q, (0.0, v[0], v[1], v[2]))
    return multiplied(there, (q[0], -q[1], -q[2], -q[3]))[1:]


def level(up):
    """Return the least turn that makes this force vertical."""
    size = sqrt(up[0] * up[0] + up[1] * up[1] + up[2] * up[2])
    if size + up[2] <= 1e-3 * size:  # upside down, any level axis will do
        return (0.0, 1.0, 0.0, 0.0)
    return unit((size + up[2], up[1], -up[0], 0.0))


def unit(q):
    """Return the quaternion at length one."""
    size = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
    return tuple([part / size for part in q])
