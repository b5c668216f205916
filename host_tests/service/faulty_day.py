"""The service through simulated hours of faults: nothing wrong learned, nothing lost but its downs.

An emulated chip on an emulated bus, its bias following the day's temperature, now at rest and now
in motion; the bus breaks, the supply dips, the chip freezes, the disk is full, and the process is
killed, in the middle of a write as well. Time is the emulation's own.
"""

import json
import math
import random
import tempfile
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from zerorate.storage.places import FileStorage
from zerorate_fakes import FakeClock, FakeI2C, FakeMPU6050, Physical
from zerorate_i2c.mpu6050 import MPU6050
from zerorate_tools.service import Service, System

ODR_HZ = 5
_SETTLE_S = 60.0
_PERIOD_US = 1_000_000 // ODR_HZ
_DOWN_US, _HURRY_US = 1_000_000, 20_000_000
#: A frozen chip, or a bus that hangs for some transfers, strikes no longer.
_STRIKES_FOR_US = 60_000_000
BUS_FAULTS = ("nack", "gone", "hang", "all_ff", "all_00")
FAULTS = (*BUS_FAULTS, "dip", "frozen", "full disk", "kill", "kill in a write")


class Killed(BaseException):
    """The process is gone, between two instructions."""


class Disk(FileStorage):
    """A file that can be full, and whose writer can be killed after some bytes."""

    full_until_us = 0
    kill_after: int | None = None

    def __init__(self, path: Path, clock: FakeClock) -> None:
        super().__init__(str(path))
        self.clock = clock
        self.refused = 0
        self._written_us = 0

    def write_pieces(self, offset: int, pieces: Iterable[Any]) -> None:
        """As FileStorage, with the faults."""
        if self.clock.now_us < self.full_until_us:
            self.refused += 1
            raise OSError(28, "No space left on device")
        if self.kill_after is not None:
            part, self.kill_after = b"".join(map(bytes, pieces))[: self.kill_after], None
            super().write_pieces(offset, (part,))
            raise Killed
        super().write_pieces(offset, pieces)
        self._written_us = self.clock.now_us

    def ago_s(self) -> float:
        """Since it was last written, by a clock that no killed process takes with it."""
        return (self.clock.now_us - self._written_us) / 1e6


@dataclass(frozen=True)
class World:
    """A device at rest and in the hand in turn, whose bias follows the day's temperature.

    at_mean_dps: its bias at the mean temperature; cycle_s, rest_s: of a turn, and of its rest;
    degc, swing_degc: the day's mean, and how far it is left; drift_dps_per_h: of axis x.
    """

    clock: FakeClock
    at_mean_dps: tuple[float, float, float] = (0.5, -0.3, 0.1)
    cycle_s: float = 600.0
    rest_s: float = 360.0
    degc: float = 22.0
    swing_degc: float = 10.0
    drift_dps_per_h: float = 0.0

    @property
    def felt(self) -> Physical:
        """What a chip on it feels."""
        return Physical(self.gyro_dps, self.accel_g, self.temp_degc)

    @property
    def seconds(self) -> float:
        """Since the beginning, whether the chip lives or not."""
        return self.clock.now_us / 1e6

    def temp_degc(self, _: float = 0) -> float:
        """A day's course."""
        return self.degc + self.swing_degc * math.sin(2 * math.pi * self.seconds / 86400)

    def bias_dps(self) -> tuple[float, float, float]:
        """Follows the temperature."""
        warm, (x, y, z) = self.temp_degc() - self.degc, self.at_mean_dps
        away = self.drift_dps_per_h * self.seconds / 3600
        return x + 0.02 * warm + away, y - 0.01 * warm, z + 0.005 * warm

    def resting_s(self) -> float:
        """Seconds since this rest began, below 0 in motion."""
        phase = self.seconds % self.cycle_s
        return phase if phase < self.rest_s else -1.0

    def _moves_s(self) -> float:
        return 0.0 if self.resting_s() >= 0 else self.seconds

    def gyro_dps(self, _: float) -> list[float]:
        """Bias, and in motion a rate that never stays."""
        t, swings = self._moves_s(), ((40, 1.3), (30, 2.1), (50, 0.7))
        return [b + dps * math.sin(w * t) for b, (dps, w) in zip(self.bias_dps(), swings)]

    def accel_g(self, _: float) -> tuple[float, float, float]:
        """Gravity, and in motion shaking."""
        t = self._moves_s()
        return 0.3 * math.sin(3.1 * t), 0.2 * math.sin(2.3 * t), 1 + 0.2 * math.sin(4.7 * t)


