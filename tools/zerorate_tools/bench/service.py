"""The service through simulated hours of faults: nothing wrong learned, nothing lost but its downs.

An emulated chip on an emulated bus, its bias following the day's temperature, now at rest and now
in motion; the bus breaks, the supply dips, the chip freezes, the disk is full, and the process is
killed, in the middle of a write as well. Time is the emulation's own.
"""

from __future__ import annotations

import json
import math
import random
import tempfile
from collections import Counter
from pathlib import Path
from typing import Any

from zerorate.storage import FileStorage
from zerorate_fakes import FakeClock, FakeI2C, FakeMPU6050, Physical
from zerorate_i2c.mpu6050 import MPU6050

from ..service import Service, System

ODR_HZ = 5
_CYCLE_S, _REST_S = 600.0, 360.0
_SETTLE_S = 60.0
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

    def writeblock(self, offset: int, buf: Any) -> None:
        """As FileStorage, with the faults."""
        if self.clock.now_us < self.full_until_us:
            self.refused += 1
            raise OSError(28, "No space left on device")
        if self.kill_after is not None:
            part, self.kill_after = bytes(buf)[: self.kill_after], None
            super().writeblock(offset, part)
            raise Killed
        super().writeblock(offset, buf)


class World:
    """The device's true bias and motion at any time."""

    def __init__(self, clock: FakeClock) -> None:
        self.clock = clock

    @property
    def seconds(self) -> float:
        """Since the beginning, whether the chip lives or not."""
        return self.clock.now_us / 1e6

    def temp_degc(self, _: float = 0) -> float:
        """A day's course."""
        return 22 + 10 * math.sin(2 * math.pi * self.seconds / 86400)

    def bias_dps(self) -> tuple[float, float, float]:
        """Follows the temperature."""
        warm = self.temp_degc() - 22
        return 0.5 + 0.02 * warm, -0.3 - 0.01 * warm, 0.1 + 0.005 * warm

    def resting_s(self) -> float:
        """Seconds since this rest began, below 0 in motion."""
        phase = self.seconds % _CYCLE_S
        return phase if phase < _REST_S else -1.0

    def gyro_dps(self, _: float) -> tuple[float, float, float]:
        """Bias, and in motion a rate that never stays."""
        x, y, z = self.bias_dps()
        if self.resting_s() >= 0:
            return x, y, z
        t = self.seconds
        return x + 40 * math.sin(1.3 * t), y + 30 * math.sin(2.1 * t), z + 50 * math.sin(0.7 * t)

    def accel_g(self, _: float) -> tuple[float, float, float]:
        """Gravity, and in motion shaking."""
        if self.resting_s() >= 0:
            return 0.0, 0.0, 1.0
        t = self.seconds
        return 0.3 * math.sin(3.1 * t), 0.2 * math.sin(2.3 * t), 1 + 0.2 * math.sin(4.7 * t)


class Judge:
    """A sink that holds each published line against the truth."""

    def __init__(self, world: World) -> None:
        self.world = world
        self.worst_dps = 0.0
        self.sum_square = 0.0
        self.judged = 0
        self.lines = 0
        self.awaiting = False
        self.after_kill_dps: list[float] = []

    def put(self, line: bytes) -> None:
        """One published line."""
        self.lines += 1
        bias = json.loads(line)["bias_dps"]
        wrong = max(abs(b - true) for b, true in zip(bias, self.world.bias_dps()))
        if self.awaiting:
            self.awaiting = False
            self.after_kill_dps.append(wrong)
        if self.world.resting_s() > _SETTLE_S:
            self.worst_dps = max(self.worst_dps, wrong)
            self.sum_square += wrong * wrong
            self.judged += 1

    def close(self) -> None:
        """Nothing to close."""


def run(hours: float = 24, faults: int = 1000, seed: int = 1) -> dict:
    """Live through them; what came of it."""
    luck = random.Random(seed)
    clock = FakeClock()
    world = World(clock)
    felt = {name: getattr(world, name) for name in ("gyro_dps", "accel_g", "temp_degc")}
    chip = FakeMPU6050(Physical(**felt))
    clock.devices.append(chip)
    bus, judge = FakeI2C(chip, clock), Judge(world)
    end_us = round(hours * 3.6e9)
    due = sorted((luck.randrange(end_us), luck.choice(FAULTS)) for _ in range(faults))
    done: Counter[str] = Counter()
    down_us = 0
    with tempfile.TemporaryDirectory() as folder:
        disk = Disk(Path(folder) / "learned.bin", clock)
        system = System(lambda: MPU6050(bus, odr_hz=ODR_HZ, clock=clock), disk, clock, _silent)
        service = Service(system, [judge])
        thawed_us = 0
        while clock.now_us < end_us:
            if chip.frozen and clock.now_us >= thawed_us:
                chip.frozen = False
            before_us, lines = clock.now_us, judge.lines
            try:
                while due and due[0][0] <= clock.now_us:
                    kind = due.pop(0)[1]
                    done[kind] += 1
                    if kind == "frozen":
                        chip.frozen, thawed_us = True, clock.now_us + luck.randrange(20_000_000)
                    _strike(kind, luck, chip, bus, disk)
                service.step()
            except Killed:
                clock.advance_us(1_000_000)  # as systemd starts it again
                service = Service(system, [judge])
                judge.awaiting = True
            if judge.lines == lines and clock.now_us - before_us > 500_000:
                down_us += clock.now_us - before_us
    after = judge.after_kill_dps
    return {
        "hours": hours,
        "faults": dict(done),
        "samples": judge.lines,
        "samples_due": round(ODR_HZ * (end_us - down_us) / 1e6),
        "down_s": down_us / 1e6,
        "refused_writes": disk.refused,
        "rms_mdps": 1e3 * math.sqrt(judge.sum_square / max(1, judge.judged)),
        "worst_mdps": 1e3 * judge.worst_dps,
        "kills": len(after),
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


def in_words(found: dict) -> str:
    """A few lines for a terminal."""
    faults = ", ".join(f"{count} {kind}" for kind, count in sorted(found["faults"].items()))
    return (
        f"{found['hours']:g} simulated hours, {sum(found['faults'].values())} faults: {faults}\n"
        f"samples published {found['samples']:,} of {found['samples_due']:,} due while it was up; "
        f"down for {found['down_s']:,.0f} s\n"
        f"bias at rest, from {_SETTLE_S:.0f} s on: {found['rms_mdps']:.1f} mdps rms, worst axis "
        f"and moment {found['worst_mdps']:.1f} mdps\n"
        f"first line after each of {found['kills']} kills: at most "
        f"{found['first_line_after_kill_mdps']:.1f} mdps wrong; "
        f"{found['refused_writes']} writes refused by a full disk\n"
    )
