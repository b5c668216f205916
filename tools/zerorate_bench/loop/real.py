"""The loop on real recordings: before, after, the floor, and a cubic over temperature beside."""

from __future__ import annotations

import tempfile
from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from zerorate_tools.loop.fit.line import ordinary
from zerorate_tools.loop.fit.regression import predicted
from zerorate_tools.loop.fit.single import PiecesByLine, held
from zerorate_tools.loop.search.catalogue import ranges
from zerorate_tools.loop.verify.judge import rms_dps, scored
from zerorate_tools.model.term import Term

from ..public_data import BIN_TABLES, CLOSED_ALONE, CLOSED_TOGETHER, told_of
from ..tables import machine_line, table

#: Of the error before, and of a cubic's, that the error after may be; of a cubic's, the median.
_MOST_OF_BEFORE, _MOST_OF_CUBIC, _MEDIAN = 1.0, 1.05, 0.7
#: No temperature of a part is so far.
_FAR_DEGC = 1e4
_POWERS, _MOST_BENDS = 7, 12
_G_DPS = 180 / np.pi
_MOST = 5
_LEAST_SAMPLES = 100  # a bin of one sample says nothing


def real_rows(data: Path) -> dict[str, dict]:
    """Name -> figures in mdps (RMS over the axes, held out) and what was found, of every recording
    alone, of those of one device together, and of tables of means.

    before, after: by the firmware's own kernels; cubic: by double precision, on the same pieces.
    """
    rows = {}
    every = {Path(name).name: [data / name] for name in CLOSED_ALONE if (data / name).exists()}
    every |= {name: sorted(data.glob(pattern)) for name, pattern in CLOSED_TOGETHER.items()}
    with tempfile.TemporaryDirectory() as scratch:
        for name, paths in every.items():
            if paths:
                rows[name] = _closed(paths, Path(scratch))
    for path in sorted((data / BIN_TABLES).glob("*.log")):
        rows[path.name] = hipnuc(path)
    return rows


def _closed(paths: list[Path], scratch: Path) -> dict:
    from zerorate_tools.closing import load
    from zerorate_tools.importers import import_recording
    from zerorate_tools.loop.report.report import report
    from zerorate_tools.loop.verify.measure import measure_and_prune

    logs = [scratch / f"{path.parent.name}-{path.name.split('.')[0]}.parquet" for path in paths]
    for path, log in zip(paths, logs):
        import_recording(path, log, **told_of(path))
    analysis, _ = measure_and_prune(load([*logs]), logs, scratch / "corrected.parquet")
    told = report(analysis)
    row = _row(analysis, told)
    if "vn200" in paths[0].parent.name:
        row["flip"] = _flip(analysis.sessions[0], float(analysis.floor_dps[2]))
    return row


def _row(analysis, told: dict) -> dict:
    judgement, rival = analysis.judgement, cubic_left(analysis)
    best = best_curve_rms_dps(analysis)
    left = rms_mdps(np.vstack(judgement.residual_after))
    cubic = None if rival is None else rms_mdps(np.vstack(rival))
    effects = [f"{effect['effect']} ({effect['confidence']})" for effect in told["effects"]]
    beside = [", ".join(effect["confounded_with"]) for effect in told["effects"]]
    return {
        "before_mdps": rms_mdps(np.vstack(judgement.residual_before)),
        "after_mdps": left,
        "after_xyz_mdps": "/".join(f"{v:.0f}" for v in told["after_mdps"]),
        "cubic_mdps": "no temperature" if cubic is None else cubic,
        "of_cubic": "" if cubic is None else round(left / cubic, 3),
        "best_curve_of_cubic": "" if not cubic or best is None else round(1e3 * best / cubic, 3),
        "noise_of_a_block_mdps": _noise(analysis),
        "floor_mdps": rms_mdps(analysis.floor_dps),
        "found": ", ".join(effects) or "nothing",
        "confounded_with": "; ".join(b for b in beside if b),
        "withdrawn": ", ".join(what for what, _ in told["gate"]["withdrawn"]),
        "steps_listed": len(told["events"]),
        "drift_unexplained": "yes" if judgement.residual_test.left else "no",
    }


def _flip(session, floor_dps: float) -> str:
    """What turning the part over did to its z rate, beside what Earth's rotation can do.

    floor_dps: of the z axis: what a mean over each side is uncertain by.
    """
    from zerorate_tools.loop.read.earth import EARTH_DPS

    up = session.block_mean(session.sources["acc_z"]) > 0
    there = session.available
    if not (up & there).any() or not (~up & there).any():
        return "not turned over"
    change = 1e3 * (
        session.rate_dps[up & there, 2].mean() - session.rate_dps[~up & there, 2].mean()
    )
    sure = 2e3 * floor_dps * np.sqrt(2.0)
    earth = 2e3 * EARTH_DPS
    said = f"{change:+.1f} +- {sure:.1f} mdps over a turn; Earth's rotation can be {earth:.1f}: "
    if abs(change) - sure <= earth:
        return said + "these data cannot tell the two apart"
    return said + f"at least {abs(change) - sure - earth:.1f} mdps are acceleration's"


