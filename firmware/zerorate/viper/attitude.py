# Generated from zerorate/attitude.py by `make viper`: edit that file, not this one.
"""Orientation in integers: a unit quaternion in Q28, advanced by one increment at a time.

The quaternion turns body vectors into the level frame of the window. Q28 words advanced by Q16
steps stay within 0.03 deg of a float64 quaternion over 128 increments of up to 1 rad."""

import micropython


@micropython.viper
def rotation(s: ptr32):
    w = s[25] + 8192 >> 14
    x = s[26] + 8192 >> 14
    y = s[27] + 8192 >> 14
    z = s[28] + 8192 >> 14
    s[33] = 16384 - (y * y + z * z >> 13)
    s[34] = x * y - w * z >> 13
    s[35] = x * z + w * y >> 13
    s[36] = x * y + w * z >> 13
    s[37] = 16384 - (x * x + z * z >> 13)
    s[38] = y * z - w * x >> 13
    s[39] = x * z - w * y >> 13
    s[40] = y * z + w * x >> 13
    s[41] = 16384 - (x * x + y * y >> 13)