class Judge:
    """A sink that holds each published line against the truth.

    worst_dps, of lines published at rest from a minute on, 20 s after the last down at the
    earliest; hurried_dps, of those sooner after one. downs: stretches of over a second without a
    line, down_us together; unexplained: those in which nothing had struck.
    """

    def __init__(self, world: World) -> None:
        self.world = world
        self.worst_dps = self.hurried_dps = self.sum_square = 0.0
        self.judged = self.lines = self.downs = self.unexplained = 0
        self.down_us = self._last_us = self._up_us = 0
        self.struck_us = -_STRIKES_FOR_US
        self.awaiting = False
        self.after_kill_dps: list[float] = []

    lost = 0

    def put(self, line: bytes) -> None:
        """One published line."""
        self.lines += 1
        self._note_down()
        bias = json.loads(line)["bias_dps"]
        wrong = max(abs(b - true) for b, true in zip(bias, self.world.bias_dps()))
        if self.awaiting:
            self.awaiting = False
            self.after_kill_dps.append(wrong)
        if self.world.seconds < _SETTLE_S:
            return  # nothing can be known yet
        if self.world.clock.now_us - self._up_us < _HURRY_US:
            self.hurried_dps = max(self.hurried_dps, wrong)
        elif self.world.resting_s() > _SETTLE_S:
            self.worst_dps = max(self.worst_dps, wrong)
            self.sum_square += wrong * wrong
            self.judged += 1

    def _note_down(self) -> None:
        now_us = self.world.clock.now_us
        if now_us - self._last_us > _DOWN_US:
            self.downs += 1
            self.down_us += now_us - self._last_us - _PERIOD_US
            self.unexplained += self.struck_us + _STRIKES_FOR_US < self._last_us
            self._up_us = now_us
        self._last_us = now_us

    def close(self) -> None:
        """Nothing to close."""


def run(hours: float = 24, faults: int = 1000, seed: int = 1) -> dict[str, Any]:
    """Live through them; what came of it."""
    luck = random.Random(seed)
    clock = FakeClock()
    world = World(clock)
    chip = FakeMPU6050(world.felt)
    clock.devices.append(chip)
    bus, judge = FakeI2C(chip, clock), Judge(world)
    end_us = round(hours * 3.6e9)
    due = sorted((luck.randrange(end_us), luck.choice(FAULTS)) for _ in range(faults))
    done: Counter[str] = Counter()
    with tempfile.TemporaryDirectory() as folder:
        disk = Disk(Path(folder) / "learned.bin", clock)
        system = System(
            lambda: MPU6050(bus, odr_hz=ODR_HZ, clock=clock),
            *(disk, clock, _silent),
            stored_ago_s=disk.ago_s,
            writes_a_day=24 * 60,  # sixty times as many as a real one has, for the faults to meet
        )
        service = Service(system, [judge])
        thawed_us = 0
        while clock.now_us < end_us:
            if chip.frozen and clock.now_us >= thawed_us:
                chip.frozen = False
            try:
                while due and due[0][0] <= clock.now_us:
                    kind = due.pop(0)[1]
                    done[kind] += 1
                    judge.struck_us = clock.now_us
                    if kind == "frozen":
                        chip.frozen, thawed_us = True, clock.now_us + luck.randrange(20_000_000)
                    _strike(kind, luck, chip, bus, disk)
                service.step()
            except Killed:
                judge.struck_us = clock.now_us
                clock.advance_us(1_000_000)  # as systemd starts it again
                service = Service(system, [judge])
                judge.awaiting = True
    after = judge.after_kill_dps
    return {
        "hours": hours,
        "faults": dict(done),
        "samples": judge.lines,
        "samples_due": round(ODR_HZ * (end_us - judge.down_us) / 1e6),
        "downs": judge.downs,
        "down_s": judge.down_us / 1e6,
        "unexplained_downs": judge.unexplained,
        "refused_writes": disk.refused,
        "rms_mdps": 1e3 * math.sqrt(judge.sum_square / max(1, judge.judged)),
        "worst_mdps": 1e3 * judge.worst_dps,
        "worst_soon_after_down_mdps": 1e3 * judge.hurried_dps,
        "kills": len(after),
        "first_line_after_kill_median_mdps": 1e3 * sorted(after)[len(after) // 2] if after else 0.0,
        "first_line_after_kill_mdps": 1e3 * max(after, default=0.0),
    }


def _silent(line: str) -> None:
    """The log is not looked at."""


def _strike(kind: str, luck: random.Random, chip: FakeMPU6050, bus: FakeI2C, disk: Disk) -> None:
    if kind in BUS_FAULTS:
        bus.fault(kind, times=luck.choice((1, 3, 30)), skip=luck.randrange(4))
    elif kind == "dip":
        chip.power_up()
    elif kind == "full disk":
        disk.full_until_us = disk.clock.now_us + luck.randrange(600_000_000)
    elif kind == "kill in a write":
        disk.kill_after = luck.randrange(2000)
    elif kind == "kill":
        raise Killed


if __name__ == "__main__":
    for name, value in run().items():
        print(f"{name}: {value}")
