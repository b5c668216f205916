"""Heading lost in motion on BROAD, without and with the matrix that gravity showed.

VQF runs with its own bias estimation off. The bias is that of the first rest. The heading error is
against the optics, over the motion, after a constant turn between their frame and the sensor's.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation
from zerorate_tools.demo.broad import Trial, trials
from zerorate_tools.loop.motion.by_windows import RateScale, by_windows
from zerorate_tools.loop.motion.device import DifferentDevices, Shown, distance
from zerorate_tools.loop.motion.matrix import beside, fit
from zerorate_tools.loop.motion.moving import Moving, in_the_axes_of, moving_of
from zerorate_tools.recordings.writing import write_recording

from .tables import measured, table

Array = NDArray[np.float64]
_G = 9.80665
_EVERY = 10
_OPTICS = """\
The distance is a chi-squared of nine degrees of freedom, between the matrix of the trial and that
of the other trials named, all fitted with the optics."""
_BESIDE = {
    "own": "after, fitted on its first half and its optics",
    "optics": "after, fitted on other trials and their optics",
    "others": "after, fitted on other trials",
    "bound": "after, fitted by the optics on what is judged",
}
#: Two sets of axes: trials whose matrices agree with each other, and not with the other set's.
GROUPS = (("01", "02", "06", "12", "16", "24"), ("21", "29", "30"))
LIMITS = (0.7, 2.5)


def run(data: list[Path]) -> dict[str, Any]:
    """Trial -> degrees before and after, fitted on the other trials of its group and on its own
    first half; and whether both groups together are refused. Raises ZerorateError."""
    every = {t.name[:2]: t for folder in data for t in trials(folder)}
    moving = moving_in(every)
    found: dict[str, Any] = {"others": {}, "halves": {}, **_refused(list(moving.values()))}
    seen = {n: _seen(t, moving[n]) for n, t in every.items()}
    found["optics"] = _by_optics(seen, found["refused"])
    known = [(k, n) for k, group in enumerate(GROUPS) for n in group if n in every]
    for number, name in measured(known):
        others = sorted(others_of(name, every))
        shown, optics = (
            by_windows([of[n] for n in others], []) if others else None for of in (moving, seen)
        )
        optics_too = _row(every[name], number, optics)["after"]
        found["others"][name] = _row(every[name], number, shown) | {"optics": optics_too}
        half = _half(every[name], moving[name], number)
        found["halves"][name] = half | {"others": _row(every[name], number, shown, 0.5)["after"]}
    return found


def others_of(name: str, every: Mapping[str, object]) -> list[str]:
    """The other trials of a trial's group, by the first two letters of their names."""
    group = next((g for g in GROUPS if name[:2] in g), ())
    return [n for n in every if n != name and n[:2] in group]


def moving_in(every: Mapping[str, Trial]) -> dict[str, Moving]:
    """What each trial's motion shows."""
    found = {}
    with TemporaryDirectory() as scratch:
        for name, trial in every.items():
            path, recording = Path(scratch) / f"{name}.parquet", trial.recording()
            scales = replace(recording.scales, temp_lsb_per_degc=None, temp_offset_degc=None)
            write_recording(replace(recording, scales=scales), path)
            moving = moving_of(path)
            assert moving is not None, "a trial moves"
            found[name] = moving
    return found


def _refused(moving: list[Moving]) -> dict[str, list[Any]]:
    """Both groups, and those that could also be with the others."""
    try:
        by_windows(moving, [])
    except DifferentDevices as problem:
        return {"refused": [*map(sorted, problem.groups)], "unsure": sorted(problem.unsure)}
    return {"refused": [], "unsure": []}


def _seen(trial: Trial, moving: Moving) -> Moving:
    """The trial as the optics saw it."""
    return replace(moving, given=in_the_axes_of(moving, trial.attitude), mounted=True)


def _by_optics(seen: dict[str, Moving], groups: Sequence[Sequence[str]]) -> dict[str, list[float]]:
    """Trial -> chi-squared, of 9 degrees of freedom, of its matrix by the optics being that of the
    other trials of each group."""
    fitted = {name: beside(one, np.zeros((3, 3))) for name, one in seen.items()}
    said = {n: Shown() if f is None else f.shown(np.zeros((3, 3))) for n, f in fitted.items()}
    return {
        name: [
            distance(one, sum((said[n] for n in group if n != name), Shown())) for group in groups
        ]
        for name, one in sorted(said.items())
    }


