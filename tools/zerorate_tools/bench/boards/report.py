"""The figures of an emulated Pico as Markdown."""

from collections.abc import Mapping
from typing import Any

from ..limits import limits_table, verdicts
from ..tables import number, table
from .measuring import LIMITS


def in_markdown(found: Mapping[str, Any]) -> str:
    """What it must be, heap by part, and the modes that gave equal numbers."""
    heap = table(["with", "heap, bytes"], [[k, number(v)] for k, v in found["heap_bytes"].items()])
    modes = [[mode, "yes" if equal else "**no**"] for mode, equal in found["golden"].items()]
    same = table(["mode", "to the last bit as on the host"], modes)
    head = f"# {found['board']}\n\nEmulated, with {found['firmware']}.\n"
    return "\n".join([head, limits_table(verdicts(found, LIMITS)), heap, same])
