"""Damaged logs by the hundred thousand.

    python -m host_tests.hostile.many_logs [FORMAT...] [--times N] [--seed N]

Forks judge them, thousands each: what `import` does in its guarded child and what it does with the
rows run in one process, with the child's limit of memory. A fork that dies is begun again behind
the log that killed it. A fault is a traceback, a warning on the terminal, a death, or a log that
its reader does not end with; where a parser died or went on that `import` has in its guarded child,
that child is counted.
"""

import argparse
import contextlib
import io
import json
import mmap
import os
import random
import resource
import signal
import struct
import sys
import tempfile
import traceback
import warnings
import zipfile
from collections import Counter
from pathlib import Path
from types import SimpleNamespace

from zerorate_bench.foreign_logs import arrays, robots, sensors
from zerorate_bench.foreign_logs.world import World
from zerorate_tools.bounds import ALONE, MEMORY_MB
from zerorate_tools.errors import ZerorateError
from zerorate_tools.importers import read_foreign
from zerorate_tools.importers.logs import apart
from zerorate_tools.recordings import read_recording, write_recording

from host_tests.tools.killed_writers import recording

MOST_MB = 600
TIMES, OF_PARQUET = 20_000, 100_000
_SAMPLES, _EACH_FORK, _MOST_S = 60, 2000, 10
_at = mmap.mmap(-1, 9)  # the number of the mutant that a fork is at, and whether it is guarded
_WORDS = (0, 1, 0x7F, 0x80, 0xFF, 0x7FFF, 0xFFFF, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF)


def own(folder, world):
    write_recording(recording(1, world.samples), folder / "in.parquet")
    return folder / "in.parquet"


