"""Five wires: each sample is read as INT announces it and corrected within a millisecond."""

from array import array

from machine import Pin
from zerorate import Corrector, Sensor
from zerorate.checked import CheckedCorrector
from zerorate_i2c.board import setup
from zerorate_i2c.data_ready import DataReady

imu = setup(scl=5, sda=4)
print("found:", imu.part)
ready = DataReady(imu, Pin(6, Pin.IN))
corrector = CheckedCorrector(Corrector(Sensor(*imu.scales)))
sample = array("i", [0] * 7)
while True:
    if not ready.wait(1000):
        print("no pulse on INT for a second: is it wired to GP6? With four wires take main.py")
    try:  # a chip that lost its power for a moment is set up again by this read
        status = imu.read(sample)
    except OSError as error:  # pulled out: what came since the last check is forgotten
        print("bus:", error)
        corrector.take_back()
        continue
    if corrector.update(sample, ready.dt_us, status):
        rates_dps = [lsb / imu.gyro_lsb_per_dps for lsb in sample[4:7]]  # their bias taken off
        print("{:+.3f} {:+.3f} {:+.3f} dps".format(*rates_dps))
