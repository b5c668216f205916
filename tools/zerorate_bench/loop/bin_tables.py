"""Tables of a chip's bias by temperature: curvature, judged on every second bin."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

_G_DPS = 180 / np.pi
_MOST = 5
_LEAST_SAMPLES = 100  # a bin of one sample says nothing


@dataclass(frozen=True)
class Table:
    """temp_degc (n,), count (n,) samples, rate_dps (n, 3) of the bins."""

    temp_degc: NDArray[np.float64]
    count: NDArray[np.float64]
    rate_dps: NDArray[np.float64]

    def of(self, keep: NDArray[np.bool_]) -> Table:
        """Some of the bins."""
        return Table(self.temp_degc[keep], self.count[keep], self.rate_dps[keep])


def hipnuc(path: Path) -> dict:
    """Curvature of a chip's table: order chosen on every second bin, judged on the others."""
    table = read(path)
    even = np.arange(len(table.temp_degc)) % 2 == 0
    train, held = table.of(even), table.of(~even)
    order = chosen(train)
    row = {k: rms_mdps(left(train, held, k)) for k in (1, 3, order)}
    return {
        "before_mdps": row[1],
        "after_mdps": row[order],
        "cubic_mdps": row[3],
        "found": f"temperature polynomial of order {order}" if order > 1 else "nothing",
    }


def read(path: Path) -> Table:
    """A log of HiPNUC's device-side means. Unit A's lines have one column more than unit B's."""
    rows = []
    for text in path.read_text().splitlines():
        if text.startswith("BIN_DATA:"):
            rows.append([float(v) for v in text.split(":")[1].split(",")])
    width = 10 if "unitB" in path.name else 11
    table = np.array([r for r in rows if len(r) >= width - 1])
    first = 6 + (width == 11)
    keep = table[:, 2] > _LEAST_SAMPLES
    return Table(table[keep, 1], table[keep, 2], table[keep, first : first + 3] * _G_DPS)


def chosen(train: Table) -> int:
    """The order of polynomial that predicts bins left out one at a time best, orders paying."""
    return max(range(1, _MOST + 1), key=lambda order: _left_out_gain(train, order))


def fitted(train: Table, temp_degc: NDArray[np.float64], order: int) -> NDArray[np.float64]:
    """(n, 3) dps of the polynomial of an order, weighted by the bins' samples."""
    centre, span = train.temp_degc.mean(), np.ptp(train.temp_degc)
    w = np.sqrt(train.count / train.count.mean())[:, None]
    x = np.vander((train.temp_degc - centre) / span, order + 1)
    fit = np.linalg.lstsq(w * x, w * train.rate_dps, rcond=None)[0]
    return np.vander((temp_degc - centre) / span, order + 1) @ fit


def left(train: Table, held: Table, order: int) -> NDArray[np.float64]:
    """(n, 3) dps left of the bins held out that lie inside the range of the others."""
    low, high = train.temp_degc.min(), train.temp_degc.max()
    inside = (held.temp_degc >= low) & (held.temp_degc <= high)
    return (held.rate_dps - fitted(train, held.temp_degc, order))[inside]


def rms_mdps(rows: NDArray[np.float64]) -> float:
    """Over rows and axes, of the rows that are whole."""
    whole = rows[np.isfinite(rows).all(axis=-1)]
    return round(1e3 * float(np.sqrt(np.mean(np.square(whole)))), 2)


def _left_out_gain(train, order):
    """Minus the logarithm of the error on bins left out one at a time, orders paying a little."""
    n = len(train.temp_degc)
    squares = []
    for i in range(1, n - 1):
        keep = np.arange(n) != i
        there = fitted(train.of(keep), train.temp_degc[i : i + 1], order)
        squares.append(((train.rate_dps[i] - there) ** 2).sum())
    return -n / 2 * np.log(np.sum(squares)) - order
