"""Recorders ended at random moments: what is missing afterwards, and what else was harmed.

    python -m host_tests.tools.killed_recorders [--times N] [--seed N]

`zerorate record` runs in a fork, on a bus or on a board, whose chip counts its samples in memory
that both share. It gets SIGTERM, SIGHUP, SIGINT or SIGKILL, files may not grow beyond some length,
or the wire is pulled out; another command then writes in the same folder. Samples of the chip that
are in no recording, recovered or whole, may be 2 s of them at most, and no older file may differ.
"""

import argparse
import contextlib
import mmap
import os
import random
import resource
import select
import signal
import struct
import sys
import tempfile
from collections import Counter
from pathlib import Path

from zerorate_fakes import FakeClock, FakeI2C, FakeMPU6050
from zerorate_tools import cli
from zerorate_tools.boards import port, recording
from zerorate_tools.boards.bus import stream_bus
from zerorate_tools.boards.port import SAMPLE, SCALES, encode
from zerorate_tools.recordings import read_recording, recover, write_recording

from host_tests.tools.killed_writers import contents
from host_tests.tools.killed_writers import recording as a_recording

MOST_S = 2.0
PATIENCE_S = 60
KINDS = ("SIGTERM", "SIGHUP", "SIGINT", "SIGKILL", "full", "unplugged")
_BOARD_HZ = 100
_SCALES = (
    b'{"part": "MPU-6050", "odr_hz": 100, "gyro_lsb_per_dps": 131, "accel_lsb_per_g": 16384,'
    b' "temp_lsb_per_degc": 340, "temp_offset_degc": 36.53}'
)


