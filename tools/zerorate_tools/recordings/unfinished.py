"""Names of recordings that are not finished: of run.parquet run.partial.csv, run.partial-2.csv."""

import re
from collections.abc import Iterator
from glob import escape
from itertools import count
from pathlib import Path

_ENDING = re.compile(r"(\.partial(-[0-9]+)?)?(\.csv|\.csv\.gz|\.parquet)$")
_UNFINISHED = re.compile(r"\.partial(-[0-9]+)?\.csv$")


def is_unfinished(path: Path) -> bool:
    """Whether the name is one of a recording that is not finished."""
    return _UNFINISHED.search(path.name) is not None


def stem(path: Path) -> str:
    """run, of run.parquet as of run.partial.csv."""
    return _ENDING.sub("", path.name)


def names_for(out: Path) -> Iterator[Path]:
    """Names for a recording that becomes `out`, until one is free."""
    for number in count(1):
        yield out.with_name(f"{stem(out)}.partial{f'-{number}' if number > 1 else ''}.csv")


def unfinished_of(out: Path) -> list[Path]:
    """What there is of `out` that is not finished, the newest last."""
    found = out.parent.glob(f"{escape(stem(out))}.partial*.csv")
    mine = [path for path in found if is_unfinished(path) and stem(path) == stem(out)]
    return sorted(mine, key=lambda path: path.stat().st_mtime_ns)