def _row(trial: Trial, group: int, shown: RateScale | None, first: float = 0.0) -> dict[str, Any]:
    """Degrees RMS, over the motion from a share of it on; as deployed: only what was found."""
    matrix = shown.deployed if shown is not None and shown.found else np.zeros((3, 3))
    before, after = (heading_error_deg(trial, m, first) for m in (np.zeros((3, 3)), matrix))
    return {"group": group, "before": before, "after": after, "found": bool(matrix.any())}


def _half(trial: Trial, moving: Moving, group: int) -> dict[str, Any]:
    """Fitted on the first half of the motion, judged on the second; beside that what the optics
    alone, fitted to that second half itself, would leave: no matrix leaves much less."""
    at = np.flatnonzero(trial.moving)
    middle = int((at[0] + at[-1]) / 2)
    first, second = slice(middle), slice(middle, None)
    seen = _seen(trial, moving)
    bound = heading_error_deg(trial, fit([seen.part(second)])[0], 0.5)
    shown, own = (_row(trial, group, by_windows([m.part(first)], []), 0.5) for m in (moving, seen))
    return {**shown, "own": own["after"], "bound": bound}


def heading_error_deg(trial: Trial, matrix: Array, first: float = 0.0) -> float:
    """RMS heading error of VQF fed `(1 - matrix)(rate - bias of the first rest)`.

    first: the share of the motion before which nothing counts.
    """
    from vqf import VQF

    at = np.flatnonzero(trial.moving)
    rest = slice(round(0.5 * trial.hz), at[0] - round(0.5 * trial.hz))
    rate = np.radians(trial.rate_dps - trial.rate_dps[rest].mean(axis=0))
    vqf = VQF(1.0 / trial.hz, motionBiasEstEnabled=False, restBiasEstEnabled=False)
    accel = np.ascontiguousarray(trial.accel_g * _G)
    attitude = vqf.updateBatch(np.ascontiguousarray(rate - rate @ matrix.T), accel)["quat6D"]
    seen = np.isfinite(trial.attitude).all(axis=1) & trial.moving
    seen[: at[0] + round(first * (at[-1] - at[0]))] = False
    use = np.flatnonzero(seen)[::_EVERY]
    order = [1, 2, 3, 0]
    ours, optical = (Rotation.from_quat(q[use][:, order]) for q in (attitude, trial.attitude))
    left = _heading(ours, optical, Rotation.identity())
    for _ in range(8):
        turn = Rotation.from_rotvec(np.outer(left, [0.0, 0.0, 1.0]))
        left = _heading(ours, optical, (ours.inv() * turn * optical).mean())
    return float(np.degrees(np.sqrt(np.mean((left - left[:5].mean()) ** 2))))


def _heading(ours: Rotation, optical: Rotation, frame: Rotation) -> Array:
    q = (ours * frame * optical.inv()).as_quat()
    return 2.0 * np.unwrap(np.arctan2(q[:, 2], q[:, 3]), period=np.pi)


def in_markdown(found: dict[str, Any]) -> str:
    """Both tables, with what the medians must be, and who was told from whom."""
    parts = [
        "# Heading in motion, measured",
        "`zerorate bench heading` wrote this page from trials of BROAD "
        "(D. Laidig et al., CC BY 4.0).",
    ]
    for number, limit in enumerate(LIMITS):
        own = {n: r["after"] for n, r in found["others"].items() if r["group"] == number}
        if own:
            after = list(own.values())
            met = "yes" if np.median(after) <= limit else "NO"
            parts.append(
                f"Group {number + 1}, {', '.join(own)}, each fitted on the others: median "
                f"{np.median(after):.2f} degrees, must be at most {limit}: {met}."
            )
    groups, unsure = [", ".join(group) for group in found["refused"]], ", ".join(found["unsure"])
    either = f"; {unsure} could also be with the others" if unsure else ""
    verdict = f"refused, {' and '.join(groups)}{either}" if groups else "NOT refused"
    parts.append(f"All trials as one device: {verdict}.")
    if found["optics"]:
        heads = ["trial, by the optics", *(f"distance to {group}" for group in groups)]
        rows = [[n, *(f"{d:.0f}" for d in far)] for n, far in found["optics"].items()]
        parts += [table(heads, rows), _OPTICS]
    for key, words in (("others", "other trials"), ("halves", "its first half")):
        heads = ["trial", "deployed", "before, degrees", f"after, fitted on {words}"]
        heads += [words for k, words in _BESIDE.items() if k in next(iter(found[key].values()), {})]
        rows = [
            [name, "yes" if r["found"] else "nothing"]
            + [f"{r[k]:.2f}" for k in ("before", "after", *_BESIDE) if k in r]
            for name, r in found[key].items()
        ]
        parts.append(table(heads, rows))
    return "\n\n".join(parts)
