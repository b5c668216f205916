# Generated from zerorate/atan2.py by `make viper`: edit that file, not this one.
"""The angle of a vector, in integers."""

import micropython


@micropython.viper
def atan2_q13(x: int, y: int) -> int:
    a = x if x >= 0 else 0 - x
    b = y if y >= 0 else 0 - y
    while a >= 32768 or b >= 32768:
        a = a >> 1
        b = b >> 1
    if a >= b:
        if not a:
            return 0
        arc_q13_z = (b << 15) // a
        arc_q13_square = arc_q13_z * arc_q13_z >> 15
        arc_q13_sum_q15 = 683
        arc_q13_sum_q15 = (683 * arc_q13_square >> 15) - 2790
        arc_q13_sum_q15 = (arc_q13_sum_q15 * arc_q13_square >> 15) + 5903
        arc_q13_sum_q15 = (arc_q13_sum_q15 * arc_q13_square >> 15) - 10823
        arc_q13_sum_q15 = (arc_q13_sum_q15 * arc_q13_square >> 15) + 32764
        angle = (arc_q13_sum_q15 * arc_q13_z >> 15) + 2 >> 2
    else:
        arc_q13_z = (a << 15) // b
        arc_q13_square = arc_q13_z * arc_q13_z >> 15
        arc_q13_sum_q15 = 683
        arc_q13_sum_q15 = (683 * arc_q13_square >> 15) - 2790
        arc_q13_sum_q15 = (arc_q13_sum_q15 * arc_q13_square >> 15) + 5903
        arc_q13_sum_q15 = (arc_q13_sum_q15 * arc_q13_square >> 15) - 10823
        arc_q13_sum_q15 = (arc_q13_sum_q15 * arc_q13_square >> 15) + 32764
        arc_q13_result = (arc_q13_sum_q15 * arc_q13_z >> 15) + 2 >> 2
        angle = 12868 - arc_q13_result
    if x >> 30:
        angle = 25736 - angle
    if y >> 30:
        angle = -angle
    return angle
