"""Plays samples into i2c-stub's registers at a steady rate, as a chip would make them.

Arguments: bus number, rate in Hz, seconds. gz counts the samples, so that a reader's losses show.
"""

import sys
import time

from smbus2 import SMBus

_WHO_AM_I = 0x75
_ACCEL_XOUT_H = 0x3B
_ADDRESS = 0x68


def words(number):
    """ax ay az temp gx gy gz of a chip at rest, with a little noise from the number."""
    noise = number * 1103515245 + 12345 >> 8
    return [
        noise % 11 - 5,
        noise // 11 % 13 - 6,
        16384 + noise % 7,
        -3000 + number // 500,
        40 + noise % 9,
        -25 + noise // 9 % 9,
        number % 30000,
    ]


def main(bus, rate_hz, seconds):
    """Play; prints how many samples were played and how late the latest was."""
    begun = time.monotonic()
    latest = number = 0
    with SMBus(bus) as i2c:
        i2c.write_byte_data(_ADDRESS, _WHO_AM_I, 0x68)
        while number < rate_hz * seconds:
            data = [byte for word in words(number) for byte in (word >> 8 & 0xFF, word & 0xFF)]
            i2c.write_i2c_block_data(_ADDRESS, _ACCEL_XOUT_H, data)
            number += 1
            due = begun + number / rate_hz - time.monotonic()
            latest = max(latest, -due)
            time.sleep(max(0, due))
    print(f"played {number} samples, latest {1000 * latest:.1f} ms")


if __name__ == "__main__":
    main(int(sys.argv[1]), float(sys.argv[2]), float(sys.argv[3]))
