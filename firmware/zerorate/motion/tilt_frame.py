"""The tilt frame of a window: where its mean specific force points up."""

from ..arithmetic.fixed import clipped, root
from .attitude import heading_q12

# layout: names that a board's own compiler reads
const = int
ptr32 = None
# layout: The state of the source in motion
_LAST_HEADING_Q12 = const(22)
_HEADING_TURNS = const(23)
_Q = const(24)
_START = const(28)
_R = const(32)
_Y = const(51)
_TILT = const(57)
_OTHER_TILT = const(58)
_UP = const(59)
_LOOK = const(416)
# layout: end
_WRAP_Q12 = const(25736)
_MOST_Q12 = const(0x7FFF)


def begin_attitude(s: ptr32):
    """Set the quaternion to the window's first attitude."""
    for i in range(4):
        s[_Q + i] = s[_START + i] << 14
    s[_LAST_HEADING_Q12] = 0
    s[_HEADING_TURNS] = 0


def look_along(s: ptr32, scale: int):
    """Set _START to the quaternion at _LOOK divided by its length, which is `scale`, as Q14."""
    for i in range(4):
        s[_START + i] = (s[_LOOK + i] << 14) // scale


def find_up(s: ptr32):
    """Set _START to the least turn that makes the mean force vertical, in either sense."""
    x = s[_OTHER_TILT]
    y = -s[_TILT]
    z = s[_UP]
    while x > 8191 or x < -8191 or y > 8191 or y < -8191 or z > 8191 or z < -8191:
        x = x >> 1
        y = y >> 1
        z = z >> 1
    scale = root(x * x + y * y + z * z)
    over = z < 0
    if over:
        y = -y
        z = -z
    s[_LOOK] = scale + z
    s[_LOOK + 1] = y
    s[_LOOK + 2] = 0 - x
    s[_LOOK + 3] = 0
    scale = root(s[_LOOK] * s[_LOOK] + x * x + y * y)
    if over:
        s[_LOOK + 3] = x
        s[_LOOK + 2] = 0
        s[_LOOK + 1] = s[_LOOK]
        s[_LOOK] = 0 - y
    if scale == 0:
        s[_LOOK] = 1
        scale = 1
    look_along(s, scale)


def level(s: ptr32, a: int):
    """Add the node's force to its sums in the frame of the window's first node."""
    s[_TILT] -= force_q12(s, a, 3)
    s[_OTHER_TILT] += force_q12(s, a, 0)
    s[_UP] += force_q12(s, a, 6)


def force_q12(s: ptr32, a: int, row: int) -> int:
    """Return a component of the node's specific force in the tilt frame, Q12 g."""
    total = 0
    for i in range(3):
        # the force is the low 15 bits of the word, signed
        total += s[_R + row + i] * (((s[a + i] & 0x7FFF) ^ 0x4000) - 0x4000)
    return (total + 0x1000) >> 13


def observe(s: ptr32, a: int):
    """Write both tilts and the heading of the node at word a, Q12 rad."""
    s[_Y] = -clipped(force_q12(s, a, 3), _MOST_Q12)
    s[_Y + 1] = clipped(force_q12(s, a, 0), _MOST_Q12)
    s[_UP] += force_q12(s, a, 6)
    heading = heading_q12(s)
    turned = heading - s[_LAST_HEADING_Q12]
    s[_LAST_HEADING_Q12] = heading
    if turned > _WRAP_Q12:
        s[_HEADING_TURNS] -= 1
    elif turned < -_WRAP_Q12:
        s[_HEADING_TURNS] += 1
    heading += clipped(s[_HEADING_TURNS], 3) * 51472
    s[_Y + 2] = clipped(heading, _MOST_Q12)
