"""What closing recordings in motion costs: six of three minutes, and one of eight hours."""

import json
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from zerorate_tools.recordings.writing import write_recording

from .tables import table

_HOUR_S = 3600.0


@dataclass(frozen=True)
class Size:
    """Recordings of one device in the hand, and the seconds of processor and GB they may cost."""

    recordings: int
    seconds: float
    hz: float
    resting: float
    most_s: float
    most_gb: float

    def __str__(self) -> str:
        return f"{self.recordings} of {self.seconds / 60:g} minutes at {self.hz:g} Hz"


SIZES = (Size(6, 180.0, 286.0, 0.2, 15.0, 1.0), Size(1, 8 * _HOUR_S, 100.0, 0.5, 60.0, 1.0))
#: Run in a process of its own: its own peak, and that of no other, is then told.
_CLOSE = """
import json, re, sys, time
from pathlib import Path
from zerorate_tools.cli import main
code = main(sys.argv[1:])
peak = re.search(r"VmHWM:\\s+(\\d+)", Path("/proc/self/status").read_text())
print(json.dumps([code, time.process_time(), int(peak[1]) / 1e6]))
"""


def run(sizes=SIZES) -> list[dict]:
    """Seconds of processor and GB of `zerorate close` for each size, and what it found."""
    return [_measured(size) for size in sizes]


def write(size: Size, folder: Path) -> None:
    """A device's recordings, all of one matrix."""
    from .heading_simulated import Case, recorded

    for number in range(size.recordings):
        rng = np.random.default_rng(number)
        recording, _, _ = recorded(
            Case("hand", number, False), rng, size.hz, size.seconds, size.resting
        )
        write_recording(recording, folder / f"run-{number}.parquet")


def _measured(size: Size) -> dict:
    with TemporaryDirectory() as scratch:
        folder = Path(scratch)
        words = f"from {__name__} import *; write({size!r}, Path({scratch!r}))"
        subprocess.run([sys.executable, "-c", words], check=True)
        logs = [str(p) for p in sorted(folder.glob("run-*.parquet"))]
        close = [sys.executable, "-c", _CLOSE, "close", *logs, "--out", str(folder / "out")]
        done = subprocess.run(close, capture_output=True, text=True, check=True)
        code, cpu_s, peak_gb = json.loads(done.stdout.splitlines()[-1])
        if code:
            raise RuntimeError(done.stderr[-2000:])
    return {"size": str(size), "cpu_s": cpu_s, "gb": peak_gb, "limits": [size.most_s, size.most_gb]}


def passed(found: list[dict]) -> bool:
    """Whether each is within its limits."""
    return all(f["cpu_s"] <= f["limits"][0] and f["gb"] <= f["limits"][1] for f in found)


def in_markdown(found: list[dict]) -> str:
    """A row each, beside its limits."""
    rows = [
        [f["size"], f"{f['cpu_s']:.0f}", f"{f['gb']:.1f}", "{:g} s, {:g} GB".format(*f["limits"])]
        for f in found
    ]
    return table(["recordings in motion", "s of processor", "GB", "at most"], rows)
