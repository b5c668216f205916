"""Another chip, floats: an LSM6DSO by Adafruit's driver, its rates without their bias in rad/s."""

import time

import board
from adafruit_lsm6ds.lsm6dsox import LSM6DSOX
from zerorate_tools.host import FloatCorrector

chip = LSM6DSOX(board.I2C())
corrector = FloatCorrector(100.0, full_scale_dps=250.0, rate="rad/s", accel="m/s2")
print(corrector.said)
before = time.monotonic()
while True:
    time.sleep(0.01)
    rate, acceleration = chip.gyro, chip.acceleration
    now = time.monotonic()
    print(corrector.update(rate, acceleration, dt_s=now - before))
    before = now
