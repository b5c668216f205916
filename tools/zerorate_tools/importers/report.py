"""What a user says of a source beforehand, and what an import says of it afterwards."""

from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, field
from os import PathLike
from pathlib import Path

from ..numbers import counted, duration


@dataclass
class Options:
    """What the user knows of the source: scales, rate, name; None: as the source says.

    hz: counts the rows, whatever time stamps there are. more: keys for the scales' JSON, such as
    the roles of channels.
    """

    sensor: str | None = None
    hz: float | None = None
    gyro_lsb_per_dps: float | None = None
    accel_lsb_per_g: float | None = None
    temp_lsb_per_degc: float | None = None
    temp_offset_degc: float | None = None
    more: Mapping[str, object] = field(default_factory=dict)


def cut_words(path: PathLike[str], row: int) -> str:
    """What to do where a file holds two recordings, the second from that row on."""
    if Path(path).is_dir():
        return "cut each of its files there, by hand, and import the parts"
    return f"cut it there: zerorate cut {path} --at-row {row} --out FOLDER"


@dataclass
class Report:
    """What an import did: rows read and written, rows dropped by reason, readings at the rails.

    duration_s, odr_hz: of what was written.
    """

    rows_read: int = 0
    rows_written: int = 0
    duration_s: float = 0.0
    odr_hz: float = 0.0
    doubts: list[str] = field(default_factory=list)
    dropped: Counter[str] = field(default_factory=Counter)
    clipped: Counter[str] = field(default_factory=Counter)
    notes: list[str] = field(default_factory=list)

    def lines(self) -> list[str]:
        """The report in words, a line each."""
        out = [
            f"{self.rows_written} samples: {duration(self.duration_s)} at {self.odr_hz:.4g} Hz, "
            f"of {self.rows_read} rows"
        ]
        out += self.doubts
        out += [
            f"dropped {counted(count, 'row')}: {reason}" for reason, count in self.dropped.items()
        ]
        out += [
            f"{name}: {counted(count, 'reading')} at the end of the 16-bit range (clipped)"
            for name, count in self.clipped.items()
        ]
        return out + self.notes
