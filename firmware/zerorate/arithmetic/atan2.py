"""The angle of a vector, in integers."""

# layout: names that a board's own compiler reads
const = int
# layout: end
_HALF_PI_Q13 = const(12868)
_PI_Q13 = const(25736)


def arc_q13(z: int) -> int:
    """Return atan(z) in Q13 rad for z in Q15, 0..1; to within a unit (1.2e-4 rad)."""
    # Odd minimax polynomial of degree 9 (Abramowitz and Stegun 4.4.49, error below 1e-5).
    tangent = z if z < 0x7FFF else 0x7FFF
    square = (tangent * tangent) >> 15
    sum_q15 = 683
    sum_q15 = ((sum_q15 * square) >> 15) - 2790
    sum_q15 = ((sum_q15 * square) >> 15) + 5903
    sum_q15 = ((sum_q15 * square) >> 15) - 10823
    sum_q15 = ((sum_q15 * square) >> 15) + 32764
    return ((sum_q15 * tangent >> 15) + 2) >> 2


def atan2_q13(y: int, x: int) -> int:
    """Return the angle of (x, y) in Q13 rad, -pi..pi; |x|, |y| < 2^30. 0 where both are 0."""
    a = x if x >= 0 else 0 - x
    b = y if y >= 0 else 0 - y
    while a >= 0x8000 or b >= 0x8000:
        a = a >> 1
        b = b >> 1
    if a >= b:
        if a == 0:
            return 0
        angle = arc_q13((b << 15) // a)
    else:
        angle = _HALF_PI_Q13 - arc_q13((a << 15) // b)
    if x < 0:
        angle = _PI_Q13 - angle
    if y < 0:
        angle = -angle
    return angle
