"""report.html of recordings in motion: before, after, and a picture of the matrix."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ..model import read_model
from ..model.model_in_words import rate_matrix
from .page import deployment, rendered

_AXES = "xyz"
_TURN_DEG = 360.0
#: From a target's middle to its edge, in the units of its drawing.
_EDGE = 100.0
#: Rings of a target, degrees: the largest that fits is drawn, and half of it.
_RINGS_DEG = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0)
_LEAST_DEG = 0.01


@dataclass(frozen=True)
class Reading:
    """What is read of a turn about an axis: right, up: degrees by which its axis is off, to the
    two other axes; turn, turn_ci: degrees of a full turn; right_ci, up_ci: 95 % intervals."""

    role: str
    right: float
    up: float
    right_ci: float
    up_ci: float
    turn: float
    turn_ci: float


@dataclass(frozen=True)
class Target:
    """One axis: its name, those to the right and up, and its readings, before and after."""

    axis: str
    right: str
    up: str
    readings: tuple[Reading, ...]


def motion_page(result: Mapping[str, Any], folder: Path) -> str:
    """The page's text. result: what report.json holds; folder: where the model is."""
    from ..recordings.atomic import final

    m = result["in_motion"]
    before = np.array(m["matrix_percent"]) / 100
    correction = rate_matrix(read_model(folder / "model.bin"))
    after = None if correction is None else before + correction - np.eye(3)
    ci95 = np.array(m["ci95_percent"]) / 100
    targets = targets_of(before, after, ci95)
    seen = 2 * np.median(ci95)  # an interval that is drawn whole: others run over the edge
    readings = [r for t in targets for r in t.readings]
    axes = [of for r in readings for of in ((r.right, r.right_ci), (r.up, r.up_ci))]
    turns = [(r.turn - _TURN_DEG, r.turn_ci) for r in readings]
    widest = _widest(axes, np.degrees(seen))
    ring = max(r for r in _RINGS_DEG if r <= widest)
    return rendered(
        "motion.html.j2",
        [],
        r=result,
        m=m,
        effect=result["effects"][0] if result["effects"] else None,
        targets=targets,
        ring=ring,
        scale=_EDGE / (1.15 * widest),
        turn_scale=_EDGE / (1.15 * _widest(turns, seen * _TURN_DEG)),
        edge=_EDGE,
        turn=_TURN_DEG,
        board=deployment(final(folder), ()),
    )


def targets_of(
    before: np.ndarray, after: np.ndarray | None, ci95: np.ndarray
) -> tuple[Target, ...]:
    """Three targets. before, after, ci95: (3, 3), the axis that reads by the axis turned; after is
    None where nothing is deployed."""
    ways = [("before", before)] + ([] if after is None else [("after", after)])
    found = []
    for j, axis in enumerate(_AXES):
        right, up = (j + 1) % 3, (j + 2) % 3
        off, off_ci = np.degrees([[m[:, j] for _, m in ways], [ci95[:, j]] * len(ways)]).tolist()
        readings = [
            Reading(
                *(role, at[right], at[up], ci[right], ci[up]),
                turn=_TURN_DEG * (1 + float(m[j, j])),
                turn_ci=_TURN_DEG * float(ci95[j, j]),
            )
            for (role, m), at, ci in zip(ways, off, off_ci)
        ]
        found.append(Target(axis, _AXES[right], _AXES[up], tuple(readings)))
    return tuple(found)


def _widest(drawn: Sequence[tuple[float, float]], whole_deg: float) -> float:
    """How far values and their intervals reach from the middle. whole_deg: of the widest interval
    that counts."""
    return max([_LEAST_DEG, *(abs(value) + min(ci, whole_deg) for value, ci in drawn)])
