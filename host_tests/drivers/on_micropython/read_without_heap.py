"""Reads under micropython.heap_lock(), configuration read-backs and repeated frames included."""

from array import array

import micropython
from zerorate_fakes import FakeI2C, FakeMPU6050
from zerorate_i2c.mpu6050 import MPU6050


class RegistersOnly:
    """A bus that allocates nothing itself; every third burst is a new sample."""

    def __init__(self, registers):
        self.registers = registers
        self.bursts = 0

    def readfrom_mem_into(self, addr, memaddr, buf):
        for i in range(len(buf)):
            buf[i] = self.registers[memaddr + i]
        self.bursts += 1
        if self.bursts % 3 == 0:
            self.registers[0x48] = (self.registers[0x48] + 1) & 0x7F


def verified_of(imu, sample, reads):
    verified = 0
    for _ in range(reads):
        if imu.read(sample) == 1:
            verified += 1
    return verified


chip = FakeMPU6050([[1, -2, 3, -4, 5, -6, 7]])
imu = MPU6050(FakeI2C(chip), check_every=50)
chip.step()
imu.i2c = RegistersOnly(chip.registers)
sample = array("i", [0] * 7)
verified = 0
imu.read(sample)  # which loads what reads
micropython.heap_lock()
verified = verified_of(imu, sample, 1999)
micropython.heap_unlock()
print(verified, imu.repeats > 1000, imu.restarts)
