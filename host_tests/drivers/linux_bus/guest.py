"""Runs in the emulated machine: plays into the bus, records from it, corrects from it.

Prints one line of JSON after "RESULT ". Arguments: rate in Hz, seconds of recording.
"""

import json
import random
import re
import subprocess
import sys
import time
from array import array
from contextlib import contextmanager, redirect_stdout
from io import StringIO
from pathlib import Path

import numpy as np
from zerorate import Corrector, Sensor
from zerorate_i2c.linux import LinuxI2C
from zerorate_i2c.mpu6050 import MPU6050
from zerorate_tools.cli import main as zerorate
from zerorate_tools.recordings import (
    Scales,
    read_recording,
    recording_from_columns,
    write_recording,
)

HERE = Path(__file__).parent
PLAYED = "/dev/shm/played.csv"
RECORDED = "/dev/shm/recorded.csv"
BIAS_LSB = (44, -21, 0)


def write_played(rate_hz):
    """A recording of a device at rest; gz counts its samples, so that losses show."""
    noise = random.Random(1).gauss
    rows = []
    for number in range(30000):
        accel = [round(noise(mean, 40)) for mean in (0, 0, 16384)]
        gyro = [round(noise(bias, 6.5)) for bias in BIAS_LSB[:2]]
        rows.append([round(number * 1e6 / rate_hz), *accel, -3000 + number // 500, *gyro, number])
    names = ("t_us", "ax", "ay", "az", "temp", "gx", "gy", "gz")
    columns = dict(zip(names, np.array(rows).T, strict=True))
    scales = Scales("MPU-6050", rate_hz, 131.0, 16384.0, 340.0, 36.53)
    write_recording(recording_from_columns(columns, scales), PLAYED)


@contextmanager
def playing(rate_hz):
    """A process that plays into the bus, from its first sample on."""
    command = [sys.executable, str(HERE / "player.py"), "0", str(rate_hz), PLAYED]
    player = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    if player.stdout.readline() != "playing\n":
        raise SystemExit("the player does not play")
    try:
        yield
    finally:
        player.kill()
        player.wait()


def recorded(rate_hz, seconds):
    """`zerorate record /dev/i2c-0`: what it says, and how its file differs from what was played."""
    said = StringIO()
    options = ["--hz", str(rate_hz), "--seconds", str(seconds), "--out", RECORDED]
    with redirect_stdout(said):
        exit_code = zerorate(["record", "/dev/i2c-0", *options])
    if exit_code:
        raise SystemExit(f"zerorate record ended with {exit_code}")
    samples, rate, lost = re.search(
        r"(\d+) samples in .*\(([\d.]+) Hz\), (\d+) lost", said.getvalue()
    ).groups()
    found, played = read_recording(RECORDED).columns, read_recording(PLAYED).columns
    numbers = found["gz"]
    steps = np.diff(numbers)
    names = ("ax", "ay", "az", "temp", "gx", "gy")
    false = sum((found[name] != played[name][numbers]) for name in names) > 0
    return {
        "samples": int(samples),
        "said_lost": int(lost),
        "rate_hz": float(rate),
        "rows": len(numbers),
        "false_rows": int(false.sum()),
        "out_of_order": int((steps <= 0).sum()),
        "really_lost": int((steps - 1).sum()),
    }


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


def main(rate_hz, seconds):
    """Record, then correct."""
    write_played(rate_hz)
    with playing(rate_hz):
        recording = recorded(rate_hz, seconds)
    with playing(rate_hz):
        correction = corrected(rate_hz, seconds)
    print("RESULT " + json.dumps({"record": recording, "corrector": correction}))


if __name__ == "__main__":
    main(float(sys.argv[1]), float(sys.argv[2]))
