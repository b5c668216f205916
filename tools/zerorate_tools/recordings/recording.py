"""A whole recording in memory."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from .scales import Scales

if TYPE_CHECKING:
    import pandas

TIME = "t_us"
GYRO = ("gx", "gy", "gz")
ACCEL = ("ax", "ay", "az")
TEMP = "temp"
#: Of a unit quaternion, body to world, of any common unit.
ATTITUDE = ("qw", "qx", "qy", "qz")
SAMPLE = (*ACCEL, TEMP, *GYRO)
COLUMNS = (TIME, *GYRO, *ACCEL, TEMP)

Columns = dict[str, np.ndarray]


@dataclass
class Recording:
    """Integer columns of equal length: t_us (int64, microseconds) and raw readings (int32, LSB).

    `ax ay az` and `temp` may be absent; columns that design.md does not name are extra channels.
    """

    columns: Columns
    scales: Scales
    name: str = "recording"
    path: Path | None = None

    def __len__(self) -> int:
        return len(self.columns[TIME])

    @property
    def column_names(self) -> list[str]:
        """Names in the order of design.md, extra channels last."""
        return in_order(self.columns)

    @property
    def extra_channels(self) -> list[str]:
        """Names of the columns beyond time, rates, acceleration and temperature."""
        return [name for name in self.columns if name not in COLUMNS]

    @property
    def has_accel(self) -> bool:
        """Whether the recording holds acceleration."""
        return "ax" in self.columns

    @property
    def has_temp(self) -> bool:
        """Whether the recording holds temperature."""
        return TEMP in self.columns

    @property
    def duration_s(self) -> float:
        """Seconds from the first to the last sample."""
        t_us = self.columns[TIME]
        return float(t_us[-1] - t_us[0]) * 1e-6 if len(t_us) else 0.0

    def gyro_lsb(self) -> np.ndarray:
        """(n, 3) raw rates x y z, LSB."""
        return np.stack([self.columns[name] for name in GYRO], axis=1)

    def gyro_dps(self) -> np.ndarray:
        """(n, 3) rates x y z, degrees a second."""
        return self.gyro_lsb() / self.scales.gyro_lsb_per_dps

    def accel_g(self) -> np.ndarray:
        """(n, 3) specific force x y z in g. Raises KeyError if there is none."""
        return np.stack([self.columns[n] for n in ACCEL], axis=1) / self.scales.accel_lsb_per_g

    def temp_degc(self) -> np.ndarray:
        """(n,) temperature as read, degC. Raises KeyError if there is none."""
        return self.scales.temp_degc(self.columns[TEMP])

    def samples(self) -> np.ndarray:
        """(n, 7) int32 ax ay az temp gx gy gz as the firmware takes them; absent ones are 0."""
        zeros = np.zeros(len(self), np.int32)
        return np.stack([self.columns.get(name, zeros) for name in SAMPLE], axis=1)

    def between(self, first: int, last: int) -> Recording:
        """The samples [first, last) as a recording of their own."""
        part = {name: values[first:last] for name, values in self.columns.items()}
        return Recording(part, self.scales, self.name, self.path)

    def to_frame(self, physical: bool = False) -> pandas.DataFrame:
        """One row a sample, raw integers in LSB; the scales are in `frame.attrs["zerorate"]`.

        physical: `t_s` since the first sample as the index, then gx_dps.. ax_g.. temp_degc, where
        they are there, and the extra channels as they are.
        """
        import pandas

        columns = self._in_units() if physical else self.columns
        names = list(columns) if physical else self.column_names
        frame = pandas.DataFrame({name: columns[name] for name in names})
        frame.attrs["zerorate"] = self.scales.to_json()
        return frame.set_index("t_s") if physical else frame

    def _in_units(self) -> Columns:
        t_us = self.columns[TIME]
        columns = {"t_s": (t_us - t_us[:1]) * 1e-6}
        columns |= {f"{n}_dps": v for n, v in zip(GYRO, self.gyro_dps().T)}
        if self.has_accel:
            columns |= {f"{n}_g": v for n, v in zip(ACCEL, self.accel_g().T)}
        if self.has_temp:
            columns["temp_degc"] = self.temp_degc()
        return columns | {name: self.columns[name] for name in self.extra_channels}


def in_order(names: Columns | list[str]) -> list[str]:
    """Column names in the order of design.md, extra channels last as they came."""
    return [n for n in COLUMNS if n in names] + [n for n in names if n not in COLUMNS]
