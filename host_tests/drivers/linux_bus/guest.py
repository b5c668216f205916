"""Runs in the emulated machine: plays into the bus, records from it, corrects from it.

Prints one line of JSON after "RESULT ". Arguments: rate in Hz, seconds of recording.
"""

import json
import subprocess
import sys
import time
from array import array
from contextlib import contextmanager
from pathlib import Path

from zerorate.corrector import Corrector, Sensor
from zerorate_i2c.linux import LinuxI2C
from zerorate_i2c.mpu6050 import MPU6050, SUSPECT
from zerorate_tools.boards import record
from zerorate_tools.recordings import read_recording

HERE = Path(__file__).parent


@contextmanager
def playing(rate_hz):
    """A process that plays into the bus, from its first sample on."""
    command = [sys.executable, str(HERE / "player.py"), "0", str(rate_hz)]
    player = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    if player.stdout.readline() != "playing\n":
        raise SystemExit("the player does not play")
    try:
        yield
    finally:
        player.kill()
        player.wait()


def recorded(rate_hz, seconds, out):
    """Record with the public function; what it says and what its file holds."""
    result = record("/dev/i2c-0", out, seconds=seconds, odr_hz=rate_hz)
    numbers = read_recording(out).columns["gz"]
    steps = numbers[1:] - numbers[:-1]
    return {
        "samples": result.samples,
        "said_lost": result.lost,
        "rate_hz": result.rate_hz,
        "rows": len(numbers),
        "out_of_order": int((steps <= 0).sum()),
        "really_lost": int((steps - 1).sum()),
    }


def corrected(rate_hz, seconds):
    """Run driver and corrector on the live bus; the bias learned in LSB."""
    imu = MPU6050(LinuxI2C(0), odr_hz=rate_hz)
    corrector = Corrector(Sensor(odr_hz=imu.odr_hz))
    sample = array("i", [0] * 7)
    begun = before = time.monotonic()
    while before - begun < seconds:
        repeats = imu.repeats
        status = imu.read(sample)
        now = time.monotonic()
        if status < 2 and imu.repeats == repeats:
            sample[6] = 0  # the player counts there
            corrector.update(sample, int((now - before) * 1e6))
            before = now
        time.sleep(0.3 / rate_hz)
        if status == SUSPECT:
            break
    return {"bias_lsb": [corrector.bias_lsb(axis) for axis in range(3)]}


def main(rate_hz, seconds):
    """Record, then correct."""
    with playing(rate_hz):
        recording = recorded(rate_hz, seconds, "/tmp/run.csv")
    with playing(rate_hz):
        correction = corrected(rate_hz, seconds)
    print("RESULT " + json.dumps({"record": recording, "corrector": correction}))


if __name__ == "__main__":
    main(float(sys.argv[1]), float(sys.argv[2]))
