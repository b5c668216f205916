"""The clock the driver waits and measures by; any object with these three functions will do."""

import time

try:
    from time import sleep_ms, ticks_diff, ticks_us
except ImportError:

    def ticks_us():
        """Microseconds that only go forward."""
        return time.monotonic_ns() // 1000

    def ticks_diff(end, start):
        """Microseconds from start to end."""
        return end - start

    def sleep_ms(milliseconds):
        """Wait."""
        time.sleep(milliseconds / 1000)


__all__ = ["sleep_ms", "ticks_diff", "ticks_us"]
