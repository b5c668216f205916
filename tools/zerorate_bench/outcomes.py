"""What becomes of every case of a bench, which can be broken off and taken up again."""

import json
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, is_dataclass
from pathlib import Path
from typing import Any

from threadpoolctl import threadpool_limits


def outcomes(
    look: Callable[[Any], Any],
    cases: Sequence[Any],
    processes: int = 1,
    kept: Path | None = None,
    advance: Callable[[float], None] = lambda n: None,
) -> Iterator[dict[str, Any]]:
    """What `look` says of each case, in plain values: what a file has first, then the others.

    look: a function of a module, its value a dict or a dataclass; kept: a file of one outcome a
    line, from which a run broken off goes on. Cases that print alike are the same.
    """
    lines = kept.read_text("utf-8").splitlines() if kept and kept.exists() else []
    known = dict(map(json.loads, lines))
    for case in (c for c in cases if str(c) in known):
        advance(1)
        yield known[str(case)]
    left = [c for c in cases if str(c) not in known]
    with ProcessPoolExecutor(processes, initializer=threadpool_limits, initargs=(1,)) as pool:
        for case, said in zip(left, pool.map(look, left)):
            row = asdict(said) if is_dataclass(said) and not isinstance(said, type) else said
            if kept:
                with kept.open("a", encoding="utf-8") as file:
                    file.write(json.dumps([str(case), row]) + "\n")
            advance(1)
            yield row
