"""Every fault of a bus and every cut of a write, injected: what was detected, what was learned.

Each fault of a real bus is put on a fake one forty times, a device at rest learning all the while.
A sample handed out as good is false when a word of it was not among the last few samples that the
chip measured, or all of it was handed out before. It was learned from when the corrector took it,
did not take it back, and said of no window of the second after it that it was no rest.
"""

from __future__ import annotations

import random
from array import array
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any

from zerorate.checked import CheckedCorrector
from zerorate.corrector import Corrector, Sensor
from zerorate.storage.codes import LOADED
from zerorate.storage.store import Store
from zerorate_fakes import FakeClock, FakeI2C, FakeMPU6050
from zerorate_fakes.memory import FakeMemory, PowerCut
from zerorate_fakes.pins import BusWires
from zerorate_i2c.bus_recovery import free_bus
from zerorate_i2c.fifo import EMPTY, Fifo
from zerorate_i2c.mpu6050 import MPU6050, RESTARTED, SUSPECT, VERIFIED

from .tables import table

_EVENTS = 40
_WARM_UP = 3000
_WATCHED = 100
# Where the high byte changes with the noise, so that a torn word shows.
_BIAS_LSB = (256, -256, 0)
_RECENT = 120
_NOISE_LSB = 6.5


class World:
    """A device at rest: its chip's samples, the latest of which are remembered."""

    def __init__(self, seed: int, bias_lsb: Sequence[int] = _BIAS_LSB) -> None:
        self._random = random.Random(seed)
        self._bias_lsb = bias_lsb
        self.gain: Callable[[], int] = lambda: 1
        self.recent: deque[tuple[int, ...]] = deque(maxlen=_RECENT)

    def samples(self) -> Iterator[tuple[int, ...]]:
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

    def tick(self, now: int, nothing_is_learned: Callable[[], bool]) -> None:
        """Count the false samples that a second passed over, unless nothing was learned in it."""
        if self.pending and nothing_is_learned():
            self.pending.clear()
        while self.pending and now - self.pending[0] > _WATCHED:
            self.pending.pop(0)
            self.learned_from += 1

    def take_back(self) -> None:
        """What was not verified yet is forgotten."""
        self.pending = [at for at in self.pending if at not in self.since_verified]
        self.since_verified.clear()


class Bench:
    """Chip, bus, driver and corrector, and the application's own small loop."""

    def __init__(self, use_fifo: bool = False) -> None:
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
        self._handed_out: tuple[int, ...] = ()
        self._before_us = self.clock.ticks_us()

    def run(self, periods: int) -> None:
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

    def detections(self) -> int:
        """A number that grows with every sign of trouble that anything gave."""
        fifo = self.fifo.overflows + self.fifo.misalignments if self.fifo else 0
        return self.signs + self.errors + fifo + self.imu.bus_errors + self.imu.torn

    def _read(self) -> None:
        if self.fifo:
            while (status := self.fifo.read(self._sample)) != EMPTY:
                self._learn(status, self.fifo.dt_us)
            return
        status = self.imu.read(self._sample)
        now_us = self.clock.ticks_us()
        self._learn(status, now_us - self._before_us)
        self._before_us = now_us

    def _learn(self, status: int, dt_us: int) -> None:
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

    def _is_false(self, sample: tuple[int, ...]) -> bool:
        repeated = sample == self._handed_out
        self._handed_out = sample
        recent = list(self.world.recent)[-_RECENT if self.fifo else -3 :]
        measured = [{other[word] for other in recent} for word in range(7)]
        return repeated or any(sample[word] not in measured[word] for word in range(7))

    def _after_error(self) -> None:
        self.corrector.take_back()
        self.watch.take_back()
        if self.bus.sda_held_bits:
            wires = BusWires(self.bus)
            free_bus(wires.scl, wires.sda, self.clock)

    def _nothing_is_learned(self) -> bool:
        refused = self.corrector.corrector.explain().startswith("No rest to learn from")
        self.signs += refused
        return refused


def of_the_bus(kind: str, times: int) -> Callable[[Bench], None]:
    """A fault of so many transfers; one that ends within a burst ends behind any of its bytes."""

    def strike(bench: Bench) -> None:
        bench.bus.fault(kind, times=times, at_byte=bench.now % 14)
        bench.run(50)

    return strike


def sda_held_low(bench: Bench) -> None:
    bench.bus.hold_sda(1 + bench.now % 9)
    bench.run(50)


def frozen_data(bench: Bench) -> None:
    bench.chip.frozen = True
    bench.run(30)
    bench.chip.frozen = False
    bench.run(30)


def torn_words(bench: Bench) -> None:
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


def fifo_desync(bench: Bench) -> None:
    bench.run(3)
    bench.clock.advance_us(50000)
    for _ in range(1 + bench.now % 13):
        bench.chip.fifo.get()
    bench.run(50)


