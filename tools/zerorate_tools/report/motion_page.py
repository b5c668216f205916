"""report.html of recordings in motion: before, after, and a picture of the matrix."""

from collections.abc import Mapping
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
    targets = targets_of(before, after, np.array(m["ci95_percent"]) / 100)
    widest = max(
        [_LEAST_DEG, *(s for t in targets for r in t.readings for s in _spans(r, _is_seen(m)))]
    )
    ring = max(r for r in _RINGS_DEG if r <= max(widest, _RINGS_DEG[0]))
    return rendered(
        "motion.html.j2",
        [],
        r=result,
        m=m,
        effect=result["effects"][0] if result["effects"] else None,
        targets=targets,
        ring=ring,
        scale=_EDGE / (1.15 * widest),
        turn_scale=_EDGE / (1.15 * max(_turn_span(targets, _is_seen(m)), _LEAST_DEG)),
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


def _is_seen(m: Mapping[str, Any]) -> float:
    """Degrees of an interval that is drawn whole: what was not seen runs over the edge."""
    ci = np.array(m["ci95_percent"]) / 100
    return float(np.degrees(2 * np.median(ci)))


def _spans(reading: Reading, whole_deg: float) -> list[float]:
    pairs = [(reading.right, reading.right_ci), (reading.up, reading.up_ci)]
    return [abs(v) + min(c, whole_deg) for v, c in pairs]


def _turn_span(targets: tuple[Target, ...], whole_deg: float) -> float:
    whole = np.radians(whole_deg) * _TURN_DEG
    return max(abs(r.turn - _TURN_DEG) + min(r.turn_ci, whole) for t in targets for r in t.readings)
