"""A Linux board: once a second the rates before and after; what is learned is kept in a file."""

import signal
import time
from array import array

from zerorate import Corrector, Sensor
from zerorate.checked import CheckedCorrector
from zerorate.storage.learned_store import LearnedStore
from zerorate.storage.save_schedule import SaveSchedule
from zerorate_i2c.fifo import EMPTY, Fifo
from zerorate_i2c.linux import LinuxI2C
from zerorate_i2c.mpu6050 import MPU6050
from zerorate_tools.host import store_file

signal.signal(signal.SIGINT, signal.SIG_DFL)  # Ctrl-C ends it without a traceback
imu = MPU6050(LinuxI2C(1), odr_hz=100)
learner = Corrector(Sensor(*imu.scales))
store = LearnedStore(store_file("learned.bin"), imu.binding, learner)
print(store.in_words(store.load(imu.kept_power)))
corrector = CheckedCorrector(learner)
schedule = SaveSchedule(store, 3, tolerance=round(imu.gyro_lsb_per_dps / 10))  # 0.1 dps
bias_lsb = array("i", [0] * 3)
fifo = Fifo(imu)
sample = array("i", [0] * 7)
seconds = 0
sums = [0] * 6
count = 0
while True:
    try:
        status = fifo.read(sample)
    except OSError as error:  # pulled out: what came since the last check is forgotten
        print("bus:", error)
        corrector.take_back()
        time.sleep(1)
        continue
    if status == EMPTY:
        time.sleep(0.02)
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
        seconds += 1
        if learner.learned:  # and not of this rest alone
            for axis in range(3):
                bias_lsb[axis] = round(learner.bias_lsb(axis))
        saves = schedule.saves
        if not schedule.offer(learner.state, bias_lsb, seconds) and schedule.saves > saves:
            print("learned.bin: cannot be written; is there room? Trying again later")