def zipped(folder, world):
    with zipfile.ZipFile(folder / "in.zip", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.write(robots.euroc(folder, world), "data.csv")
    return folder / "in.zip"


def gz(folder, world):
    import gzip

    path = folder / "in.csv.gz"
    path.write_bytes(gzip.compress(robots.mavlogdump(folder, world).read_bytes(), mtime=0))
    return path


# format -> its writers; a mutant is one of any of them
FORMATS = {
    "parquet": (own, arrays.parquet),
    "feather": (arrays.feather,),
    "matlab": (arrays.matlab, arrays.matlab73),
    "hdf5": (arrays.hdf5, arrays.hdf5_table),
    "numpy": (arrays.npz, arrays.npy),
    "ulog": (robots.ulog,),
    "dataflash": (robots.dataflash, robots.dataflash_of_2015),
    "blackbox": (robots.blackbox,),
    "ros1": (robots.ros1,),
    "db3": (robots.db3,),
    "mcap": (robots.mcap, robots.mcap_json),
    "json": (arrays.json_columns, arrays.json_records, arrays.json_lists, robots.json_lines),
    "csv": (robots.euroc, robots.uzh_fpv, robots.mavlogdump, robots.blackbox_explorer),
    "words": (sensors.in_words, sensors.echoed, sensors.parted),
    "csv.gz": (gz,),
    "zip": (zipped,),
}


def mutant(whole, draw):
    """Bytes with some to many changes: bits, bytes, words of odd numbers, pieces, a cut."""
    content = bytearray(whole)
    for _ in range(draw.choice((1, 1, 1, 2, 3, 8, 40))):
        at, kind = draw.randrange(len(content) or 1), draw.randrange(8)
        if kind <= 1 and content:
            content[at] ^= 1 << draw.randrange(8)
        elif kind == 2 and content:
            content[at] = draw.randrange(256)
        elif kind == 3:
            word = struct.pack(draw.choice("<>") + "Q", draw.choice(_WORDS))
            size = draw.choice((1, 2, 4, 8))
            content[at : at + size] = word[:size] if draw.random() < 0.5 else word[-size:]
        elif kind == 4:
            other, size = draw.randrange(len(content) or 1), draw.randrange(1, 64)
            content[at : at + size] = content[other : other + size]
        elif kind == 5:
            del content[at : at + draw.randrange(1, 16)]
        elif kind == 6:
            content[at:at] = content[at : at + draw.randrange(1, 64)]
        elif draw.random() < 0.2:
            del content[at:]
    return bytes(content)


@contextlib.contextmanager
def in_this_process(reader, path, instance, advance):
    """In the place of `table_apart`: the child's work, and its limit, without a child."""
    out = os.memfd_create("rows")
    _at[8] = 1
    resource.setrlimit(resource.RLIMIT_DATA, (MEMORY_MB << 20, resource.RLIM_INFINITY))
    try:
        with warnings.catch_warnings(action="ignore"):  # the child has no standard error
            words = apart.written(reader, path, instance, os.dup(out))
    finally:
        resource.setrlimit(resource.RLIMIT_DATA, (resource.RLIM_INFINITY,) * 2)
        _at[8] = 0
    os.lseek(out, 0, os.SEEK_SET)
    with os.fdopen(out, "rb") as rows:
        said = io.BytesIO(json.dumps(words).encode())
        code = int("problem" in words)
        child = SimpleNamespace(stdout=rows, stderr=said, wait=lambda: code)
        yield apart._Rows(child, path, advance).table


def judged(path):
    """read, refused, or the last lines of a traceback."""
    end = "read"
    for reads in (read_foreign, read_recording):
        if reads is read_recording and path.suffix != ".parquet":
            continue
        try:
            reads(path)
        except ZerorateError as error:
            end = "refused" if "\n" not in str(error) else f"two lines: {error}"
        except Exception:
            return " ".join(traceback.format_exc().splitlines()[-3:])
    return end


class Trial:
    """Mutants of one format, each by its own number from the seed."""

    def __init__(self, name, times, seed, folder):
        self.name, self.times, self.seed, self.folder = name, times, seed, folder
        self.sound = []
        for number, write in enumerate(FORMATS[name]):
            (folder / str(number)).mkdir()
            path = write(folder / str(number), World(_SAMPLES))
            self.sound.append((path, path.read_bytes()))
        self.ends, self.faults, self.most_mb = Counter(), [], 0.0

    def put(self, number):
        """The path at which mutant `number` now is."""
        draw = random.Random(f"{self.seed} {self.name} {number}")
        path, whole = draw.choice(self.sound)
        path.write_bytes(mutant(whole, draw))
        return path

    def run(self):
        """Judge all."""
        number = 0
        while number < self.times:
            number = self._fork(number, min(self.times, number + _EACH_FORK))

    def _fork(self, first, end):
        ours, theirs = os.pipe()
        if (child := os.fork()) == 0:
            try:
                os.close(ours)
                self._judge(first, end, theirs)
            finally:
                os._exit(3)
        os.close(theirs)
        with os.fdopen(ours) as pipe:
            for line in pipe:
                number, words = json.loads(line)
                self._count(number, words)
        _, status, used = os.wait4(child, 0)
        self.most_mb = max(self.most_mb, used.ru_maxrss / 1024)
        if os.WIFEXITED(status) and os.WEXITSTATUS(status) == 0:
            return end
        (at,) = struct.unpack("<q", _at[:8])
        if _at[8]:
            _at[8] = 0
            self.ends["ended"] += 1
            return at + 1
        late = os.WIFSIGNALED(status) and os.WTERMSIG(status) == signal.SIGPROF
        self._count(at, f"takes over {_MOST_S} s" if late else f"died with {status}")
        return at + 1

    def _judge(self, first, end, pipe):
        silent = os.open(os.devnull, os.O_WRONLY)
        os.dup2(silent, 1)
        os.dup2(silent, 2)
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
        apart.table_apart = in_this_process
        for number in range(first, end):
            _at[:8] = struct.pack("<q", number)
            path = self.put(number)
            signal.setitimer(signal.ITIMER_PROF, _MOST_S)
            words = judged(path)
            signal.setitimer(signal.ITIMER_PROF, 0)
            os.write(pipe, json.dumps([number, words]).encode() + b"\n")
        os._exit(0)

    def _count(self, number, words):
        if words in ("read", "refused"):
            self.ends[words] += 1
            return
        self.ends["fault"] += 1
        self.faults.append(f"{self.name} {number} of seed {self.seed}: {words}")


def main():
    """Print what fell and a line of each format; 1 if anything did."""
    if os.environ | ALONE != os.environ:  # they are read as a process begins
        os.execve(sys.executable, [sys.executable, *sys.orig_argv[1:]], os.environ | ALONE)
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("formats", nargs="*", choices=[*FORMATS, []], help="default: all")
    parser.add_argument("--times", type=int, help=f"of each; {TIMES}, of Parquet {OF_PARQUET}")
    parser.add_argument("--seed", type=int, default=random.SystemRandom().randrange(1 << 31))
    chosen = parser.parse_args()
    fallen = tried = 0
    most_mb = 0.0
    for name in chosen.formats or FORMATS:
        times = chosen.times or (OF_PARQUET if name == "parquet" else TIMES)
        with tempfile.TemporaryDirectory() as folder:
            trial = Trial(name, times, chosen.seed, Path(folder))
            trial.run()
        print("\n".join(trial.faults[:20]), end="\n" * bool(trial.faults))
        fallen, tried = fallen + trial.ends["fault"], tried + times
        most_mb = max(most_mb, trial.most_mb)
        ends = ", ".join(f"{trial.ends[end]} {end}" for end in ("read", "refused", "ended"))
        faults = f"{trial.ends['fault']} faults of {times}"
        print(f"{name}: {faults} ({ends}); {trial.most_mb:.0f} MB", flush=True)
    print(f"{fallen} failed of {tried} logs, at most {most_mb:.0f} MB, seed {chosen.seed}")
    return 1 if fallen or most_mb > MOST_MB else 0


if __name__ == "__main__":
    sys.exit(main())
