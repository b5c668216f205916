"""How much heap each part needs, as `zerorate bench boards` measured it on an emulated Pico."""

from __future__ import annotations

import json
from collections.abc import Iterable
from importlib.resources import files

_TABLE = "needs.json"


def needs() -> dict[str, dict[str, int]]:
    """`native` and `bytecode` -> part -> bytes of heap, `rest` with driver and Corrector."""
    return json.loads(files(__package__).joinpath(_TABLE).read_text(encoding="utf-8"))


def heap_needed(parts: Iterable[str], architecture: str) -> int:
    """Bytes of heap that a program with these parts needs on a board of that architecture."""
    kind = "native" if has_native(architecture) else "bytecode"
    table = needs()[kind]
    return sum(table.get(part, 0) for part in parts)


def has_native(architecture: str) -> bool:
    """Whether the packages bring machine code for it."""
    return False
