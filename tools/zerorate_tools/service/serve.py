"""Read, learn, keep, publish: one loop that outlives the bus, the disk and its own death."""

import errno
import json
import math
import os
import socket
from array import array
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from zerorate import Corrector, Sensor
from zerorate.checked import CheckedCorrector
from zerorate.storage.codes import LOADED
from zerorate.storage.learned_store import LearnedStore
from zerorate.storage.reasons import REASONS
from zerorate.storage.save_schedule import SaveSchedule
from zerorate_i2c.fifo import EMPTY, Fifo

from ..errors import InFile, os_error_in_words
from .publish import Sink

_LEAST_PAUSE_MS = 10
_BUS_PAUSE_MS = 1000
_SILENT_MS = 60_000  # the driver restarts a chip much sooner
_ALIVE_US = 2_000_000
_RETRY_S = 60
_OTHER_MODEL = "name another model, or leave out --model"
_TOLERANCE_LSB = 1  # 0.008 dps in the finest range


def notify(text: str) -> None:
    """Tell systemd (sd_notify); nothing where there is none. Raises OSError where it is gone."""
    path = os.environ.get("NOTIFY_SOCKET", "")
    if path:
        with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as out:
            out.connect("\0" + path[1:] if path.startswith("@") else path)
            out.send(text.encode())


@dataclass
class System:
    """What the service stands on; a test has its own.

    open_imu: a new MPU6050, raises OSError; storage: a FileStorage; clock: functions of
    zerorate_i2c.clock, which only goes forward, so that a clock set back is not seen; say: a line
    of log; notify: to systemd; stored_ago_s: since the storage was last written, seconds, by
    whatever clock outlives the process. A wrong one costs a write, or puts one off by an hour.
    """

    open_imu: Callable[[], Any]
    storage: Any
    clock: Any
    say: Callable[[str], None]
    notify: Callable[[str], None] = notify
    stored_ago_s: Callable[[], float] = lambda: math.inf
    writes_a_day: int = 24


