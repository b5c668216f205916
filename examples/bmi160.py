"""Another chip, raw words: a BMI160 by PyPI's BMI160-i2c, its rates without their bias in deg/s."""

import time
from array import array

from BMI160_i2c import Driver
from zerorate import Corrector, Sensor

GYRO_LSB_PER_DPS = 131.2  # of its data sheet, at +-250 dps
chip = Driver(0x69)
chip.setFullScaleGyroRange(3, 250)
# Hz; LSB a dps, a g and a degC; degC at a raw 0
corrector = Corrector(Sensor(100.0, GYRO_LSB_PER_DPS, 16384.0, 512.0, 23.0))
sample = array("i", [0] * 7)  # ax ay az temp gx gy gz, raw LSB
before_us = time.monotonic_ns() // 1000
while True:
    time.sleep(0.01)
    gx, gy, gz, ax, ay, az = chip.getMotion6()
    temp = round((chip.getTemperature() - 23.0) * 512.0)
    for place, word in enumerate((ax, ay, az, temp, gx, gy, gz)):
        sample[place] = word
    now_us = time.monotonic_ns() // 1000
    corrector.update(sample, now_us - before_us)
    before_us = now_us
    print([sample[4 + axis] / GYRO_LSB_PER_DPS for axis in range(3)])
