# Generated from zerorate/guard.py by `make viper`: edit that file, not this one.
"""Is this frame a real reading? Facts: mpu6050 family, faults seen on real buses."""

import micropython


@micropython.viper
def all_alike(x: ptr32) -> int:
    if x[1] - x[0]:
        return 0
    if x[2] - x[0]:
        return 0
    if x[3] - x[0]:
        return 0
    if x[4] - x[0]:
        return 0
    if x[5] - x[0]:
        return 0
    if x[6] - x[0]:
        return 0
    return 1
