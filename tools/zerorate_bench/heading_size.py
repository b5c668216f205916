"""What closing recordings in motion costs: six of three minutes, and one of eight hours."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from zerorate_tools.recordings.writing import write_recording

from .children import close_cost
from .heading_simulated import Case, recorded
from .tables import table


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


SIZES = (Size(6, 180.0, 286.0, 0.2, 15.0, 1.0), Size(1, 8 * 3600.0, 100.0, 0.5, 60.0, 1.0))


def write(size: Size, folder: Path) -> None:
    """A device's recordings, all of one matrix."""
    for number in range(size.recordings):
        rng = np.random.default_rng(number)
        recording, _, _ = recorded(
            Case("hand", number, False), rng, size.hz, size.seconds, size.resting
        )
        write_recording(recording, folder / f"run-{number}.parquet")


def run() -> list[dict[str, Any]]:
    """Seconds of processor and GB of `zerorate close` for each size, and what it found."""
    costs = (close_cost(f"from {__name__} import *\nwrite({s!r}, folder)") for s in SIZES)
    return [{"size": str(s), "limits": [s.most_s, s.most_gb], **c} for s, c in zip(SIZES, costs)]


def passed(found: list[dict[str, Any]]) -> bool:
    """Whether each is within its limits."""
    return all(f["cpu_s"] <= f["limits"][0] and f["gb"] <= f["limits"][1] for f in found)


def in_markdown(found: list[dict[str, Any]]) -> str:
    """A row each, beside its limits."""
    rows = [
        [f["size"], f"{f['cpu_s']:.0f}", f"{f['gb']:.1f}", "{:g} s, {:g} GB".format(*f["limits"])]
        for f in found
    ]
    return table(["recordings in motion", "s of processor", "GB", "at most"], rows)
