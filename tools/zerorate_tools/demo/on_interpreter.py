"""Runs on a MicroPython: samples.bin through emulated chip, bus, driver and firmware to out.bin."""

import sys
from array import array

from zerorate import Corrector, Sensor
from zerorate.corrector import OUT_Q8, QUALITY_Q8, SOURCE
from zerorate_fakes import FakeClock, FakeI2C, FakeMPU6050
from zerorate_i2c.mpu6050 import MPU6050, RESTARTED, SUSPECT

_ROWS = 256


class Recording:
    """Rows of dt_us ax ay az temp gx gy gz from a file; `dt_us` is that of the latest."""

    def __init__(self, file):
        self.file = file
        self.dt_us = 0

    def __iter__(self):
        words = bytearray(32 * _ROWS)
        while True:
            count = self.file.readinto(words) // 32
            if count == 0:
                return
            rows = array("i", words)
            for i in range(count):
                self.dt_us = rows[8 * i]
                yield rows[8 * i + 1 : 8 * i + 8]


def play(recording, target, part, dps, g, odr_hz):
    chip = FakeMPU6050(recording, part=part)
    imu = MPU6050(
        FakeI2C(chip), full_scale_dps=dps, full_scale_g=g, odr_hz=odr_hz, clock=FakeClock()
    )
    scales = (imu.gyro_lsb_per_dps, imu.accel_lsb_per_g)
    degrees = (imu.temp_lsb_per_degc, imu.temp_offset_degc)
    corrector = Corrector(Sensor(odr_hz, *scales, *degrees))
    sample = array("i", [0] * 7)
    row = array("i", [0] * 17)
    while chip.step():
        status = imu.read(sample)
        row[0] = -1
        if status != RESTARTED and status != SUSPECT:
            row[0] = corrector.update(sample, recording.dt_us)
        for i in range(3):
            row[1 + i] = corrector.state[OUT_Q8 + i]
            row[4 + i] = corrector.state[SOURCE + i]
            row[7 + i] = corrector.state[QUALITY_Q8 + i]
        for i in range(7):
            row[10 + i] = sample[i]
        target.write(row)
    print(f"{imu.part} at 0x{imu.address:02X}, WHO_AM_I 0x{imu.who_am_i:02X}")
    print(corrector.explain())
    return corrector.state


with open("samples.bin", "rb") as source, open("out.bin", "wb") as target:
    state = play(
        Recording(source),
        target,
        sys.argv[1],
        int(sys.argv[2]),
        int(sys.argv[3]),
        float(sys.argv[4]),
    )
with open("state.bin", "wb") as file:
    file.write(state)
