"""The tilt frame of a window: where its mean specific force points up."""

from ..arithmetic.fixed import clipped, root
from .attitude import heading_q12, rotation

# layout: names that a board's own compiler reads
const = int
ptr32 = None
# layout: The state of the source in motion
_STAGE = const(12)
_TAPER_SUM = const(18)
_LAST_HEADING_Q12 = const(23)
_HEADING_TURNS = const(24)
_Q = const(25)
_START = const(29)
_R = const(33)
_SUM_R = const(42)
_Y = const(51)
_TAPER = const(60)
_UP = const(63)
_SUMS = const(86)
_CENTRE = const(214)
_VERTICAL = const(242)
_TILT = const(98)
_OTHER_TILT = const(119)
_LOOK = const(203)
# layout: The sums of one component
_SUM_M = const(9)
_COMPONENT_WORDS = const(21)
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


def turn_start(s: ptr32):
    """Turn _START by the mean tilts that the traversal left, Q12 rad."""
    x = clipped(-s[_TILT], 4096) << 1
    y = clipped(-s[_OTHER_TILT], 4096) << 1
    s[_LOOK] = s[_START] - ((x * s[_START + 1] + y * s[_START + 2]) >> 14)
    s[_LOOK + 1] = s[_START + 1] + ((x * s[_START] + y * s[_START + 3]) >> 14)
    s[_LOOK + 2] = s[_START + 2] + ((y * s[_START] - x * s[_START + 3]) >> 14)
    s[_LOOK + 3] = s[_START + 3] + ((x * s[_START + 2] - y * s[_START + 1]) >> 14)
    x = 0
    for i in range(4):
        s[_LOOK + i] = s[_LOOK + i] >> 1
        x += s[_LOOK + i] * s[_LOOK + i]
    look_along(s, root(x))


def turn_centre(s: ptr32, shift: int):
    """Set _CENTRE from the means of M in the first attitude's own frame."""
    begin_attitude(s)
    rotation(s)
    for i in range(3):
        for k in range(3):
            s[_CENTRE + 3 * i + k] = -(turned_mean(s, i, k) << shift)


def find_vertical(s: ptr32):
    """Write the mean of up in the body over the window, from the first attitude's frame."""
    # Its length tells how steady up was: what turned over has no vertical of its own.
    for k in range(3):
        total = 0
        for j in range(0, 9, 3):
            total += s[_R + 6 + j // 3] * (s[_SUM_R + j + k] >> s[_STAGE])
        s[_VERTICAL + k] = total >> 14


def turned_mean(s: ptr32, i: int, k: int) -> int:
    """Return row i of the rotation times column k of the means of M."""
    j = 0
    total = 0
    while j < 3:
        mean = (s[_SUMS + _COMPONENT_WORDS * j + _SUM_M + k] << 8) // (s[_TAPER_SUM] >> 2)
        total += (s[_R + 3 * i + j] * mean) >> 2
        j += 1
    return total >> 12


def force_q12(s: ptr32, a: int, row: int) -> int:
    """Return a component of the node's specific force in the tilt frame, Q12 g."""
    total = 0
    for i in range(3):
        # the force is the low 15 bits of the word, signed
        total += s[_R + row + i] * (((s[a + i] & 0x7FFF) ^ 0x4000) - 0x4000)
    return (total + 0x2000) >> 14


def observe(s: ptr32, a: int):
    """Write both tilts and the heading of the node at word a, Q12 rad."""
    s[_Y] = -clipped(force_q12(s, a, 3), _MOST_Q12)
    s[_Y + 1] = clipped(force_q12(s, a, 0), _MOST_Q12)
    force = force_q12(s, a, 6)
    s[_UP] += (s[_TAPER] * force + 512) >> 10
    heading = heading_q12(s)
    turned = heading - s[_LAST_HEADING_Q12]
    s[_LAST_HEADING_Q12] = heading
    if turned > _WRAP_Q12:
        s[_HEADING_TURNS] -= 1
    elif turned < -_WRAP_Q12:
        s[_HEADING_TURNS] += 1
    heading += clipped(s[_HEADING_TURNS], 3) * 51472
    s[_Y + 2] = clipped(heading, _MOST_Q12)