def fifo_overflow(bench: Bench) -> None:
    bench.clock.advance_us(1000000)
    bench.run(50)


def brown_out(bench: Bench, data_kept: bool = False, awake: bool = False) -> None:
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


def chip_swapped(bench: Bench) -> None:
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


FAULTS: dict[str, Callable[[Bench], None]] = {
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


def run_fault(name: str) -> dict[str, int]:
    """Inject one fault again and again: how often it was detected, how often learned from."""
    bench = Bench(use_fifo=name.startswith("fifo"))
    bench.run(_WARM_UP)
    detected = 0
    for event in range(_EVENTS):
        bench.run(7 + event % 5)
        before = bench.detections()
        FAULTS[name](bench)
        detected += bench.detections() > before
    bench.run(2 * _WATCHED)
    watch = bench.watch
    return {
        "injected": _EVENTS,
        "detected": detected,
        "learned_from": watch.learned_from,
        "false_samples": watch.false_samples,
    }


_BINDING = bytes([0x68, 0, 0, 3])
_ROUNDS = 3


def run() -> dict[str, Any]:
    """Inject everything and return both tables.

    faults: name -> injected, detected, learned_from (false samples that what was learned holds),
    false_samples (those that the driver handed out as good). store: cuts, flips, wrong_loads,
    exceptions.
    """
    return {"faults": {name: run_fault(name) for name in FAULTS}, "store": run_store()}


def passed(found: dict[str, Any]) -> bool:
    """Every fault detected and nothing learned from any, no wrong load and no exception."""
    store = found["store"]
    return (
        all(
            row["injected"] > 0 and row["detected"] == row["injected"] and row["learned_from"] == 0
            for row in found["faults"].values()
        )
        and store["cuts"] > 0
        and store["flips"] > 0
        and store["wrong_loads"] == store["exceptions"] == 0
    )


def in_markdown(found: dict[str, Any]) -> str:
    rows = [[name, *row.values()] for name, row in found["faults"].items()]
    store = found["store"]
    counts = [store[name] for name in ("cuts", "flips", "wrong_loads", "exceptions")]
    faults = table(["fault", "injected", "detected", "learned from", "false handed out"], rows)
    head = ["store", "cuts", "flips", "wrong loads", "exceptions"]
    return faults + "\n" + table(head, [[f"{store['bytes']} bytes a slot", *counts]])


def run_store() -> dict[str, int]:
    """Counts of cuts, flips, wrong loads and exceptions, over the state as a board stores it."""
    store = StoreUnderFaults(len(Corrector().state))
    for round_ in range(_ROUNDS):
        store.cut_every_byte(round_)
    store.flip_every_bit()
    return store.counts


class StoreUnderFaults:
    """A memory with a store of some words, and the counts of what became of it."""

    def __init__(self, words: int) -> None:
        self._words = words
        slot_bytes = Store(FakeMemory(0), _BINDING, 4 * words).slot_bytes
        self._slot_bytes = slot_bytes
        self._memory = FakeMemory(2 * slot_bytes)
        names = ("cuts", "flips", "wrong_loads", "exceptions")
        self.counts = {**dict.fromkeys(names, 0), "bytes": slot_bytes}
        self._save(self._payload(0))

    def cut_every_byte(self, round_: int) -> None:
        """Cut the next save at each of its bytes; then let it through."""
        before, after = self._payload(round_), self._payload(round_ + 1)
        image = bytes(self._memory.bytes)
        for cut in range(self._slot_bytes):
            self._memory.bytes[:] = image
            self._memory.cut_after = cut
            try:
                self._save(after)
            except PowerCut:
                self.counts["cuts"] += 1
            self._memory.cut_after = None
            self._judge([before])
        self._memory.bytes[:] = image
        self._save(after)

    def flip_every_bit(self) -> None:
        """Turn each bit of both slots: the other slot is loaded, or the newest when it is whole."""
        allowed = [self._payload(_ROUNDS), self._payload(_ROUNDS - 1)]
        newest_slot = _ROUNDS % 2
        for bit in range(8 * 2 * self._slot_bytes):
            self._memory.flip(bit)
            in_newest = bit // (8 * self._slot_bytes) == newest_slot
            self.counts["flips"] += 1
            self._judge([allowed[1 if in_newest else 0]])
            self._memory.flip(bit)

    def _store(self) -> Store:
        return Store(self._memory, _BINDING, 4 * self._words)

    def _save(self, payload: array[int]) -> None:
        self._store().save(payload)

    def _judge(self, allowed: list[array[int]]) -> None:
        payload = array("i", bytes(4 * self._words))
        try:
            reason = self._store().load(payload)
        except Exception:
            self.counts["exceptions"] += 1
            return
        if reason != LOADED or payload not in allowed:
            self.counts["wrong_loads"] += 1

    def _payload(self, round_: int) -> array[int]:
        return array(
            "i", [(word * 40503 + round_ * 977) % 100000 - 50000 for word in range(self._words)]
        )
