# Generated from zerorate/increments.py by `make viper`: edit that file, not this one.
"""Samples gathered into nodes of a fixed time: one rotation and one specific force each.

The ring keeps, a node and axis in one word, the increment (Q13 rad, 15 bits) above the mean force
(Q12 g, 15 bits). What rounding leaves over stays for the next node, so no angle is lost in the sum."""

import micropython


@micropython.viper
def close(s: ptr32, c: ptr32):
    s[0] = s[0] - c[0]
    a = 3 * s[8] + 241
    s_a = ptr32(int(s) + (a << 2))
    over = (s[0] << 10) // c[0]
    over = (s[57] >> 8) * over >> 2
    increments_within_value = s[2] - over + 1024 >> 11
    if increments_within_value > 16383:
        angle = 16383
    elif increments_within_value < -16383:
        angle = -16383
    else:
        angle = increments_within_value
    s[2] = s[2] - (angle << 11)
    increments_within_value = s[5] // s[1]
    if increments_within_value > 16383:
        over = 16383
    elif increments_within_value < -16383:
        over = -16383
    else:
        over = increments_within_value
    s_a[0] = (angle << 15) + (over & 32767)
    s[5] = 0
    over = (s[0] << 10) // c[0]
    over = (s[58] >> 8) * over >> 2
    increments_within_value = s[3] - over + 1024 >> 11
    if increments_within_value > 16383:
        angle = 16383
    elif increments_within_value < -16383:
        angle = -16383
    else:
        angle = increments_within_value
    s[3] = s[3] - (angle << 11)
    increments_within_value = s[6] // s[1]
    if increments_within_value > 16383:
        over = 16383
    elif increments_within_value < -16383:
        over = -16383
    else:
        over = increments_within_value
    s_a[1] = (angle << 15) + (over & 32767)
    s[6] = 0
    over = (s[0] << 10) // c[0]
    over = (s[59] >> 8) * over >> 2
    increments_within_value = s[4] - over + 1024 >> 11
    if increments_within_value > 16383:
        angle = 16383
    elif increments_within_value < -16383:
        angle = -16383
    else:
        angle = increments_within_value
    s[4] = s[4] - (angle << 11)
    increments_within_value = s[7] // s[1]
    if increments_within_value > 16383:
        over = 16383
    elif increments_within_value < -16383:
        over = -16383
    else:
        over = increments_within_value
    s_a[2] = (angle << 15) + (over & 32767)
    s[7] = 0
    s[1] = 0
    s[8] = s[8] + 1
    if s[8] >= c[8]:
        s[8] = 0
    if s[9] < c[8]:
        s[9] = s[9] + 1
    s[10] = s[10] + 1
    s[67] = s[67] + 1
    if s[64] > 0:
        s[64] = s[64] - 1
