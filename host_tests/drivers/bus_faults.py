"""Every fault of a bus, injected: what was detected, what was learned.

Each fault of a real bus is put on a fake one forty times, a device at rest learning all the while.
A sample handed out as good is false when a word of it was not among the last few samples that the
chip measured, or all of it was handed out before. It was learned from when the corrector took it,
did not take it back, and said of no window of the second after it that it was no rest.
"""

import random
from array import array
from collections import deque
from dataclasses import dataclass, field
from functools import partial

from zerorate.checked import CheckedCorrector
from zerorate.corrector import Corrector, Sensor
from zerorate_fakes import FakeClock, FakeI2C, FakeMPU6050
from zerorate_fakes.pins import BusWires
from zerorate_i2c.bus_recovery import free_bus
from zerorate_i2c.fifo import EMPTY, Fifo
from zerorate_i2c.mpu6050 import MPU6050, RESTARTED, SUSPECT, VERIFIED

_EVENTS = 40
_WARM_UP = 3000
_WATCHED = 100
# Where the high byte changes with the noise, so that a torn word shows.
_BIAS_LSB = (256, -256, 0)
_RECENT = 120
_NOISE_LSB = 6.5


class World:
    """A device at rest: its chip's samples, the latest of which are remembered."""

    def __init__(self, seed, bias_lsb=_BIAS_LSB):
        self._random = random.Random(seed)
        self._bias_lsb = bias_lsb
        self.gain = lambda: 1
        self.recent = deque(maxlen=_RECENT)

    def samples(self):
        """Samples for ever; only those of gain 1 are true."""
        while True:
            gain, noise = self.gain(), self._random.gauss
            gyro = [round(gain * noise(bias, _NOISE_LSB)) for bias in self._bias_lsb]
            accel = [round(noise(mean, 40)) for mean in (300, -200, 16300)]
            sample = (*accel, round(-3000 + noise(0, 8)), *gyro)
            if gain == 1:
                self.recent.append(sample)
            yield sample


@dataclass
class Watch:
    """What came of the faults: false samples handed out, taken, and not refused afterwards."""

    false_samples: int = 0
    learned_from: int = 0
    since_verified: list[int] = field(default_factory=list)
    pending: list[int] = field(default_factory=list)

    def tick(self, now, nothing_is_learned):
        """Count the false samples that a second passed over, unless nothing was learned in it."""
        if self.pending and nothing_is_learned():
            self.pending.clear()
        while self.pending and now - self.pending[0] > _WATCHED:
            self.pending.pop(0)
            self.learned_from += 1

    def take_back(self):
        """What was not verified yet is forgotten."""
        self.pending = [at for at in self.pending if at not in self.since_verified]
        self.since_verified.clear()


class Bench:
    """Chip, bus, driver and corrector, and the application's own small loop."""

    def __init__(self, use_fifo=False):
        self.world = World(1)
        self.chip = FakeMPU6050(self.world.samples())
        self.bus = FakeI2C(self.chip)
        self.clock = FakeClock(self.chip)
        self.imu = MPU6050(self.bus, full_scale_dps=500, clock=self.clock)
        sensor = Sensor(odr_hz=100.0, gyro_lsb_per_dps=self.imu.gyro_lsb_per_dps)
        self.world.gain = lambda: 1 if self.chip.registers[0x1B] == 0x08 else 2
        self.corrector = CheckedCorrector(Corrector(sensor, motion=False, gravity=False))
        self.fifo = Fifo(self.imu) if use_fifo else None
        self.watch = Watch()
        self.signs = 0
        self.errors = 0
        self.now = 0
        self._sample = array("i", [0] * 7)
        self._handed_out = ()
        self._before_us = self.clock.ticks_us()

    def run(self, periods):
        """Let the application work for so many sample periods."""
        for _ in range(periods):
            self.now += 1
            self.clock.advance_us(10000)
            try:
                self._read()
            except OSError:
                self.errors += 1
                self._after_error()
            self.watch.tick(self.now, self._nothing_is_learned)

    def detections(self):
        """A number that grows with every sign of trouble that anything gave."""
        fifo = self.fifo.overflows + self.fifo.misalignments if self.fifo else 0
        return self.signs + self.errors + fifo + self.imu.bus_errors + self.imu.torn

    def _read(self):
        if self.fifo:
            while (status := self.fifo.read(self._sample)) != EMPTY:
                self._learn(status, self.fifo.dt_us)
            return
        status = self.imu.read(self._sample)
        now_us = self.clock.ticks_us()
        self._learn(status, now_us - self._before_us)
        self._before_us = now_us

    def _learn(self, status, dt_us):
        is_false = status < RESTARTED and self._is_false(tuple(self._sample))
        if status == VERIFIED:
            self.watch.since_verified.clear()
        elif status == RESTARTED:
            self.watch.take_back()
        self.signs += status in (RESTARTED, SUSPECT)
        taken = self.corrector.update(self._sample, dt_us, status)
        self.signs += status < RESTARTED and not taken
        if is_false:
            self.watch.false_samples += 1
            if taken:
                self.watch.pending.append(self.now)
                self.watch.since_verified.append(self.now)

    def _is_false(self, sample):
        repeated = sample == self._handed_out
        self._handed_out = sample
        recent = list(self.world.recent)[-_RECENT if self.fifo else -3 :]
        measured = [{other[word] for other in recent} for word in range(7)]
        return repeated or any(sample[word] not in measured[word] for word in range(7))

    def _after_error(self):
        self.corrector.take_back()
        self.watch.take_back()
        if self.bus.sda_held_bits:
            wires = BusWires(self.bus)
            free_bus(wires.scl, wires.sda, self.clock)

    def _nothing_is_learned(self):
        refused = self.corrector.corrector.explain().startswith("No rest to learn from")
        self.signs += refused
        return refused


