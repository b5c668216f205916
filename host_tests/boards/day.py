"""A day of examples/main.py on an emulated board: its chip is reset, pulled out and put back.

`make day` runs it. Time is the emulation's; the chip is made of registers, on a bus without it
nothing acknowledges. The device rests and moves in turn while its bias follows the temperature.
"""

import argparse
import random
import sys
import types
from contextlib import suppress
from pathlib import Path
from unittest.mock import patch

from zerorate import checked
from zerorate_fakes import FakeClock, FakeI2C, FakeMPU6050
from zerorate_i2c.mpu6050 import MPU6050

from host_tests.service.faulty_day import World

PROGRAM = Path(__file__).resolve().parents[2] / "examples" / "main.py"
LEARNING_S = 60.0
CORRECTED_DPS = 0.05
_AWAY_S = (0.2, 5.0)


class EndOfDay(BaseException):
    """Time is up; no handler of the program's catches it."""


class Day(FakeClock):
    """The clock of a board, at whose due times the chip is reset, pulled out or put back.

    slowest_s: longest from a reset or from being put back to the first corrected sample whose bias
    is right; worst_dps: most that a bias of a corrected sample was wrong, once it was learned.
    """

    def __init__(self, hours, resets, unplugs, odr_hz, seed, drift_dps_per_h=0.0):
        super().__init__()
        luck, self.end_us = random.Random(seed), round(hours * 3.6e9)
        self.device = World(
            self,
            at_mean_dps=(1.1, -0.7, 0.3),
            cycle_s=50.0,
            rest_s=30.0,
            degc=25.0,
            swing_degc=8.0,
            drift_dps_per_h=drift_dps_per_h,
        )
        self.chip = FakeMPU6050(self.device.felt)
        self.devices.append(self.chip)
        self.bus, self.odr_hz = FakeI2C(self.chip), odr_hz
        kinds = [self.reset] * resets + [self.pull_out] * unplugs
        luck.shuffle(kinds)
        first_us = round(LEARNING_S * 1e6)
        step_us = (self.end_us - first_us) / max(1, len(kinds))
        self.due = [
            (round(first_us + step_us * (i + 0.5 * luck.random())), kind)
            for i, kind in enumerate(kinds)
        ]
        self.away_us = [round(1e6 * luck.uniform(*_AWAY_S)) for _ in range(unplugs)]
        self.done, self.back_us, self.took_s = {"resets": 0, "unplugs": 0}, None, []
        self.worst_dps, self.corrected, self.lines = 0.0, 0, 0

    def advance_us(self, us):
        """Let time pass, up to each event in turn."""
        end_us = self.now_us + us
        while self.due and self.due[0][0] <= end_us:
            at_us, event = self.due.pop(0)
            super().advance_us(max(0, at_us - self.now_us))
            event()
        super().advance_us(max(0, end_us - self.now_us))
        if self.now_us >= self.end_us:
            raise EndOfDay

    def reset(self):
        """A brown-out: the chip forgets its registers."""
        self.chip.power_up()
        self.done["resets"] += 1
        self.back_us = self.now_us

    def pull_out(self):
        """Nothing acknowledges until it is put back, with its registers forgotten."""
        self.bus.fault("nack", times=None)
        self.done["unplugs"] += 1
        self.back_us = None
        self.due.insert(0, (self.now_us + self.away_us.pop(), self.put_back))

    def put_back(self):
        self.bus.mend()
        self.chip.power_up()
        self.back_us = self.now_us

    def judge(self, corrector, rate_corrected):
        """Hold what the corrector says now against the truth."""
        if not rate_corrected or self.device.seconds < LEARNING_S:
            return
        self.corrected += 1
        lsb = corrector.sensor.gyro_lsb_per_dps
        true = self.device.bias_dps()
        wrong = max(abs(corrector.bias_lsb(i) / lsb - true[i]) for i in range(3))
        self.worst_dps = max(self.worst_dps, wrong)
        if self.back_us is not None and wrong < CORRECTED_DPS:
            self.took_s.append((self.now_us - self.back_us) / 1e6)
            self.back_us = None

    def run(self):
        """Run the program until the day ends; the figures."""
        day = self

        class Judged(checked.CheckedCorrector):
            def update(self, sample, dt_us, status=checked.FRESH):
                taken = super().update(sample, dt_us, status)
                day.judge(self.corrector, taken)
                return taken

        def count_line(*said):
            day.lines += 1

        board = types.ModuleType("zerorate_i2c.board")
        board.setup = lambda scl, sda: MPU6050(self.bus, clock=self, odr_hz=self.odr_hz)
        text = compile(PROGRAM.read_text(encoding="utf-8"), PROGRAM, "exec")
        with (
            patch.dict(sys.modules, {"zerorate_i2c.board": board}),
            patch.object(checked, "CheckedCorrector", Judged),
            suppress(EndOfDay),
        ):
            exec(text, {"print": count_line, "__name__": "__main__"})
        return self.figures()

    def figures(self):
        return {
            **self.done,
            "corrected again": len(self.took_s),
            "slowest_s": max(self.took_s, default=0.0),
            "corrected_samples": self.corrected,
            "worst_mdps": 1e3 * self.worst_dps,
            "lines": self.lines,
        }


def passed(found):
    """Whether rates were corrected again within 3 s each time and nothing wrong was learned."""
    events = found["resets"] + found["unplugs"]
    return (
        found["corrected again"] == events > 0
        and found["slowest_s"] < 3
        and found["worst_mdps"] < 1e3 * CORRECTED_DPS
    )


def main(arguments=None):
    """Print the figures; 1 if they are not as they must be."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--hours", type=float, default=24.0)
    parser.add_argument("--resets", type=int, default=200)
    parser.add_argument("--unplugs", type=int, default=200)
    parser.add_argument("--odr-hz", type=float, default=10.0)
    chosen = parser.parse_args(arguments)
    found = Day(chosen.hours, chosen.resets, chosen.unplugs, chosen.odr_hz, seed=1).run()
    for name, value in found.items():
        text = f"{value:,.4g}" if isinstance(value, float) else f"{value:,}"
        print(f"{name:<20}{text:>12}")
    return 0 if passed(found) else 1


if __name__ == "__main__":
    sys.exit(main())
