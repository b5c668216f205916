"""Runs in the emulated machine: plays into the bus, records from it, corrects from it.

Prints one line of JSON after "RESULT ". Arguments: rate in Hz, seconds of each, what is played.
"""

import json
import subprocess
import sys
import time
from array import array
from contextlib import contextmanager, redirect_stdout
from io import StringIO
from pathlib import Path

from zerorate import Corrector, Sensor
from zerorate_i2c.linux import LinuxI2C
from zerorate_i2c.mpu6050 import MPU6050
from zerorate_tools.cli import main as zerorate

HERE = Path(__file__).parent
RECORDED = "/dev/shm/recorded.csv"


@contextmanager
def playing(rate_hz, played):
    """A process that plays into the bus, from its first sample on."""
    command = [sys.executable, str(HERE / "player.py"), "0", str(rate_hz), played]
    player = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    if player.stdout.readline() != "playing\n":
        raise SystemExit("the player does not play")
    try:
        yield
    finally:
        player.kill()
        player.wait()


def recorded(rate_hz, seconds):
    """`zerorate record /dev/i2c-0`: what it says, and the text of its file."""
    said = StringIO()
    options = ["--hz", str(rate_hz), "--seconds", str(seconds), "--out", RECORDED]
    with redirect_stdout(said):
        exit_code = zerorate(["record", "/dev/i2c-0", *options])
    if exit_code:
        raise SystemExit(f"zerorate record ended with {exit_code}")
    return {"said": said.getvalue(), "text": Path(RECORDED).read_text()}


def corrected(rate_hz, seconds):
    """Run driver and corrector on the live bus; the bias learned in LSB."""
    imu = MPU6050(LinuxI2C(0), odr_hz=rate_hz)
    corrector = Corrector(Sensor(*imu.scales))
    sample = array("i", [0] * 7)
    begun = before = time.monotonic()
    while before - begun < seconds:
        repeats = imu.repeats
        status = imu.read(sample)
        now = time.monotonic()
        if status < 2 and imu.repeats == repeats:
            sample[6] = 0  # the recording counts there
            corrector.update(sample, int((now - before) * 1e6))
            before = now
        time.sleep(0.3 / rate_hz)
    return {"bias_lsb": [corrector.bias_lsb(axis) for axis in range(3)]}


def main(rate_hz, seconds, played):
    """Record, then correct."""
    with playing(rate_hz, played):
        recording = recorded(rate_hz, seconds)
        correction = corrected(rate_hz, seconds)
    print("RESULT " + json.dumps({"record": recording, "corrector": correction}))


if __name__ == "__main__":
    main(float(sys.argv[1]), float(sys.argv[2]), sys.argv[3])
