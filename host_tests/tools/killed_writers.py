"""Every writer of files, killed at each of its renames, openings and writes.

A fork writes over what a first run wrote and is killed before its n-th change of a folder (an audit
hook of Python tells of each), or as a file of its grows beyond so many bytes (a limit of the
kernel, whoever writes). What is there then must be old or new, each file whole; and after the next
command in that folder all of it old or all of it new, with nothing left beside.
"""

import argparse
import json
import os
import resource
import shutil
import signal
import sys
import tempfile
import traceback
from functools import partial
from pathlib import Path

import numpy as np
from zerorate_tools import closing
from zerorate_tools.kernels.export import export_c
from zerorate_tools.model import Slot, build_model, write_model
from zerorate_tools.model.files import sensor_for
from zerorate_tools.model.term import Term
from zerorate_tools.recordings import (
    Scales,
    growing_recording,
    recording_from_columns,
    write_recording,
)
from zerorate_tools.recordings.atomic import written_together
from zerorate_tools.recordings.drafts import clear_left_over
from zerorate_tools.replay import replay
from zerorate_tools.simulate import simulate_to_files

CHANGES = {"os.rename", "os.remove", "os.rmdir", "os.mkdir", "os.link", "os.truncate", "open"}
_SCALES = {"gyro_lsb_per_dps": 131.0, "accel_lsb_per_g": 16384.0, "temp_lsb_per_degc": 340.0}


def scales(version):
    return Scales(f"part {version}", 100.0 + version, temp_offset_degc=36.53, **_SCALES)


def recording(version, n=3000):
    rng = np.random.default_rng(version)
    names = ("gx", "gy", "gz", "ax", "ay", "az", "temp")
    columns = {name: rng.integers(-300, 300, n) for name in names}
    return recording_from_columns({"t_us": np.arange(n) * 10_000, **columns}, scales(version))


def model(version):
    slot = Slot(Term("temp", 20, 45, 32.5, power=2), (0.001 * version, 0.0, 0.0))
    return build_model([slot], scales(1))


def closed(version):
    """As `zerorate close` writes: files of several writers in a draft of the whole folder."""
    with written_together("out") as folder:
        write_recording(recording(version), folder / "corrected.parquet")
        write_model(model(version), folder)
        closing._written({"version": version}, folder)
        (folder / "plots").mkdir()
        (folder / "plots" / "a.png").write_text(f"picture {version}")


def simulated(version):
    for folder in ("runs", "truth"):
        Path(folder).mkdir(exist_ok=True)
    described = {"every_session": {"minutes": 0.2}}
    simulate_to_files(described, "runs/a.csv", truth="truth/a.parquet", seed=version)


def replayed(version):
    replay(recording(version), "bias.parquet", state="learned.bin", runtime="cpython")


def recorded(version):
    made = recording(version)
    with growing_recording("run.parquet", made.column_names, made.scales) as growing:
        for first in range(0, len(made), 1000):
            growing.append(made.between(first, first + 1000).columns)


WRITERS = {
    "Parquet": lambda version: write_recording(recording(version), "run.parquet"),
    "CSV": lambda version: write_recording(recording(version), "run.csv"),
    "zipped CSV": lambda version: write_recording(recording(version), "run.csv.gz"),
    "model": lambda version: write_model(model(version), "model"),
    "close": closed,
    "simulate": simulated,
    "replay": replayed,
    "record": recorded,
    "export c": lambda version: export_c("c", sensor_for(scales(version))),
}


def contents(folder):
    return {str(p.relative_to(folder)): p.read_bytes() for p in folder.rglob("*") if p.is_file()}


def count_changes(at=None):
    """Count changes of folders in a list, and die before number `at`."""
    seen = []

    def note(event, arguments):
        if event not in CHANGES or (event == "open" and not _writes(arguments)):
            return
        if len(seen) == at:
            os.kill(os.getpid(), signal.SIGKILL)
        seen.append(event)

    sys.addaudithook(note)
    return seen


