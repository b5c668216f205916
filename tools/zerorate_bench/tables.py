"""What a bench prints: tables, and what becomes of every case of one that can be taken up again."""

import json
import os
import platform
import re
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, is_dataclass
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any, TypeVar

from threadpoolctl import threadpool_limits
from zerorate_tools.progress import progress

Case = TypeVar("Case")


def table(header: Sequence[str], rows: Sequence[Sequence[object]]) -> str:
    """A Markdown table; numbers after the first column to the right."""
    lines = [header, ["---"] + ["---:"] * (len(header) - 1), *rows]
    return "\n".join("| " + " | ".join(str(cell) for cell in line) + " |" for line in lines) + "\n"


def table_of(rows: Sequence[Mapping[str, object]]) -> str:
    """A Markdown table of rows by the names of their columns; empty where a row has none."""
    keys = list(dict.fromkeys(key for row in rows for key in row))
    return table([k.replace("_", " ") for k in keys], [[r.get(k, "") for k in keys] for r in rows])


def number(value: float) -> str:
    """A figure in three digits or so; a dash where there is none."""
    if value != value:
        return "-"
    return f"{value:.1f}" if abs(value) < 100 else f"{value:,.0f}"


def machine() -> dict[str, str]:
    """Processor and versions."""
    cpuinfo = Path("/proc/cpuinfo")
    text = cpuinfo.read_text("ascii", "replace") if cpuinfo.exists() else ""
    named = re.search(r"model name.*?: *(.*)", text)
    found = {"processor": named[1].strip() if named else platform.machine()}
    found |= {"cores": str(os.cpu_count()), "system": platform.platform()}
    found["python"] = platform.python_version()
    for name in ("zerorate", "numpy", "imufusion", "vqf", "ziglang"):
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            found[name] = "absent"
    return found


def machine_line(found: Mapping[str, str] | None = None) -> str:
    """The same as one line of Markdown."""
    return "Measured with " + ", ".join(f"{k} {v}" for k, v in (found or machine()).items()) + ".\n"


def measured(cases: Collection[Case]) -> Iterator[Case]:
    """Each case in turn; a terminal shows how many are done."""
    with progress("measuring", len(cases)) as advance:
        for case in cases:
            yield case
            advance(1)


def outcomes(
    look: Callable[[Any], Any],
    cases: Sequence[Any],
    processes: int = 1,
    kept: Path | None = None,
) -> Iterator[dict[str, Any]]:
    """What `look` says of each case, in plain values: what a file has first, then the others.

    look: a function of a module, its value a dict or a dataclass; kept: a file of one outcome a
    line, from which a run broken off goes on. Cases that print alike are the same.
    """
    lines = kept.read_text("utf-8").splitlines() if kept and kept.exists() else []
    known = dict(map(json.loads, lines))
    yield from (known[str(c)] for c in cases if str(c) in known)
    left = [c for c in cases if str(c) not in known]
    with ProcessPoolExecutor(processes, initializer=threadpool_limits, initargs=(1,)) as pool:
        for case, said in zip(measured(left), pool.map(look, left)):
            row = asdict(said) if is_dataclass(said) and not isinstance(said, type) else said
            if kept:
                with kept.open("a", encoding="utf-8") as file:
                    file.write(json.dumps([str(case), row]) + "\n")
            yield row
