"""A foreign recording in physical units, before it becomes integers."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, field

import numpy as np


@dataclass
class Foreign:
    """What a reader found: float columns of equal length n, in the source's order.

    gyro: (n, 3) dps, accel: (n, 3) g, temp: (n,) degC; or raw counts where `raw` has their letter
    (g a t). time_s: seconds, or None where the source has no time stamps. extra: further channels,
    to be rounded to integers. index: each row's place in the source, 0-based.
    lsb: scales that make the conversion exact, where the source's own resolution is known.
    dropped: rows left out already, by reason. notes: what a person should know.
    """

    gyro: np.ndarray
    time_s: np.ndarray | None = None
    accel: np.ndarray | None = None
    temp: np.ndarray | None = None
    extra: dict[str, np.ndarray] = field(default_factory=dict)
    raw: str = ""
    sensor: str = ""
    odr_hz: float | None = None
    lsb: dict[str, float] = field(default_factory=dict)
    more: dict[str, object] = field(default_factory=dict)
    index: np.ndarray = field(default_factory=lambda: np.empty(0, np.int64))
    temp_step_lsb: int = 1
    dropped: Counter[str] = field(default_factory=Counter)
    notes: list[str] = field(default_factory=list)
    hint_hz: str = "give --hz, samples a second"

    def __post_init__(self) -> None:
        if not len(self.index):
            self.index = np.arange(len(self.gyro))

    def keep(self, good: np.ndarray, reason: str) -> None:
        """Leave out the rows that are not `good`, and count them under `reason`."""
        if good.all():
            return
        self.dropped[reason] += int((~good).sum())
        for name in ("gyro", "time_s", "accel", "temp", "index"):
            values = getattr(self, name)
            if values is not None:
                setattr(self, name, values[good])
        self.extra = {name: values[good] for name, values in self.extra.items()}
