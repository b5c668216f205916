"""Samples out of the FIFO under micropython.heap_lock(), configuration read-backs included."""

from array import array

import micropython
from zerorate_fakes import FakeI2C, FakeMPU6050
from zerorate_i2c.fifo import EMPTY, Fifo
from zerorate_i2c.mpu6050 import MPU6050, VERIFIED


class FramesOnly:
    """A bus that allocates nothing itself: one frame waits at every second look."""

    def __init__(self, registers):
        self.registers = registers
        self.looks = 0

    def readfrom_mem_into(self, addr, memaddr, buf):
        if memaddr == 0x72:
            self.looks += 1
            buf[0] = 0
            buf[1] = 14 if self.looks & 1 else 0
            return
        start = 0x3B if memaddr == 0x74 else memaddr
        for i in range(len(buf)):
            buf[i] = self.registers[start + i]
        if memaddr == 0x74:
            self.registers[0x48] = (self.registers[0x48] + 1) & 0x7F

    def writeto_mem(self, addr, memaddr, buf):
        raise OSError(5)


def read(fifo, sample, count):
    verified = 0
    for _ in range(count):
        if fifo.read(sample) == VERIFIED:
            verified += 1
    return verified


chip = FakeMPU6050([[1, -2, 3, -4, 5, -6, 7]])
imu = MPU6050(FakeI2C(chip), check_every=50)
fifo = Fifo(imu)
chip.step()
imu.i2c = FramesOnly(chip.registers)
sample = array("i", [0] * 7)
verified = 0
micropython.heap_lock()
verified = read(fifo, sample, 2000)
micropython.heap_unlock()
print(fifo.frames, verified > 10, fifo.lost, EMPTY)
