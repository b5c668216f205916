"""Interrupts handled and taken under micropython.heap_lock(); prints what was taken and missed."""

import micropython
from zerorate_fakes import FakeI2C, FakeMPU6050
from zerorate_i2c.data_ready import DataReady
from zerorate_i2c.mpu6050 import MPU6050


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


def pulse(pin, ready, count):
    taken = 0
    for i in range(count):
        clock.now_us += 10000
        pin.handler(pin)
        if i & 1 and ready.take():
            taken += 1
    return taken


pin = Pin()
clock = Clock()
ready = DataReady(MPU6050(FakeI2C(FakeMPU6050()), clock=clock), pin)
taken = 0
micropython.heap_lock()
taken = pulse(pin, ready, 2000)
micropython.heap_unlock()
print(taken, ready.missed)
