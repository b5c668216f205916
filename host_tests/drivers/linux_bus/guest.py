"""Runs in the emulated machine: plays a chip into the bus and records it with `zerorate record`.

A thread plays samples into i2c-stub's registers, as a chip would make them, each told from the
others by its number. Prints a line of JSON after "RESULT ". Arguments: rate in Hz, seconds.
"""

import json
import re
import struct
import sys
import time
from contextlib import redirect_stdout
from io import StringIO
from threading import Thread

from smbus2 import SMBus
from zerorate_tools.cli import main as zerorate
from zerorate_tools.recordings import read_recording

RECORDED = "/dev/shm/recorded.csv"
NAMES = ("ax", "ay", "az", "temp", "gx", "gy", "gz")
_ADDRESS, _WHO_AM_I, _ACCEL_XOUT_H = 0x68, 0x75, 0x3B


class WithoutPandas:
    """pyarrow imports it where it is, which takes a third of all time here; nothing needs it."""

    def find_spec(self, name, path=None, target=None):
        if name == "pandas":
            raise ImportError(name)


def words(number):
    """Seven words of a sample; the last is its number."""
    return (number % 7, 3, 16384, -3000 + number % 5, 40, -20 - number % 3, number)


def play(i2c, rate_hz):
    """Play for ever."""
    begun, number = time.monotonic(), 0
    while True:
        data = struct.pack(">7h", *words(number))
        i2c.write_i2c_block_data(_ADDRESS, _ACCEL_XOUT_H, list(data))
        number += 1
        time.sleep(max(0, begun + number / rate_hz - time.monotonic()))


def main(rate_hz, seconds):
    """Record while it plays; what came of it."""
    i2c = SMBus(0)
    i2c.write_byte_data(_ADDRESS, _WHO_AM_I, 0x68)
    Thread(target=play, args=(i2c, float(rate_hz)), daemon=True).start()
    words_of_it = ["--hz", rate_hz, "--seconds", seconds, "--out", RECORDED]
    with redirect_stdout(StringIO()) as said:
        code = zerorate(["record", "/dev/i2c-0", *words_of_it])
    columns = read_recording(RECORDED).columns
    rows = list(zip(*(columns[name].tolist() for name in NAMES)))
    numbers = [row[-1] for row in rows]
    found = {
        "code": code,
        "rows": len(rows),
        "false_rows": sum(row != words(row[-1]) for row in rows),
        "out_of_order": sum(b <= a for a, b in zip(numbers, numbers[1:])),
        "really_lost": numbers[-1] - numbers[0] + 1 - len(rows),
        "said_lost": int(re.search(r"(\d+) lost", said.getvalue())[1]),
    }
    print("RESULT " + json.dumps(found))


if __name__ == "__main__":
    sys.meta_path.insert(0, WithoutPandas())
    main(*sys.argv[1:])