def _writes(arguments):
    return isinstance(arguments[0], (str, bytes)) and bool(arguments[2] & (os.O_WRONLY | os.O_RDWR))


def in_fork(folder, work):
    """The status of a fork that does the work in the folder; what it says by a pipe."""
    ours, theirs = os.pipe()
    if (child := os.fork()) == 0:
        os.chdir(folder)
        code = 1
        try:
            os.write(theirs, json.dumps(work()).encode())
            code = 0
        except BaseException:
            traceback.print_exc()
        finally:
            os._exit(code)
    os.close(theirs)
    with os.fdopen(ours, "rb") as pipe:
        said = pipe.read()
    return os.waitpid(child, 0)[1], json.loads(said or b"null")


def limited(write, limit):
    """Write, and die at the first byte beyond a file's limit."""
    signal.signal(signal.SIGXFSZ, signal.SIG_DFL)
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit))
    write(2)


def counted(write, at=None):
    """How many changes the writer makes, or its end before number `at`."""
    seen = count_changes(at)
    write(2)
    return len(seen)


class Trials:
    """A writer, what its first run wrote and what its second would; fallen: sentences."""

    def __init__(self, name, folder):
        self.name, self.write, self.folder = name, WRITERS[name], folder
        self.tried, self.fallen = 0, []
        self.first = folder / "first"
        self.first.mkdir()
        assert in_fork(self.first, lambda: self.write(1) and None)[0] == 0
        self.old = contents(self.first)
        self.new, self.changes = self._end_to_end()

    def _end_to_end(self):
        place = self._again("second")
        status, changes = in_fork(place, partial(counted, self.write))
        assert status == 0 and changes, (status, changes)
        return contents(place), changes

    def _again(self, name):
        place = self.folder / name
        shutil.copytree(self.first, place)
        return place

    def all(self, sizes=12):
        """Kill at each change of the folder, and at lengths spread over the longest file."""
        longest = max(map(len, self.new.values()))
        for at in range(self.changes):
            self._one(f"change {at}", partial(counted, self.write, at))
        for limit in sorted({longest * k // sizes for k in range(sizes)}):
            self._one(f"byte {limit}", partial(limited, self.write, limit))
        return self

    def _one(self, said, work):
        place = self._again("trial")
        status, _ = in_fork(place, work)
        self.tried += 1
        for problem in self._problems(place, status):
            self.fallen.append(f"{self.name}, killed at {said}: {problem}")
        shutil.rmtree(place)

    def _problems(self, place, status):
        if not os.WIFSIGNALED(status):
            yield f"it was not killed ({status})"
        for name in self.old.keys() | self.new.keys():
            is_there = (place / name).exists()
            content = (place / name).read_bytes() if is_there else None
            if content not in (self.old.get(name), self.new.get(name)):
                yield f"{name} is neither the old one nor the new one"
        for folder in [place, *(p for p in place.rglob("*") if p.is_dir())]:
            if folder.is_dir() and not folder.name.startswith(".zerorate"):
                clear_left_over(folder)
        # what a killed recorder has not finished stays, by its name
        left = {name: data for name, data in contents(place).items() if ".partial" not in name}
        if left not in (self.old, self.new):
            yield f"afterwards there are {sorted(left)}, partly old and partly new"


def trials(name):
    """All trials of a writer."""
    with tempfile.TemporaryDirectory() as folder:
        return Trials(name, Path(folder)).all()


def main():
    """Print what fell; 1 if anything did."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("writers", nargs="*", choices=[*WRITERS, []], help="default: all")
    done = [trials(name) for name in parser.parse_args().writers or WRITERS]
    fallen = [problem for one in done for problem in one.fallen]
    print("\n".join(fallen))
    tried = sum(one.tried for one in done)
    print(f"{len(fallen)} failed of {tried} kills of {len(done)} writers")
    return 1 if fallen else 0


if __name__ == "__main__":
    sys.exit(main())