class Service:
    """One chip, corrected for ever.

    bus_failures counts the times the chip had to be opened anew, notify_failures what systemd was
    not told, `lost` of each sink its lines. sinks: where lines go. Each has `t_us` since the start,
    `rate_dps` without bias, `raw_dps` as the chip has it, `bias_dps`, `accel_g`, `temp_degc`, and
    `gap_us` since the line before where samples are missing between the two. model: bytes of an
    effect model, used where it fits; model_name: its file's, for an error.
    """

    def __init__(
        self,
        system: System,
        sinks: Sequence[Sink],
        model: bytes = b"",
        model_name: str = "model.bin",
    ) -> None:
        self.system = system
        self.sinks = sinks
        self._model, self._model_name = model, model_name
        self.bus_failures = 0
        self.notify_failures = 0
        self.samples = 0
        self.t_us = 0
        self._in_vain_ms = 0
        self._imu: Any = None
        self._fifo: Any = None
        self._corrector: Any = None
        self._binding = b""
        self._sample = array("i", bytes(28))  # words of four bytes
        self._bias_lsb = array("i", bytes(12))
        self._newest_us: int | None = None
        self._published_us: int | None = None
        self._said_lost = False
        self._is_refused = False
        self._told_us: int | None = None

    def step(self) -> None:
        """Take the next sample, or wait a moment; returns soon whatever the bus does."""
        self._alive()
        try:
            if self._imu is None:
                self._open()
            if self._in_vain_ms > _SILENT_MS:
                raise OSError(errno.ETIMEDOUT, "the chip gave no good sample for a minute")
            status = self._fifo.read(self._sample)
        except OSError as error:
            self._lose(error)
            return
        if status == EMPTY:
            pause_ms = max(_LEAST_PAUSE_MS, self._imu.period_us // 500)
            self.system.clock.sleep_ms(pause_ms)
            self._in_vain_ms += pause_ms
            return
        dt_us = self._passed_us()
        self.t_us += dt_us
        raw_lsb = self._sample[4:]
        if self._corrector.update(self._sample, dt_us, status):
            self.samples += 1
            self._in_vain_ms = 0
            self._publish(raw_lsb)
        self._keep()

    def _passed_us(self) -> int:
        """Microseconds since the sample before, which another FIFO than this may have given."""
        last_us, self._newest_us = self._newest_us, self._fifo.newest_us
        if last_us is None:
            return self._fifo.dt_us
        return self.system.clock.ticks_diff(self._newest_us, last_us)

    def run(self) -> None:
        """Until interrupted; then what was learned is written if that is due."""
        try:
            while True:
                self.step()
        except KeyboardInterrupt:
            if self._corrector is not None:
                self._keep_at_the_end()
        finally:
            lost = sum(sink.lost for sink in self.sinks)
            if lost or self.bus_failures or self.notify_failures:
                self.system.say(
                    f"lost {lost} lines, the bus {self.bus_failures} times, "
                    f"systemd {self.notify_failures} times"
                )
            for sink in self.sinks:
                sink.close()

    def _keep_at_the_end(self) -> None:
        if self._is_refused or self._schedule.is_due(self._now_s()):
            kept = self._store.save()
            self.system.say("kept what was learned" if kept else self._refused("is lost"))
        elif self._schedule.is_significant(self._bias_lsb):
            self.system.say("what was learned since the last write, within the hour, is not kept")
        else:
            self.system.say("kept what was learned")

    def _now_s(self) -> int:
        return self.t_us // 1_000_000

    def _notify(self, text: str) -> None:
        try:
            self.system.notify(text)
        except OSError as error:
            if not self.notify_failures:
                self.system.say(f"systemd: {os_error_in_words(error)}; going on without it")
            self.notify_failures += 1

    def _alive(self) -> None:
        clock = self.system.clock
        now_us = clock.ticks_us()
        if self._told_us is None or clock.ticks_diff(now_us, self._told_us) >= _ALIVE_US:
            self._told_us = now_us
            self._notify("WATCHDOG=1")

    def _open(self) -> None:
        self._imu = self.system.open_imu()
        self._fifo = Fifo(self._imu)
        if self._corrector is None or self._imu.binding != self._binding:
            self._begin()
        self._notify("READY=1")

    def _begin(self) -> None:
        """A chip that was not known: begin with what is stored of it."""
        imu = self._imu
        self._binding = imu.binding
        learner = Corrector(Sensor(*imu.scales))
        if self._model:
            self._use_model(learner)
        self._store = LearnedStore(self.system.storage, imu.binding, learner)
        reason = self._store.load(imu.kept_power)
        self.system.say(
            f"{imu.part}, {imu.odr_hz:g} Hz, {self.system.storage.path}: {REASONS[reason]}"
        )
        self._corrector = CheckedCorrector(learner)
        budget = self.system.writes_a_day
        self._schedule = SaveSchedule(self._store, 3, _TOLERANCE_LSB, budget, learner)
        if reason == LOADED:
            ago_s = self.system.stored_ago_s()
            ago_s = ago_s if 0 <= ago_s < self._schedule.interval_s else self._schedule.interval_s
            self._schedule.written_at(self._now_s() - int(ago_s))

    def _use_model(self, learner: Corrector) -> None:
        """Subtract what the model says. Raises InFile where it is of another device."""
        from zerorate.effects.model_file import REASONS as MODEL_REASONS
        from zerorate.model import EffectModel

        effects = EffectModel()
        reason = effects.load(self._model, learner.sensor, self._binding)
        if reason != LOADED:
            raise InFile(self._model_name, MODEL_REASONS[reason], do=_OTHER_MODEL)
        if effects.channels:
            names = ", ".join(effects.channels)
            problem = f"it follows the channel {names}, which is not here"
            raise InFile(self._model_name, problem, do=_OTHER_MODEL)
        learner.use_model(effects)

    def _lose(self, error: OSError) -> None:
        """The bus has failed for good: what came since the last check is in doubt."""
        if self._imu is not None or not self.bus_failures:
            self.system.say(f"bus: {os_error_in_words(error)}; trying again every second")
        self.bus_failures += 1
        self._in_vain_ms = 0
        if self._corrector is not None:
            self._corrector.take_back()
        close = getattr(getattr(self._imu, "i2c", None), "close", None)
        self._imu = None
        if close is not None:
            close()
        self.system.clock.sleep_ms(_BUS_PAUSE_MS)

    def _keep(self) -> None:
        """Write what was learned, at rest, when it moved and a write is due."""
        learner = self._corrector.corrector
        if learner.learned:  # and not of this rest alone
            for axis in range(3):
                self._bias_lsb[axis] = round(learner.bias_lsb(axis))
        if not self._schedule.is_significant(self._bias_lsb):
            return
        saves = self._schedule.saves
        kept = self._schedule.offer(learner.state, self._bias_lsb, self._now_s())
        if self._schedule.saves == saves:
            return
        self._is_refused = not kept
        if not kept:
            self._schedule.next_s = self._now_s() + _RETRY_S
            self.system.say(self._refused("is not kept yet; trying again every minute"))

    def _refused(self, so: str) -> str:
        do = "free space on its disk, or let this user write it"
        return f"{self.system.storage.path}: cannot be written; {do}; what was learned {so}"

    def _publish(self, raw_lsb: "array[int]") -> None:
        imu, sample, learner = self._imu, self._sample, self._corrector.corrector
        lsb = imu.gyro_lsb_per_dps
        line = {
            "t_us": self.t_us,
            "rate_dps": [round(left / lsb, 5) for left in sample[4:]],
            "raw_dps": [round(raw / lsb, 5) for raw in raw_lsb],
            "bias_dps": [round(learner.bias_lsb(axis) / lsb, 5) for axis in range(3)],
            "accel_g": [round(force / imu.accel_lsb_per_g, 5) for force in sample[:3]],
            "temp_degc": round(imu.temperature_degc(sample[3]), 2),
        }
        last_us, self._published_us = self._published_us, self.t_us
        if last_us is not None and self.t_us - last_us > 2 * imu.period_us:
            line["gap_us"] = self.t_us - last_us
        text = json.dumps(line, separators=(",", ":")).encode() + b"\n"
        for sink in self.sinks:
            sink.put(text)
            if sink.lost and not self._said_lost:
                self._said_lost = True
                self.system.say("a reader is too slow, or has no room: its lines are lost")
