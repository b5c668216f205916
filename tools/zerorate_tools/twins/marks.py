"""What the first line of a kernel says of calls of it."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from .sources import annotated, parsed

# it is written out wherever it is called; it is called in every case
INLINE, CALL = "inline", "call"


def marks(path: Path) -> Iterator[tuple[str, str]]:
    """The kernels whose first line ends with `# inline` or `# call`, and which of them."""
    lines = path.read_text(encoding="utf-8").splitlines()
    for function in annotated(parsed(path)):
        mark = lines[function.lineno - 1].rpartition("# ")[2]
        if mark in (INLINE, CALL):
            yield f"{path.stem}.{function.name}", mark
