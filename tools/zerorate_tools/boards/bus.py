"""A recording from a chip on a Linux I2C bus: by its FIFO where it has one, else by polling."""

from __future__ import annotations

from array import array
from collections.abc import Callable
from typing import Any

from zerorate_i2c import clock
from zerorate_i2c.fifo import EMPTY, Fifo
from zerorate_i2c.mpu6050 import FRESH, MPU6050, RESTARTED, VERIFIED

from ..ending import noted_signals
from .recorder import Recorder, Take, scales_of

_POLLS_A_PERIOD = 3
_PATIENCE_S = 5.0
_VERIFY_S = 0.5
_SCALES = ("part", "odr_hz", "gyro_lsb_per_dps", "accel_lsb_per_g", "temp_lsb_per_degc")


def stream_bus(
    i2c: Any,
    take: Take,
    *,
    seconds: float | None = None,
    source: str = "I2C",
    done: Callable[[float], object] = lambda seconds: None,
    time_source: Any = clock,
    **options: Any,
) -> None:
    """Stream from the chip on i2c, any object with the driver's two methods.

    Into what take(scales) makes. seconds None: until a signal that ends programs; options are
    MPU6050's (address, odr_hz, full_scale_dps ...); done(seconds) is told of progress, and ends it
    by what is true. Samples are verified twice a second. Raises OSError where no chip answers, and
    for a bus that fails, which is waited for up to 5 s.
    """
    check_every = min(100, round(options.get("odr_hz", 100) * _VERIFY_S))
    imu = MPU6050(i2c, clock=time_source, **{"check_every": check_every, **options})
    values = {name: getattr(imu, name) for name in (*_SCALES, "temp_offset_degc", "binding")}
    taker = take(scales_of({**values, "source": source}))
    failure = _run(_feed(imu), imu, taker, seconds, done)
    if failure is None and _is_verified(imu):
        taker.confirm()
    taker.discard()
    taker.result.restarts, taker.result.bus_errors = imu.restarts, imu.bus_errors
    if failure:
        raise failure


def _run(
    feed: FifoFeed | PollingFeed,
    imu: MPU6050,
    taker: Recorder,
    seconds: float | None,
    done: Callable[[float], object],
) -> OSError | None:
    """Feed the taker until time is up or a signal came; the error that ended it, if one did."""
    sample = array("i", [0] * 7)
    begun = good = reported = imu.clock.ticks_us()
    with noted_signals() as came:
        while not came and (seconds is None or imu.clock.ticks_diff(good, begun) < seconds * 1e6):
            try:
                status, t_us, is_new = feed.read(sample)
            except OSError as error:
                taker.discard()
                if imu.clock.ticks_diff(imu.clock.ticks_us(), good) > _PATIENCE_S * 1e6:
                    return error
                imu.clock.sleep_ms(100)
                continue
            _note(taker, status, t_us, sample if is_new else None)
            good = imu.clock.ticks_us()
            if imu.clock.ticks_diff(good, reported) > 1_000_000:
                if done(imu.clock.ticks_diff(good, reported) / 1e6):
                    return None
                reported = good
    return None


def _note(taker: Recorder, status: int, t_us: int, sample: array[int] | None) -> None:
    if status == RESTARTED:
        taker.discard()
    elif status == VERIFIED:
        taker.confirm()
    if sample is not None:
        taker.add(t_us, sample)


def _is_verified(imu: MPU6050) -> bool:
    try:
        return imu.check()
    except OSError:
        return False


def _feed(imu: MPU6050) -> FifoFeed | PollingFeed:
    """The FIFO where frames come out of it, else polling."""
    fifo = FifoFeed(imu)
    if fifo.has_frames():
        return fifo
    fifo.stop()
    return PollingFeed(imu)


class FifoFeed:
    """Samples with the times that the FIFO's count gives them."""

    def __init__(self, imu: MPU6050) -> None:
        self._imu = imu
        self._fifo = Fifo(imu)
        self._t_us = 0
        # a quarter of what the FIFO holds, in frames of 14 bytes
        self._pause_ms = min(100, imu.period_us * imu.fifo_bytes // 56_000)

    def has_frames(self) -> bool:
        """Frames come out of the FIFO within five periods."""
        self._imu.clock.sleep_ms(self._imu.period_us / 200)
        count = bytearray(2)
        self._imu.read_into(0x72, count)
        return count != b"\0\0"

    def stop(self) -> None:
        """Leave the chip as it was."""
        self._fifo.stop()

    def read(self, sample: array[int]) -> tuple[int, int, bool]:
        """Status, time and whether there is a sample; waits when there is none."""
        status = self._fifo.read(sample)
        if status == EMPTY:
            self._imu.clock.sleep_ms(self._pause_ms)
        elif status != RESTARTED:
            self._t_us += self._fifo.dt_us
        return status, self._t_us, status in (FRESH, VERIFIED)


class PollingFeed:
    """Samples by bursts three times as often as they come, those seen before left out."""

    def __init__(self, imu: MPU6050) -> None:
        self._imu = imu
        self._t_us = 0
        self._last_us = self._due_us = imu.clock.ticks_us()
        self._pause_us = imu.period_us // _POLLS_A_PERIOD

    def read(self, sample: array[int]) -> tuple[int, int, bool]:
        """Status and time of the next poll and whether its sample was not seen before."""
        self._wait()
        repeats = self._imu.repeats
        status = self._imu.read(sample)
        now_us = self._imu.clock.ticks_us()
        self._t_us += self._imu.clock.ticks_diff(now_us, self._last_us)
        self._last_us = now_us
        is_new = status in (FRESH, VERIFIED) and self._imu.repeats == repeats
        return status, self._t_us, is_new

    def _wait(self) -> None:
        clock = self._imu.clock
        self._due_us = clock.ticks_add(self._due_us, self._pause_us)
        early_us = clock.ticks_diff(self._due_us, clock.ticks_us())
        if early_us > 0:
            clock.sleep_ms(early_us / 1000)
        else:
            self._due_us = clock.ticks_us()