class Chip:
    """Samples that count themselves, in memory that forks share; unplugged after so many."""

    def __init__(self, most):
        self._shared = mmap.mmap(-1, 8)
        self.most = most

    @property
    def made(self):
        return struct.unpack("<q", self._shared[:8])[0]

    def __iter__(self):
        number = 0
        while True:
            yield (number % 7, 3, 16384, -3000 + number % 5, number % 30000, number // 30000, 9)
            number += 1
            self._shared[:8] = struct.pack("<q", number)


class Wire(FakeI2C):
    """A bus that is pulled out after so many samples."""

    chip: Chip

    def readfrom_mem_into(self, addr, memaddr, buf):
        if self.chip.made > self.chip.most:
            raise OSError(121, "Remote I/O error")
        super().readfrom_mem_into(addr, memaddr, buf)


class Board:
    """What mpremote gives of a board that streams, as far as stream_port looks at it."""

    def __init__(self, chip):
        self.serial, self.in_waiting = self, 64
        self._chip, self._samples = chip, iter(chip)
        self._ready = encode(SCALES, _SCALES)
        self._sequence = 0

    def exec_raw_no_follow(self, program):
        """The board runs it."""

    def write(self, data):
        """Ctrl-C."""

    def read(self, size):
        if self._chip.made > self._chip.most:
            raise OSError(5, "device reports readiness to read but returned no data")
        while len(self._ready) < size:
            number, self._sequence = self._sequence, self._sequence + 1
            head = struct.pack(
                "<HIB", number % 65536, number * 10_000 % (1 << 30), number % 100 == 0
            )
            words = struct.pack(">7h", *next(self._samples))
            self._ready += encode(SAMPLE, head + words)
        data, self._ready = self._ready[:size], self._ready[size:]
        return data


def on_bus(chip, hz):
    """`zerorate record` on a bus of Linux: where, and with what options."""
    fake = FakeMPU6050(iter(chip))
    clock = FakeClock(fake)
    wire = Wire(fake, clock=clock)
    wire.chip = chip
    recording.stream = lambda bus, take, **options: stream_bus(
        wire, take, source=bus, time_source=clock, **options
    )
    return ["/dev/i2c-1", "--hz", str(hz)]


def on_board(chip, hz):
    """The same on a board."""

    @contextlib.contextmanager
    def connected(name):
        yield Board(chip)

    port.connected = connected
    return ["/dev/ttyACM0"]


class Trial:
    """One recorder and its end, drawn by a generator of random numbers."""

    def __init__(self, draw, folder):
        self.kind = draw.choice(KINDS)
        self.way = draw.choice((on_bus, on_board))
        self.hz = draw.choice((10, 50, 100, 250, 1000)) if self.way is on_bus else _BOARD_HZ
        self.after_s = draw.uniform(0.0, 0.6)
        self.limit = int(10 ** draw.uniform(2.0, 5.5)) if self.kind == "full" else None
        most = int(self.hz * draw.uniform(0.0, 100.0)) if self.kind == "unplugged" else 1 << 62
        self.chip = Chip(most)
        self.folder = folder
        self.out = folder / ("run" + draw.choice((".parquet", ".csv", ".csv.gz")))
        self.seconds = draw.choice((None, draw.uniform(1, 300)))
        self.bystanders = self._put_there()

    def __str__(self):
        way = self.way.__name__.replace("_", " a ")
        return f"{self.kind} {way} at {self.hz} Hz into {self.out.name} after {self.after_s:.3f} s"

    def _put_there(self):
        """Older files: one of the same name, others, and what looks left over but is not ours."""
        write_recording(a_recording(1, 50), self.out)
        write_recording(a_recording(1, 50), self.folder / "other.csv")
        (self.folder / ".1.partial.old").mkdir()
        (self.folder / ".1.partial.old" / "thesis").write_text("mine")
        (self.folder / "run.partial.csv").write_text("of somebody else")
        return contents(self.folder)

    def run(self):
        """Problems, the seconds that are missing, and the file that holds the others."""
        ours, theirs = os.pipe()
        child = os.fork()
        if child == 0:
            self._record(theirs)
        os.close(theirs)
        with os.fdopen(ours, "rb", buffering=0) as began:
            began.read(1)  # a fork forgets a signal that comes before Python runs in it
            if self.kind.startswith("SIG"):
                select.select([ours], [], [], self.after_s)  # it has ended by itself, or time is up
                os.kill(child, getattr(signal, self.kind))
            ended = select.select([ours], [], [], PATIENCE_S)[0]
            if not ended:
                os.kill(child, signal.SIGKILL)
            status = os.waitpid(child, 0)[1]
        return self._judged(status, [] if ended else ["it went on"])

    def _record(self, pipe):
        code = 70
        signal.signal(signal.SIGINT, signal.default_int_handler)  # also where a shell ignores them
        for number in (signal.SIGTERM, signal.SIGHUP):
            signal.signal(number, signal.SIG_DFL)
        try:
            os.write(pipe, b"!")
            more = [] if self.seconds is None else ["--seconds", str(self.seconds)]
            sys.argv = ["zerorate", "record", *self.way(self.chip, self.hz), *more]
            sys.argv += ["--out", str(self.out)]
            if self.limit is not None:
                resource.setrlimit(resource.RLIMIT_FSIZE, (self.limit, self.limit))
            with open(os.devnull, "w") as nowhere, contextlib.redirect_stdout(nowhere):
                sys.stderr = nowhere
                code = cli.main()
        finally:
            os._exit(code)

    def _judged(self, status, problems):
        if os.WIFEXITED(status) and os.WEXITSTATUS(status) not in (0, 2, 130):
            problems.append(f"it ended with {os.WEXITSTATUS(status)}")
        write_recording(a_recording(2, 50), self.folder / "next.csv")  # the next command here
        mine = {self.out.name, self.out.name.replace(".csv", ".json").removesuffix(".gz")}
        for name, content in self.bystanders.items():
            if name not in mine and (self.folder / name).read_bytes() != content:
                problems.append(f"{name} was harmed")
        last, where = max(self._recordings(problems), default=(-1, None))
        made = min(self.chip.made, self.chip.most)
        missing_s = max(0, made - 1 - last) / self.hz
        if missing_s > MOST_S:
            problems.append(f"{missing_s:.2f} s of {made / self.hz:.1f} s are missing")
        return problems, missing_s, where or "nothing"

    def _recordings(self, problems):
        """(number of the last sample, file) of each recording of this run."""
        for left in self.folder.glob("run.partial-*.csv"):
            with contextlib.suppress(Exception):
                recover(left, self.folder / "recovered.parquet")
        for path in (self.out, self.folder / "recovered.parquet"):
            if not path.exists() and path != self.out:
                continue
            found = read_recording(path)
            if found.scales.sensor == "MPU-6050":
                columns = found.columns
                numbers = columns["gx"] + 30000 * columns["gy"]
                if (numbers[1:] <= numbers[:-1]).any():
                    problems.append(f"{path.name} has a sample twice or in a wrong order")
                yield int(numbers[-1]), path.name
            elif contents(self.folder)[path.name] != self.bystanders.get(path.name):
                problems.append(f"{path.name} is neither the old one nor the new one")


def trials(times, seed):
    """(sentences on what fell, the most seconds missing, how many ended where) of many trials."""
    draw = random.Random(seed)
    fallen, most_s, ends = [], 0.0, Counter()
    for _ in range(times):
        with tempfile.TemporaryDirectory() as folder:
            trial = Trial(draw, Path(folder))
            problems, missing_s, where = trial.run()
        fallen += [f"{trial}: {problem}" for problem in problems]
        most_s = max(most_s, missing_s)
        ends[where.partition(".")[0]] += 1
    return fallen, most_s, ends


def main():
    """Print what fell; 1 if anything did."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--times", type=int, default=200)
    parser.add_argument("--seed", type=int, default=random.SystemRandom().randrange(1 << 31))
    arguments = parser.parse_args()
    fallen, most_s, ends = trials(arguments.times, arguments.seed)
    print("\n".join(fallen))
    where = f"{ends['run']} whole, {ends['recovered']} recovered, {ends['nothing']} had not begun"
    missing = f"at most {most_s:.2f} s missing, seed {arguments.seed}"
    print(f"{len(fallen)} failed of {arguments.times} recorders: {where}; {missing}")
    return 1 if fallen else 0


if __name__ == "__main__":
    sys.exit(main())
