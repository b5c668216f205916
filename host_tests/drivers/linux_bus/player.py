"""Plays samples into i2c-stub's registers at a steady rate, as a chip would make them.

Arguments: bus number, rate in Hz. Says "playing" once the first sample stands, and plays until
terminated. gz counts the samples, so that a reader's losses show.
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


def main(bus, rate_hz):
    """Play for ever."""
    begun = time.monotonic()
    number = 0
    with SMBus(bus) as i2c:
        i2c.write_byte_data(_ADDRESS, _WHO_AM_I, 0x68)
        while True:
            data = [byte for word in words(number) for byte in (word >> 8 & 0xFF, word & 0xFF)]
            i2c.write_i2c_block_data(_ADDRESS, _ACCEL_XOUT_H, data)
            if number == 0:
                print("playing", flush=True)
            number += 1
            time.sleep(max(0, begun + number / rate_hz - time.monotonic()))


if __name__ == "__main__":
    main(int(sys.argv[1]), float(sys.argv[2]))
