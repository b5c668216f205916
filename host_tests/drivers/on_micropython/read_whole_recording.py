"""The driver on the fake bus, both inside this interpreter: prints what it read and counted."""

from array import array

from zerorate_fakes import FakeClock, FakeI2C, FakeMPU6050
from zerorate_i2c.mpu6050 import MPU6050

rows = 300
chip = FakeMPU6050(array("h", [(257 * i) % 30000 - 15000 for i in range(7 * rows)]))
bus = FakeI2C(chip)
imu = MPU6050(bus, clock=FakeClock())
sample = array("i", [0] * 7)
total = 0
statuses = [0, 0, 0, 0]
while chip.step():
    if chip.samples_made == 150:
        chip.power_up()
    if chip.samples_made == 50:
        bus.fault("nack", times=2)
    status = imu.read(sample)
    statuses[status] += 1
    if status != 2:
        for word in sample:
            total += word
print(statuses, total, imu.bus_errors, imu.restarts, imu.part, imu.binding)
