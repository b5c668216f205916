"""Read, learn, keep, publish: one loop that outlives the bus, the disk and its own death."""

import json
import os
import socket
from array import array
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from zerorate import Corrector, Sensor
from zerorate.checked import CheckedCorrector
from zerorate.storage.learned_store import LearnedStore
from zerorate.storage.save_schedule import SaveSchedule
from zerorate.storage.store import REASONS
from zerorate_i2c.fifo import EMPTY, Fifo

from ..errors import os_error_in_words
from .publish import Sink

_LEAST_PAUSE_MS = 10
_BUS_PAUSE_MS = 1000
_ALIVE_US = 2_000_000
_WRITES_A_DAY = 24 * 60
_TOLERANCE_DPS = 0.01


def notify(text: str) -> None:
    """Tell systemd (sd_notify); nothing where it does not listen."""
    path = os.environ.get("NOTIFY_SOCKET", "")
    if path:
        with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as out:
            out.connect("\0" + path[1:] if path[0] == "@" else path)
            out.send(text.encode())


@dataclass
class System:
    """What the service stands on; a test has its own.

    open_imu: a new MPU6050, raises OSError; storage: as zerorate.storage.places; clock: functions
    of zerorate_i2c.clock, which only goes forward, so that a clock set back is not seen; say: a
    line of log; notify: to systemd.
    """

    open_imu: Callable[[], Any]
    storage: Any
    clock: Any
    say: Callable[[str], None]
    notify: Callable[[str], None] = notify


class Service:
    """One chip, corrected for ever. bus_failures counts the times the chip had to be opened anew.

    sinks: where lines go. Each has `t_us` since the start, `rate_dps` without bias, `bias_dps`,
    `accel_g` and `temp_degc`.
    """

    def __init__(self, system: System, sinks: Sequence[Sink]) -> None:
        self.system = system
        self.sinks = sinks
        self.bus_failures = 0
        self.samples = 0
        self.t_us = 0
        self._imu: Any = None
        self._fifo: Any = None
        self._corrector: Any = None
        self._binding = b""
        self._sample = array("i", [0] * 7)
        self._bias_lsb = array("i", [0] * 3)
        self._told_us = system.clock.ticks_us() - _ALIVE_US

    def step(self) -> None:
        """Take the next sample, or wait a moment; returns soon whatever the bus does."""
        self._alive()
        try:
            if self._imu is None:
                self._open()
            status = self._fifo.read(self._sample)
        except OSError as error:
            self._lose(error)
            return
        if status == EMPTY:
            self.system.clock.sleep_ms(max(_LEAST_PAUSE_MS, self._imu.period_us // 500))
            return
        self.t_us += self._fifo.dt_us
        if self._corrector.update(self._sample, self._fifo.dt_us, status):
            self.samples += 1
            self._publish()
        self._keep()

    def run(self) -> None:
        """Until interrupted; then what was learned is written once more."""
        try:
            while True:
                self.step()
        except KeyboardInterrupt:
            if self._corrector is not None and self._store.save():
                self.system.say("kept what was learned")
        finally:
            for sink in self.sinks:
                sink.close()

    def _alive(self) -> None:
        clock = self.system.clock
        now_us = clock.ticks_us()
        if clock.ticks_diff(now_us, self._told_us) >= _ALIVE_US:
            self._told_us = now_us
            self.system.notify("WATCHDOG=1")

    def _open(self) -> None:
        self._imu = self.system.open_imu()
        self._fifo = Fifo(self._imu)
        if self._corrector is None or self._imu.binding != self._binding:
            self._begin()
        self.system.notify("READY=1")

    def _begin(self) -> None:
        """A chip that was not known: begin with what is stored of it."""
        imu = self._imu
        self._binding = imu.binding
        learner = Corrector(Sensor(*imu.scales))
        self._store = LearnedStore(self.system.storage, imu.binding, learner)
        self.system.say(
            f"{imu.part}, {imu.odr_hz:g} Hz: {REASONS[self._store.load(imu.kept_power)]}"
        )
        self._corrector = CheckedCorrector(learner)
        tolerance = max(1, round(_TOLERANCE_DPS * imu.gyro_lsb_per_dps))
        self._schedule = SaveSchedule(self._store, 3, tolerance, _WRITES_A_DAY, learner)

    def _lose(self, error: OSError) -> None:
        """The bus has failed for good: what came since the last check is in doubt."""
        if self._imu is not None or self.bus_failures == 0:
            self.system.say(f"bus: {os_error_in_words(error)}; trying again every second")
        self.bus_failures += 1
        if self._corrector is not None:
            self._corrector.take_back()
        close = getattr(getattr(self._imu, "i2c", None), "close", None)
        self._imu = None
        if close is not None:
            close()
        self.system.clock.sleep_ms(_BUS_PAUSE_MS)

    def _keep(self) -> None:
        """Write what was learned, at rest, when it moved, once a minute at most."""
        learner = self._corrector.corrector
        if learner.learned:  # and not of this rest alone
            for axis in range(3):
                self._bias_lsb[axis] = round(learner.bias_lsb(axis))
        if not self._schedule.is_significant(self._bias_lsb):
            return
        saves = self._schedule.saves
        kept = self._schedule.offer(learner.state, self._bias_lsb, self.t_us // 1_000_000)
        if not kept and self._schedule.saves > saves:
            self.system.say("what was learned cannot be written; trying again in a minute")

    def _publish(self) -> None:
        imu, sample, learner = self._imu, self._sample, self._corrector.corrector
        lsb = imu.gyro_lsb_per_dps
        line = {
            "t_us": self.t_us,
            "rate_dps": [round(sample[4 + axis] / lsb, 5) for axis in range(3)],
            "bias_dps": [round(learner.bias_lsb(axis) / lsb, 5) for axis in range(3)],
            "accel_g": [round(sample[axis] / imu.accel_lsb_per_g, 5) for axis in range(3)],
            "temp_degc": round(imu.temperature_degc(sample[3]), 2),
        }
        text = json.dumps(line, separators=(",", ":")).encode() + b"\n"
        for sink in self.sinks:
            sink.put(text)
