"""What drivers do under micropython.heap_lock(): reads, frames of the FIFO, interrupts.

Prints a line for each.
"""

from array import array

import micropython
from zerorate_fakes import FakeI2C, FakeMPU6050
from zerorate_i2c.data_ready import DataReady
from zerorate_i2c.fifo import EMPTY, Fifo
from zerorate_i2c.mpu6050 import MPU6050, VERIFIED


class QuietBus:
    """A bus that allocates nothing itself.

    Every third burst is a new sample; a frame waits at every second look at the FIFO.
    """

    def __init__(self, registers):
        self.registers = registers
        self.bursts = self.looks = 0

    def readfrom_mem_into(self, addr, memaddr, buf):
        if memaddr == 0x72:
            self.looks += 1
            buf[0] = 0
            buf[1] = 14 if self.looks & 1 else 0
            return
        start = 0x3B if memaddr == 0x74 else memaddr
        for i in range(len(buf)):
            buf[i] = self.registers[start + i]
        self.bursts += 1
        if memaddr == 0x74 or self.bursts % 3 == 0:
            self.registers[0x48] = (self.registers[0x48] + 1) & 0x7F

    def writeto_mem(self, addr, memaddr, buf):
        raise OSError(5)


class Pin:
    IRQ_RISING = 1

    def irq(self, handler, trigger):
        self.handler = handler


class Clock:
    """A pulse comes every 10 ms, however busy this machine is."""

    def __init__(self):
        self.now_us = 0

    def ticks_us(self):
        return self.now_us

    def ticks_diff(self, end, start):
        return end - start

    def sleep_ms(self, milliseconds):
        pass


def verified_of(reader, sample, reads):
    verified = 0
    for _ in range(reads):
        if reader.read(sample) == VERIFIED:
            verified += 1
    return verified


def pulse(pin, ready, count):
    taken = 0
    for i in range(count):
        clock.now_us += 10000
        pin.handler(pin)
        if i & 1 and ready.take():
            taken += 1
    return taken


def begun(with_fifo):
    chip = FakeMPU6050([[1, -2, 3, -4, 5, -6, 7]])
    imu = MPU6050(FakeI2C(chip), check_every=50)
    reader = Fifo(imu) if with_fifo else imu
    chip.step()
    imu.i2c = QuietBus(chip.registers)
    return imu, reader


sample = array("i", [0] * 7)
found = 0

imu, _ = begun(False)
imu.read(sample)  # which loads what reads
micropython.heap_lock()
found = verified_of(imu, sample, 1999)
micropython.heap_unlock()
print(found, imu.repeats > 1000, imu.restarts)

_, fifo = begun(True)
micropython.heap_lock()
found = verified_of(fifo, sample, 2000)
micropython.heap_unlock()
print(fifo.frames, found > 10, fifo.lost, EMPTY)

pin = Pin()
clock = Clock()
ready = DataReady(MPU6050(FakeI2C(FakeMPU6050()), clock=clock), pin)
micropython.heap_lock()
found = pulse(pin, ready, 2000)
micropython.heap_unlock()
print(found, ready.missed)
