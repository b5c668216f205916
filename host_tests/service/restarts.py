"""python -m host_tests.service.restarts [N]: a service started N times, its bias moving.

Each life lasts a second, half a minute after the one before; every second one ends in order, the
others by kill. Exits 1 if the file was written twice within an hour, or descriptors or memory grew.
"""

import os
import resource
import sys
import tempfile
from pathlib import Path

from .test_service import BIAS_DPS, Board

_SETTLED = 100  # lives, after which nothing grows
_MOST_KB = 20_000


def main():
    lives = int(sys.argv[1]) if len(sys.argv) > 1 else 10_000
    with tempfile.TemporaryDirectory() as folder:
        board = Board(Path(folder), lambda _: [bias + now_s() / 36e3 for bias in BIAS_DPS])

        def now_s():
            return board.clock.now_us / 1e6

        for number in range(lives):
            if number == _SETTLED:
                before = level()
            board.restart()
            board.live(1 if number else 30)
            if number % 2:
                board.service._keep_at_the_end()
            board.clock.now_us += 30_000_000
            board.said.clear()
            board.told.clear()
        after, writes_us = level(), board.file.writes_us
    closest_s = min(b - a for a, b in zip(writes_us, writes_us[1:])) / 1e6
    print(
        f"{lives} restarts in {now_s() / 3600:.0f} hours: {len(writes_us)} writes, "
        f"{closest_s:.0f} s apart at least; {after[0] - before[0]} descriptors more, "
        f"{after[1] - before[1]} KB more"
    )
    grew = after[0] > before[0] or after[1] - before[1] > _MOST_KB
    return 1 if closest_s < 3598 or grew else 0


def level():
    """(open descriptors, peak of memory in KB)."""
    return len(os.listdir("/proc/self/fd")), resource.getrusage(resource.RUSAGE_SELF).ru_maxrss


if __name__ == "__main__":
    sys.exit(main())
