"""The loop on real recordings: before, after, the floor, and a cubic over temperature beside."""

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np

#: Files, and the rows a second of those that carry no time stamps.
RECORDINGS = (
    ("lsm6ds3-hubs/RB.csv", None),
    ("lsm6ds3-hubs/RX.csv", 1 / 15),
    ("lsm6ds3-hubs/TH.csv", 1 / 15),
    ("gy521-cooldown/cooldown.csv.gz", None),
    ("vn200-flip/static_z-_z+_IMU0.csv.gz", 50.0),
    ("vn200-flip/static_z-_z+_IMU1.csv.gz", 50.0),
    ("mpu6050-unmoved/set-2_unmoved-with-x-pointing-forward-10min.csv.gz", None),
    ("adis16405-static/adis_16405_imu1.parquet", 100.0),
    ("adis16405-static/adis_16405_imu2.parquet", 100.0),
)
_EARTH_MDPS = 4.178
_G_DPS = 180 / np.pi


def real_rows(data: Path) -> dict:
    """Name -> figures in mdps (RMS over the axes, held out) and what was found."""
    rows = {}
    with tempfile.TemporaryDirectory() as scratch:
        for name, hz in RECORDINGS:
            if (data / name).exists():
                rows[Path(name).name] = _recording(data / name, hz, Path(scratch))
    for path in sorted((data / "hipnuc-bins").glob("*.log")):
        rows[path.name] = hipnuc(path)
    return rows


def _recording(path, hz, scratch):
    from ..importers.conversion import Options
    from ..importers.importing import import_recording
    from ..loop.close import load
    from ..loop.confounding import label

    out = scratch / f"{path.parent.name}-{path.name.split('.')[0]}.parquet"
    import_recording(path, out, options=Options(hz=hz) if hz else None)
    analysis = load([out])
    judgement, found = analysis.judgement, analysis.selection.found
    row = {
        "floor_mdps": _mdps(analysis.floor_dps),
        "before_mdps": _mdps(judgement.before_dps),
        "after_mdps": _mdps(judgement.after_dps),
        "cubic_mdps": cubic(analysis),
        "found": ", ".join(f"{label(f.candidate)} (tentative)" for f in found) or "nothing",
        "confounded_with": "; ".join(", ".join(f.confounded_with) for f in found),
        "excess_left": bool(judgement.excess.left),
        "steps_listed": len(judgement.steps),
    }
    if "vn200" in path.parent.name:
        row["flip"] = flip(analysis.sessions[0])
    return row


def cubic(analysis) -> float | None:
    """mdps of a cubic over temperature fitted on the same training part, held at its range."""
    from dataclasses import replace

    from ..loop.judge import scored
    from ..loop.line import ordinary
    from ..loop.regression import predicted

    if not analysis.selection.straight:
        return None
    train = analysis.selection.regression.sessions
    seen = np.concatenate([s.block_mean(s.sources["temp"])[s.available] for s in train])
    line = replace(analysis.selection.straight[0], lo=float(seen.min()), hi=float(seen.max()))
    terms = [replace(line, power=k) for k in (1, 2, 3)]
    fit = ordinary(terms, train)
    fitted = {s.name: s for s in train}
    left = [scored(s, predicted(terms, fit, s), fitted.get(s.name))[0] for s in analysis.locked]
    return _mdps(np.sqrt(np.nanmean(np.vstack(left) ** 2, axis=0)))


def flip(session) -> str:
    """What turning the part over did to its z rate, beside what Earth's rotation can do."""
    up = session.block_mean(session.sources["acc_z"]) > 0
    rate = session.rate_dps[:, 2]
    there = session.available
    if not (up & there).any() or not (~up & there).any():
        return "not turned over"
    change = 1e3 * (rate[up & there].mean() - rate[~up & there].mean())
    earth = 2 * _EARTH_MDPS
    if abs(change) < earth:
        verdict = "Earth's rotation alone can do it: not told apart"
    else:
        verdict = (
            f"at least {abs(change) - earth:.1f} mdps are not Earth's; one flip, so not confirmed"
        )
    return f"{change:+.1f} mdps over a turn, of which Earth's rate may be {earth:.1f}: {verdict}"


def hipnuc(path: Path) -> dict:
    """Curvature of a chip's table: order chosen on every second bin, judged on the others."""
    temp, count, rate = _bins(path)
    even = np.arange(len(temp)) % 2 == 0
    train = (temp[even], count[even], rate[even])
    order = max(range(1, 6), key=lambda k: _left_out_gain(train, k))
    row = {
        f"order {k}": _held_out(train, temp[~even], count[~even], rate[~even], k)
        for k in (1, 3, order)
    }
    return {
        "before_mdps": row["order 1"],
        "after_mdps": row[f"order {order}"],
        "cubic_mdps": row["order 3"],
        "found": f"temperature polynomial of order {order}" if order > 1 else "nothing",
    }


def _bins(path):
    rows = []
    for text in path.read_text().splitlines():
        if text.startswith("BIN_DATA:"):
            rows.append([float(v) for v in text.split(":")[1].split(",")])
    width = 10 if "unitB" in path.name else 11
    table = np.array([r for r in rows if len(r) >= width - 1])
    first = 6 + (width == 11)
    keep = table[:, 2] > 100  # a bin of one sample says nothing
    return table[keep, 1], table[keep, 2], table[keep, first : first + 3] * _G_DPS


def _design(temp, order, centre, span):
    return np.vander((temp - centre) / span, order + 1)


def _fit(temp, count, rate, order):
    centre, span = temp.mean(), np.ptp(temp)
    w = np.sqrt(count / count.mean())[:, None]
    x = _design(temp, order, centre, span)
    return np.linalg.lstsq(w * x, w * rate, rcond=None)[0], centre, span


def _held_out(train, temp, count, rate, order):
    fit, centre, span = _fit(*train, order)
    left = rate - _design(temp, order, centre, span) @ fit
    inside = (temp >= train[0].min()) & (temp <= train[0].max())
    return _mdps(np.sqrt((left[inside] ** 2).mean(axis=0)))


def _left_out_gain(train, order):
    """Minus the logarithm of the error on bins left out one at a time, orders paying a little."""
    temp, count, rate = train
    squares = []
    for i in range(1, len(temp) - 1):
        keep = np.arange(len(temp)) != i
        fit, centre, span = _fit(temp[keep], count[keep], rate[keep], order)
        squares.append((rate[i] - _design(temp[i : i + 1], order, centre, span) @ fit)[0] ** 2)
    return -len(temp) / 2 * np.log(np.sum(squares)) - order


def _mdps(values) -> float:
    return round(1e3 * float(np.sqrt(np.mean(np.square(values)))), 2)
