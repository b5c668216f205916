"""Four wires: once a second the rates in deg/s, as they come and with their bias taken off."""

from array import array

from zerorate import Corrector, Sensor
from zerorate.checked import CheckedCorrector
from zerorate_i2c.board import setup
from zerorate_i2c.fifo import EMPTY, Fifo

imu = setup(scl=5, sda=4)  # GP5 and GP4 of a Pico; on an ESP32 scl=22, sda=21
print("found:", imu.part)
fifo = Fifo(imu)
corrector = CheckedCorrector(Corrector(Sensor(*imu.scales)))
sample = array("i", [0] * 7)  # ax ay az temp gx gy gz, raw LSB
sums = [0] * 6
count = 0
while True:
    try:
        status = fifo.read(sample)
    except OSError as error:  # pulled out: what came since the last check is forgotten
        print("bus:", error)
        corrector.take_back()
        imu.clock.sleep_ms(1000)
        continue
    if status == EMPTY:
        imu.clock.sleep_ms(10)
        continue
    raw = sample[4:7]
    if corrector.update(sample, fifo.dt_us, status):
        count += 1
        for axis in range(3):
            sums[axis] += raw[axis]
            sums[3 + axis] += sample[4 + axis]
    if count >= imu.odr_hz:
        means_dps = [value / count / imu.gyro_lsb_per_dps for value in sums]
        rates = "before {:+.3f} {:+.3f} {:+.3f}  after {:+.3f} {:+.3f} {:+.3f} dps"
        print(rates.format(*means_dps))
        sums = [0] * 6
        count = 0
