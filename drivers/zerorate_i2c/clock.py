"""The clock the driver waits and measures by; any object with these four functions will do."""

try:
    # with u MicroPython does not look for it on its file system first: 4 ms
    from utime import sleep_ms, ticks_add, ticks_diff, ticks_us
except ImportError:
    import time

    _BOOTTIME = getattr(time, "CLOCK_BOOTTIME", None)  # Linux's, which a suspension does not stop

    def ticks_us() -> int:
        """Microseconds that only go forward."""
        now_ns = time.monotonic_ns() if _BOOTTIME is None else time.clock_gettime_ns(_BOOTTIME)
        return now_ns // 1000

    def ticks_diff(end: int, start: int) -> int:
        """Microseconds from start to end."""
        return end - start

    def ticks_add(ticks: int, delta: int) -> int:
        """The time delta microseconds after ticks."""
        return ticks + delta

    def sleep_ms(milliseconds: float) -> None:
        """Wait."""
        time.sleep(milliseconds / 1000)


__all__ = ["sleep_ms", "ticks_add", "ticks_diff", "ticks_us"]
