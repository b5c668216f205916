"""report.html of recordings in motion: before, after, and the matrix with its intervals."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from .board import deployment
from .page import rendered

#: Half the width of a bar's track, CSS pixels.
_HALF_PX = 60


def motion_page(result: Mapping[str, Any], folder: Path) -> str:
    """The page's text. result: what report.json holds; folder: where the model is."""
    from ..recordings.atomic import final

    m = result["in_motion"]
    largest = max(
        (abs(v) + c for r, s in zip(m["matrix_percent"], m["ci95_percent"]) for v, c in zip(r, s)),
        default=0.0,
    )
    return rendered(
        "motion.html.j2",
        [],
        r=result,
        m=m,
        effect=result["effects"][0] if result["effects"] else None,
        scale_px=_HALF_PX / max(largest, 1e-6),
        half_px=_HALF_PX,
        board=deployment(final(folder), ()),
    )
