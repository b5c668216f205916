"""How much heap each part needs, as `zerorate bench boards` measured it on an emulated Pico."""

import json
from collections.abc import Iterable
from importlib.resources import files

BOTH = "motion, gravity"
_PARTS_OF_BOTH = frozenset(BOTH.split(", "))
_TABLE = "needs.json"


def needs() -> dict[str, dict[str, int]]:
    """`native`, `bytecode` -> part -> heap, `rest` with driver and Corrector; `cycles`, `heap`.

    BOTH stands for the two parts of its name, which share some of what each takes alone.
    """
    return json.loads(files(__package__).joinpath(_TABLE).read_text(encoding="utf-8"))


def heap_needed(parts: Iterable[str], code: str) -> int:
    """Bytes of heap that these parts take with that kind of machine code, "" for bytecode."""
    table = needs()["native" if code else "bytecode"]
    parts = set(parts)
    if BOTH in table and parts.issuperset(_PARTS_OF_BOTH):
        parts = parts.difference(_PARTS_OF_BOTH) | {BOTH}
    return sum(table.get(part, 0) for part in parts)
