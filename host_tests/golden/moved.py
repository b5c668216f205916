"""What motion shows, step by step: recordings as motion is read, columns, rows, fits, devices."""

import re
from dataclasses import asdict, replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pyarrow.parquet as pq
from zerorate_tools.closing import motion_in_words, write_in_motion
from zerorate_tools.loop.motion.by_windows import by_windows
from zerorate_tools.loop.motion.columns import OWN, columns_of
from zerorate_tools.loop.motion.device import Shown, device_of, distance
from zerorate_tools.loop.motion.heading import heading_lost
from zerorate_tools.loop.motion.matrix import beside
from zerorate_tools.loop.motion.moving import moving_of
from zerorate_tools.loop.motion.scales_and_timing import timing_of
from zerorate_tools.loop.motion.windows import rows_of
from zerorate_tools.recordings import write_recording
from zerorate_tools.simulate import simulate_sessions

from host_tests.loop.test_axes_by_gravity import handled

_MATRIX = np.array([[0.012, 0.001, 0.003], [-0.002, -0.009, 0.0], [0.003, 0.0, 0.006]])
#: Turns between rests, so that gravity before and after each tells, too.
_TURNS = [
    bout
    for face in ("+x", "-y", "-z", "+y", "+z")
    for bout in (
        {"kind": "rest", "s": 9},
        {"kind": "turn", "axis": "random", "deg": 100, "s": 3},
        {"kind": "pose", "face": face, "s": 3},
        {"kind": "rest", "s": 9},
        {"kind": "hand", "s": 12},
    )
]
_RESTING = {
    **{"seed": 5, "sensor": {"odr_hz": 25.0}, "session": [{}]},
    "every_session": {"minutes": 3, "motion": _TURNS},
    "effect": [{"kind": "scale", "dps": [0.01, -0.02, 0.015]}],
}


def _recordings():
    """In the hand, without and with an attitude that is not seen for a while; and between rests."""
    seen = handled(2, _MATRIX, minutes=1.5, seen=True)
    lost = np.abs(np.arange(len(seen.columns["qw"])) - 300) < 20
    for name in ("qw", "qx", "qy", "qz"):
        seen.columns[name] = np.where(lost, 0, seen.columns[name])
    late = handled(3, _MATRIX, minutes=1.2, about=(1.0, 0.7, 0.2))
    late.columns["t_us"][2000:] += 4_000_000
    late.columns["gx"][900:903] = 32767
    resting, _ = next(iter(simulate_sessions(_RESTING)))
    return [late, seen, resting, handled(4, np.zeros((3, 3)), minutes=1.0)]


def _steps(moving):
    """Of one recording: what is read, what each error does to it, its windows and their fit."""
    own = np.linspace(-1e-3, 2e-3, sum(OWN.values()))
    columns = columns_of(moving, _MATRIX / 2, own)
    rows, fitted = rows_of(moving, 10.0, _MATRIX / 2, own), beside(moving, _MATRIX / 2)
    seen, added = columns.of(np.arange(150, 300))
    names = ("name", "rate", "accel", "at_s", "usable", "still", "offset", "rests", "given", "dt_s")
    read = {name: getattr(moving, name) for name in (*names, "mounted")}
    found = {"moving": read, "columns": columns.__dict__, "rows": rows.__dict__}
    found["of"] = {"seen": seen, "added": added, "spans": [s.start for s in moving.spans(10.0)]}
    names = ("own", "precision", "noise", "likely", "folds", "heading", "doubt")
    found["fitted"] = {n: getattr(fitted, n) for n in names}
    shown, without = fitted.shown(_MATRIX / 2), fitted.without(_MATRIX / 2, 1)
    found["shown"] = {"normal": shown.normal, "right": shown.right, "without": without.normal}
    for name, fold in (("tilts", 2), ("every tilt", None)):
        found["shown"][name] = fitted.tilts(0.1 * own[:9] - _MATRIX.ravel() / 2, fold)
    found["shown"]["nats"] = fitted.nats(0.1 * own[:9], 2)
    found["is"] = {"dt_s": moving.dt_s, "planar": moving.planar, "apart": distance(shown, without)}
    return found, fitted


def _written(paths, shown):
    """What recordings that hardly rest are closed with: the report, its words, its columns."""
    result = write_in_motion(shown, paths, None, paths[0].parent, lambda n: None)
    columns = pq.read_table(paths[0].parent / "corrected.parquet").to_pandas()
    numbers = columns.select_dtypes("number").to_dict("list")
    words = [re.findall(r"-?\d+\.\d+", motion_in_words(result))]
    return {
        "report": result,
        "words": words,
        "rows": {**numbers, "test": columns["split"] == "test"},
    }


def _moving(folder):
    """The recordings' paths, and they as their motion is read."""
    paths = [Path(folder, f"{n}.parquet") for n in range(4)]
    for path, recording in zip(paths, _recordings()):
        write_recording(replace(recording, name=path.stem), path)
    return paths, [moving_of(path) for path in paths]


def _figures(parts):
    """{figure: numbers, or a word} of (name, fields)."""
    every = {f"{name} {key}".strip(): of for name, fields in parts for key, of in fields.items()}
    every = {n: [*of.values()] if isinstance(of, dict) else of for n, of in every.items()}
    every = {name: of for name, of in every.items() if of is not None and np.size(of)}
    return {n: of if isinstance(of, str) else np.nan_to_num(of) for n, of in every.items()}


def moved():
    """Of each recording, and of the device that so little as a part of them tells."""
    with TemporaryDirectory() as folder:
        _, every = _moving(folder)
    parts, statements, headings = [], [], []
    for number, moving in enumerate(every[:3]):
        steps, fitted = _steps(moving)
        parts += [(f"{number} {name}", of) for name, of in steps.items()]
        shown = fitted.shown(_MATRIX)  # of so little that neither scatter nor size is sure
        statements.append(Shown(3e-6 * shown.normal, 3e-6 * shown.right))
        headings.append(fitted.heading)
    for large in (False, True):
        device = device_of(statements, large)
        names = ("entries", "covariance", "nats", "weight")
        parts.append((f"device {large}", {n: getattr(device, n) for n in names}))
        parts.append((f"deployed {large}", {"": device.kept(headings) @ device.entries}))
    rng = np.random.default_rng(1)
    late = [
        (np.column_stack([-0.003 * w + rng.normal(0, 0.02, 400), w]), 1.0)
        for w in rng.random((2, 400))
    ]
    return _figures([*parts, ("timing", asdict(timing_of(late)))])


def moved_together():
    """Of what the recordings show together, and what they are closed with."""
    with TemporaryDirectory() as folder:
        paths, every = _moving(folder)
        alone = by_windows(every[1:2], [])
        written = _written(paths[:2], alone)
    parts = [("held", asdict(by_windows(every[:2], every[2:]))), ("alone", asdict(alone))]
    parts.append(("none", asdict(by_windows(every[3:], []))))
    parts.append(("heading", {"": heading_lost([(every[1], _MATRIX), (every[0], _MATRIX)])}))
    return _figures(parts), written
