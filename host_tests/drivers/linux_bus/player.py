"""Plays a recording into i2c-stub's registers at a steady rate, as a chip would make it.

Arguments: bus number, rate in Hz, recording (CSV). Says "playing" once the first sample stands, and
plays the recording again and again until terminated.
"""

import csv
import sys
import time

from smbus2 import SMBus

_WHO_AM_I = 0x75
_ACCEL_XOUT_H = 0x3B
_ADDRESS = 0x68
_WORDS = ("ax", "ay", "az", "temp", "gx", "gy", "gz")


def frames(path):
    """Fourteen bytes a row, as the data registers hold them."""
    with open(path, newline="") as file:
        rows = [[int(row[word]) for word in _WORDS] for row in csv.DictReader(file)]
    return [[byte for word in row for byte in (word >> 8 & 0xFF, word & 0xFF)] for row in rows]


def main(bus, rate_hz, path):
    """Play for ever."""
    played = frames(path)
    begun = time.monotonic()
    number = 0
    with SMBus(bus) as i2c:
        i2c.write_byte_data(_ADDRESS, _WHO_AM_I, 0x68)
        while True:
            i2c.write_i2c_block_data(_ADDRESS, _ACCEL_XOUT_H, played[number % len(played)])
            if number == 0:
                print("playing", flush=True)
            number += 1
            time.sleep(max(0, begun + number / rate_hz - time.monotonic()))


if __name__ == "__main__":
    main(int(sys.argv[1]), float(sys.argv[2]), sys.argv[3])
