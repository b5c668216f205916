"""Markdown tables, and the machine that the figures are from."""

import os
import platform
from collections.abc import Mapping, Sequence
from importlib.metadata import PackageNotFoundError, version


def table(header: Sequence[str], rows: Sequence[Sequence[object]]) -> str:
    """A Markdown table; numbers after the first column to the right."""
    lines = [header, ["---"] + ["---:"] * (len(header) - 1), *rows]
    return "\n".join("| " + " | ".join(str(cell) for cell in line) + " |" for line in lines) + "\n"


def number(value: float) -> str:
    """A figure in three digits or so; a dash where there is none."""
    if value != value:
        return "-"
    return f"{value:.1f}" if abs(value) < 100 else f"{value:,.0f}"


def machine() -> dict[str, str]:
    """Processor and versions."""
    found = {"processor": _processor(), "cores": str(os.cpu_count()), "system": platform.platform()}
    found["python"] = platform.python_version()
    for name in ("zerorate", "numpy", "imufusion", "vqf", "ziglang"):
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            found[name] = "absent"
    return found


def machine_line(found: Mapping[str, str] | None = None) -> str:
    """The same as one line of Markdown."""
    found = machine() if found is None else found
    return "Measured with " + ", ".join(f"{k} {v}" for k, v in found.items()) + ".\n"


def _processor() -> str:
    try:
        with open("/proc/cpuinfo", encoding="ascii", errors="replace") as file:
            names = [line.partition(":")[2].strip() for line in file if "model name" in line]
    except OSError:
        names = []
    return names[0] if names else platform.machine()