def of_the_bus(kind, times):
    """A fault of so many transfers; one that ends within a burst ends behind any of its bytes."""

    def strike(bench):
        bench.bus.fault(kind, times=times, at_byte=bench.now % 14)
        bench.run(50)

    return strike


def sda_held_low(bench):
    bench.bus.hold_sda(1 + bench.now % 9)
    bench.run(50)


def frozen_data(bench):
    bench.chip.frozen = True
    bench.run(30)
    bench.chip.frozen = False
    bench.run(30)


def torn_words(bench):
    """A clone whose data registers change in the middle of a word, until a word is torn."""
    before = bench.imu.torn + bench.watch.false_samples
    while bench.imu.torn + bench.watch.false_samples == before:
        pending = [8 + 2 * (bench.now % 3)]
        bench.chip.shadowed = False
        bench.bus.between_bytes = lambda i, at=pending: i in at and bench.chip.step() and at.clear()
        bench.run(1)
        bench.bus.between_bytes = None
        bench.chip.shadowed = True
    bench.run(_WATCHED + 1)


def fifo_desync(bench):
    bench.run(3)
    bench.clock.advance_us(50000)
    for _ in range(1 + bench.now % 13):
        bench.chip.fifo.get()
    bench.run(50)


def fifo_overflow(bench):
    bench.clock.advance_us(1000000)
    bench.run(50)


def brown_out(bench, data_kept=False, awake=False):
    """The chip at its reset values: its data zero, or its last sample still there; asleep, or awake
    and measuring at once, in the range of reset."""
    data = bytes(bench.chip.registers[0x3B:0x49])
    bench.chip.power_up()
    if data_kept:
        bench.chip.registers[0x3B:0x49] = data
    if awake:
        for register, value in ((0x6B, 1), (0x19, 9), (0x1A, 3)):
            bench.chip.write(register, value)
        bench.chip.step()
    bench.run(150)


def chip_swapped(bench):
    """Another part answers, configured alike, with another bias."""
    other = FakeMPU6050(World(bench.now, (-400, 500, 90)).samples(), part="MPU-6500")
    for register in (0x6B, 0x19, 0x1A, 0x1B, 0x1C):
        other.write(register, bench.chip.registers[register])
    other.step()
    bench.bus.devices[0x68] = other
    bench.clock.devices[0] = other
    bench.run(150)
    bench.bus.devices[0x68] = bench.chip
    bench.clock.devices[0] = bench.chip
    bench.run(50)


FAULTS = {
    "nack": of_the_bus("nack", 2),
    "no-answer": of_the_bus("nack", 20),
    "gone-in-mid-burst": of_the_bus("gone", 3),
    "sda-held-low": sda_held_low,
    "all-ones": of_the_bus("all_ff", 4),
    "all-zeros": of_the_bus("all_00", 4),
    "frozen-data": frozen_data,
    "torn-words": torn_words,
    "fifo-desync": fifo_desync,
    "fifo-overflow": fifo_overflow,
    "brown-out": brown_out,
    "brown-out-data-kept": partial(brown_out, data_kept=True),
    "brown-out-awake": partial(brown_out, data_kept=True, awake=True),
    "chip-swapped": chip_swapped,
}


def run_fault(name):
    """(how often one fault was injected, how often it was detected, how often learned from)."""
    bench = Bench(use_fifo=name.startswith("fifo"))
    bench.run(_WARM_UP)
    detected = 0
    for event in range(_EVENTS):
        bench.run(7 + event % 5)
        before = bench.detections()
        FAULTS[name](bench)
        detected += bench.detections() > before
    bench.run(2 * _WATCHED)
    return _EVENTS, detected, bench.watch.learned_from
