"""Four wires: the yaw in degrees of a device that lies flat, with its bias and without."""

from array import array

from zerorate import Corrector, Sensor
from zerorate.checked import CheckedCorrector
from zerorate_i2c.board import setup
from zerorate_i2c.fifo import EMPTY, Fifo

imu = setup(scl=5, sda=4)
print("found:", imu.part)
fifo = Fifo(imu)
corrector = CheckedCorrector(Corrector(Sensor(*imu.scales)))
sample = array("i", [0] * 7)
turned = [0, 0]  # LSB times microseconds, whole numbers: a sum of floats would lose small steps
count = 0
while True:
    try:
        status = fifo.read(sample)
    except OSError as error:
        print("bus:", error)
        corrector.take_back()
        imu.clock.sleep_ms(1000)
        continue
    if status == EMPTY:
        imu.clock.sleep_ms(10)
        continue
    turned[0] += sample[6] * fifo.dt_us
    corrector.update(sample, fifo.dt_us, status)
    turned[1] += sample[6] * fifo.dt_us
    count += 1
    if count >= imu.odr_hz:
        yaw_deg = [value / 1e6 / imu.gyro_lsb_per_dps for value in turned]
        print("yaw without {:+.2f}  with {:+.2f} deg".format(*yaw_deg))
        count = 0
