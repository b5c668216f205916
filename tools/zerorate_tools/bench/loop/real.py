"""The loop on real recordings: before, after, the floor, and a cubic over temperature beside."""

from __future__ import annotations

import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ..public_data import told_of
from .chips import hipnuc, rms_mdps
from .flips import flip

#: Files of the data folder.
RECORDINGS = (
    "lsm6ds3-hubs/RB.csv",
    "lsm6ds3-hubs/RX.csv",
    "lsm6ds3-hubs/TH.csv",
    "gy521-cooldown/cooldown.csv.gz",
    "vn200-flip/static_z-_z+_IMU0.csv.gz",
    "vn200-flip/static_z-_z+_IMU1.csv.gz",
    "mpu6050-unmoved/set-2_unmoved-with-x-pointing-forward-10min.csv.gz",
    "adis16405-static/adis_16405_imu1.parquet",
    "adis16405-static/adis_16405_imu2.parquet",
)


def real_rows(data: Path, plots: Path | None = None) -> dict[str, dict]:
    """Name -> figures in mdps (RMS over the axes, held out) and what was found.

    before, after: by the firmware's own kernels; after_float, cubic: by double precision.

    plots: a folder for a PNG of each, or None.
    """
    rows = {}
    if plots:
        plots.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as scratch:
        for name in RECORDINGS:
            if (data / name).exists():
                rows[Path(name).name] = _recording(data / name, Path(scratch), plots)
    for path in sorted((data / "hipnuc-bins").glob("*.log")):
        rows[path.name] = hipnuc(path)
        if plots:
            from .plots import draw_chip

            draw_chip(path, plots / f"{path.stem}.png")
    return rows


def _recording(path: Path, scratch: Path, plots: Path | None) -> dict:
    from ...closing import load
    from ...importers import import_recording
    from ...loop.search.confounding import label
    from ...loop.verify.measure import measure
    from ...loop.verify.slots import model_of
    from ...recordings import open_recording

    out = scratch / f"{path.parent.name}-{path.name.split('.')[0]}.parquet"
    import_recording(path, out, **told_of(path))
    analysis = load([out])
    judgement, found = analysis.judgement, analysis.selection.found
    rival = cubic_left(analysis)
    model = model_of(analysis, open_recording(out).scales)
    by_kernels = measure(analysis, [out], model, scratch / "corrected.parquet").judgement
    row = {
        "floor_mdps": rms_mdps(analysis.floor_dps),
        "before_mdps": rms_mdps(by_kernels.before_dps),
        "after_mdps": rms_mdps(by_kernels.after_dps),
        "after_float_mdps": rms_mdps(judgement.after_dps),
        "cubic_mdps": "no temperature" if rival is None else _rms(rival),
        "found": ", ".join(f"{label(f.candidate)} (tentative)" for f in found) or "nothing",
        "confounded_with": "; ".join(", ".join(f.confounded_with) for f in found),
        "drift_unexplained": "yes" if judgement.excess.left else "no",
        "steps_listed": len(judgement.steps),
    }
    if "vn200" in path.parent.name:
        row["flip"] = flip(analysis.sessions[0], float(analysis.floor_dps[2]))
    if plots:
        from .plots import draw_recording

        draw_recording(analysis, cubic_left(analysis), path.name, plots / f"{out.stem}.png")
    return row


def cubic(analysis) -> list | None:
    """The terms of a cubic over temperature; None without temperature."""
    line = analysis.selection.straight
    return [replace(line[0], power=k) for k in (1, 2, 3)] if line else None


def cubic_left(analysis) -> list[NDArray[np.float64]] | None:
    """(n, 3) dps that a cubic leaves of each locked part by the same pieces, or fitted on the same
    power-ons, held at the edges of what it was fitted to; NaN where unscored.
    """
    from ...loop.fit.line import ordinary
    from ...loop.fit.regression import predicted
    from ...loop.fit.single import PiecesByLine, held
    from ...loop.verify.judge import scored

    terms = cubic(analysis)
    if terms is None:
        return None
    if analysis.single:
        return [PiecesByLine(analysis.sessions[0]).residual([], terms)]
    terms = [held(t, analysis.train) for t in terms]
    fitted = ordinary(terms, analysis.train)
    return [scored(s, predicted(terms, fitted, s))[0] for s in analysis.locked]


def _rms(parts: list[NDArray[np.float64]]) -> float:
    rows = np.vstack(parts)
    return rms_mdps(rows[np.isfinite(rows).all(axis=1)])