def _noise(analysis) -> float:
    """White noise of a block, mdps, by the rates' differences from one block to the next."""
    changes = [np.diff(s.rate_dps[s.available], n=2, axis=0) for s in analysis.holdout]
    return round(float(1e3 * np.sqrt((np.vstack(changes) ** 2).mean() / 6)), 2)


def in_words(rows: dict[str, dict]) -> str:
    """The page of `zerorate bench real`: what is missed first, then every recording."""
    closed = {name: row for name, row in rows.items() if "of_cubic" in row}
    worse = [n for n, r in closed.items() if r["after_mdps"] > _MOST_OF_BEFORE * r["before_mdps"]]
    ratios = {n: r["of_cubic"] for n, r in closed.items() if r["of_cubic"] != ""}
    beaten = [n for n, ratio in ratios.items() if ratio > _MOST_OF_CUBIC]
    median = _median(ratios.values())
    floors = [
        min(r["of_cubic"], r["best_curve_of_cubic"]) for r in closed.values() if r["of_cubic"] != ""
    ]
    lines = [
        "# Closing the loop on real recordings",
        "",
        "`zerorate bench real` wrote this page. " + machine_line(),
        f"Worse than before: {', '.join(worse) or 'none'}.",
        f"Worse than a cubic by more than 5 %, held out alike: {', '.join(beaten) or 'none'}.",
        f"Error after, over the cubic's: {median:.2f} in the median (asked for: {_MEDIAN}).",
        f"The same of the best of many curves over temperature, where it leaves less, chosen on "
        f"each axis by what was held out itself: {_median(floors):.2f}.",
        "",
    ]
    keys = list(dict.fromkeys(k for row in rows.values() for k in row))
    header = ("recording", *(k.replace("_", " ") for k in keys))
    cells = [(name, *(row.get(k, "") for k in keys)) for name, row in rows.items()]
    return "\n".join([*lines, table(header, cells)])


def _median(values: Iterable[float]) -> float:
    every = list(values)
    return float(np.median(every)) if every else float("nan")


def cubic_left(analysis) -> list[NDArray[np.float64]] | None:
    """(n, 3) dps that a cubic leaves of each held-out part by the same pieces, or fitted on the
    same power-ons: held at the edges of what it was fitted to or not, whichever leaves less; NaN
    where unscored. None without temperature.
    """
    powers = _powers(analysis, 3)
    if not powers:
        return None
    left = [_left(analysis, terms) for terms in (powers, _at_edges(analysis, powers))]
    return min(left, key=lambda parts: float((rms_dps(parts) ** 2).sum()))


def best_curve_rms_dps(analysis) -> float | None:
    """RMS over the axes of what the best curve leaves: on each axis the best mean, of any weights,
    of two out of polynomials and lines with even bends, held at the edges or not. None without
    temperature.
    """
    powers = _powers(analysis, _POWERS)
    if not powers:
        return None
    curves = [powers[: n + 1] for n in range(_POWERS)]
    curves += [_bent(analysis, powers[0], bends) for bends in range(1, _MOST_BENDS + 1)]
    curves += [_at_edges(analysis, terms) for terms in curves]
    left = np.array([np.vstack(_left(analysis, terms)) for terms in curves])
    left = left[:, np.isfinite(left).all(axis=(0, 2))]
    return float(np.sqrt(np.mean([_least_mean_square(left[..., a]) for a in range(3)])))


def _powers(analysis, most: int) -> list[Term]:
    line = analysis.selection.line
    free = [replace(t, lo=-_FAR_DEGC, hi=_FAR_DEGC) for t in line]
    return [replace(free[0], power=k) for k in range(1, most + 1)] if free else []


def _bent(analysis, slope: Term, bends: int) -> list[Term]:
    lo, hi, _ = ranges(analysis.train)["temp"]
    at = np.linspace(lo, hi, bends + 2)[1:-1] - slope.centre
    return [slope, *(replace(slope, knot=float(knot)) for knot in at)]


def _at_edges(analysis, terms: list[Term]) -> list[Term]:
    return [held(replace(t, lo=-np.inf, hi=np.inf), analysis.train) for t in terms]


def _left(analysis, terms: list[Term]) -> list[NDArray[np.float64]]:
    """(n, 3) of each held-out part, NaN where unscored."""
    if analysis.single:
        return [PiecesByLine(analysis.sessions[0]).residual([], terms)]
    fitted = ordinary(terms, analysis.train)
    return [scored(s, predicted(terms, fitted, s))[0] for s in analysis.holdout]


def _least_mean_square(left: NDArray[np.float64]) -> float:
    """Least mean square of a mean of two of the (curves, n) rows."""
    e = left @ left.T / left.shape[1]
    own = np.diag(e)[:, None]
    apart = np.maximum(own - 2 * e + own.T, 1e-300)
    share = np.clip((own - e) / apart, 0.0, 1.0)
    return float((own - 2 * share * (own - e) + share**2 * apart).min())


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
