"""The loop on real recordings: before, after, the floor, and a cubic over temperature beside."""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from zerorate_tools.closing import load
from zerorate_tools.importers import import_recording
from zerorate_tools.loop.fit.line import ordinary
from zerorate_tools.loop.fit.regression import predicted
from zerorate_tools.loop.fit.single import PiecesByLine, held
from zerorate_tools.loop.read.sessions import Session
from zerorate_tools.loop.report.report import report
from zerorate_tools.loop.search.catalogue import ranges
from zerorate_tools.loop.verify.analysis import Analysis
from zerorate_tools.loop.verify.judge import rms_dps, scored
from zerorate_tools.loop.verify.run_kernels import run_and_prune
from zerorate_tools.model.term import Term

from ..public_data import CLOSED_ALONE, CLOSED_TOGETHER, recordings_folder, told_of
from ..tables import machine_line, measured, table_of

#: Of the error before, and of a cubic's, that the error after may be; of a cubic's, the median.
_MOST_OF_BEFORE, _MOST_OF_CUBIC, _MEDIAN = 1.0, 1.05, 0.7
#: No temperature of a part is so far.
_FAR_DEGC = 1e4
_POWERS, _MOST_BENDS = 7, 12


def run(data: Path | None) -> dict[str, dict[str, Any]]:
    """Name -> figures in mdps (RMS over the axes, held out) and what was found, of every recording
    alone and of those of one device together.

    before, after: by the firmware's own kernels; cubic: by double precision, on the same pieces.
    data: the recordings' folder, else as of `recordings_folder`.
    """
    rows, folder = {}, recordings_folder(data)
    every = {Path(name).name: [folder / name] for name in CLOSED_ALONE if (folder / name).exists()}
    every |= {name: sorted(folder.glob(pattern)) for name, pattern in CLOSED_TOGETHER.items()}
    with tempfile.TemporaryDirectory() as scratch:
        for name, paths in measured(every.items()):
            stems = (f"{path.parent.name}-{path.name.split('.')[0]}" for path in paths)
            logs = [Path(scratch, f"{stem}.parquet") for stem in stems]
            for path, log in zip(paths, logs):
                import_recording(path, log, **told_of(path))
            if logs:
                rows[name] = _row(
                    run_and_prune(load([*logs]), logs, Path(scratch, "out.parquet"))[0]
                )
    return rows


def _row(analysis: Analysis) -> dict[str, Any]:
    result, judgement, rival = report(analysis), analysis.judgement, cubic_left(analysis)
    best = best_curve_rms_dps(analysis)
    left = rms_mdps(np.vstack(judgement.residual_after))
    cubic = None if rival is None else rms_mdps(np.vstack(rival))
    effects = [f"{effect['effect']} ({effect['confidence']})" for effect in result["effects"]]
    beside = [", ".join(effect["confounded_with"]) for effect in result["effects"]]
    return {
        "before_mdps": rms_mdps(np.vstack(judgement.residual_before)),
        "after_mdps": left,
        "after_xyz_mdps": "/".join(f"{v:.0f}" for v in result["after_mdps"]),
        "cubic_mdps": "no temperature" if cubic is None else cubic,
        "of_cubic": "" if cubic is None else round(left / cubic, 3),
        "best_curve_of_cubic": "" if not cubic or best is None else round(1e3 * best / cubic, 3),
        "noise_of_a_block_mdps": round(1e3 * noise_dps(analysis.holdout), 2),
        "floor_mdps": rms_mdps(analysis.floor_dps),
        "found": ", ".join(effects) or "nothing",
        "confounded_with": "; ".join(b for b in beside if b),
        "withdrawn": ", ".join(what for what, _ in result["gate"]["withdrawn"]),
        "steps_listed": len(result["events"]),
        "drift_unexplained": "yes" if judgement.residual_test.left else "no",
    }


def noise_dps(sessions: Sequence[Session]) -> float:
    """White noise of a block, by the rates' differences from one block to the next."""
    changes = [np.diff(s.rate_dps[s.available], n=2, axis=0) for s in sessions]
    return float(np.sqrt((np.vstack(changes) ** 2).mean() / 6))


def in_markdown(rows: dict[str, dict[str, Any]]) -> str:
    """The page of `zerorate bench real`: what is missed first, then every recording."""
    worse = [n for n, r in rows.items() if r["after_mdps"] > _MOST_OF_BEFORE * r["before_mdps"]]
    ratios = {n: r["of_cubic"] for n, r in rows.items() if r["of_cubic"] != ""}
    beaten = [n for n, ratio in ratios.items() if ratio > _MOST_OF_CUBIC]
    floors = [min(ratio, rows[n]["best_curve_of_cubic"]) for n, ratio in ratios.items()]
    median, floor = (np.median(of) if of else np.nan for of in ([*ratios.values()], floors))
    lines = [
        "# Closing the loop on real recordings",
        "",
        "`zerorate bench real` wrote this page. " + machine_line(),
        f"Worse than before: {', '.join(worse) or 'none'}.",
        f"Worse than a cubic by more than 5 %, held out alike: {', '.join(beaten) or 'none'}.",
        f"Error after, over the cubic's: {median:.2f} in the median (asked for: {_MEDIAN}).",
        f"The same of the best of many curves over temperature, where it leaves less, chosen on "
        f"each axis by what was held out itself: {floor:.2f}.",
        "",
    ]
    return "\n".join([*lines, table_of([{"recording": name, **row} for name, row in rows.items()])])


def cubic_left(analysis: Analysis) -> list[NDArray[np.float64]] | None:
    """(n, 3) dps that a cubic leaves of each held-out part by the same pieces, or fitted on the
    same power-ons: held at the edges of what it was fitted to or not, whichever leaves less; NaN
    where unscored. None without temperature.
    """
    powers = _powers(analysis, 3)
    if not powers:
        return None
    left = [_left(analysis, terms) for terms in (powers, _at_edges(analysis, powers))]
    return min(left, key=lambda parts: float((rms_dps(parts) ** 2).sum()))


def best_curve_rms_dps(analysis: Analysis) -> float | None:
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


def _powers(analysis: Analysis, most: int) -> list[Term]:
    line = analysis.selection.line
    free = [replace(t, lo=-_FAR_DEGC, hi=_FAR_DEGC) for t in line]
    return [replace(free[0], power=k) for k in range(1, most + 1)] if free else []


def _bent(analysis: Analysis, slope: Term, bends: int) -> list[Term]:
    lo, hi, _ = ranges(analysis.train)["temp"]
    at = np.linspace(lo, hi, bends + 2)[1:-1] - slope.centre
    return [slope, *(replace(slope, knot=float(knot)) for knot in at)]


def _at_edges(analysis: Analysis, terms: list[Term]) -> list[Term]:
    return [held(replace(t, lo=-np.inf, hi=np.inf), analysis.train) for t in terms]


def _left(analysis: Analysis, terms: list[Term]) -> list[NDArray[np.float64]]:
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


def rms_mdps(rows: NDArray[np.float64]) -> float:
    """Over rows and axes, of the rows that are whole."""
    whole = rows[np.isfinite(rows).all(axis=-1)]
    return round(1e3 * float(np.sqrt(np.mean(np.square(whole)))), 2)
