"""Every fault of a bus and every cut of a write, injected: what was detected, what was learned."""

from __future__ import annotations

import json
from os import PathLike
from pathlib import Path

from ..recordings.atomic import written_beside
from .bus_faults import FAULTS, run_fault
from .store_faults import run_store


def run(json_path: str | PathLike[str] | None = None) -> dict:
    """Inject everything, print both tables and return them; with json_path write them too.

    faults: name -> injected, detected, learned_from (false samples that what was learned holds),
    false_samples (those that the driver handed out as good). store: cuts, flips, wrong_loads,
    exceptions.
    """
    found = {"faults": {name: run_fault(name) for name in FAULTS}, "store": run_store()}
    print(table(found))
    if json_path is not None:
        with written_beside(Path(json_path)) as temporary:
            temporary.write_text(json.dumps(found, indent=2) + "\n")
    return found


def passed(found: dict) -> bool:
    """Every fault detected and nothing learned from any, no wrong load and no exception."""
    store = found["store"]
    return (
        all(
            row["injected"] > 0 and row["detected"] == row["injected"] and row["learned_from"] == 0
            for row in found["faults"].values()
        )
        and store["cuts"] > 0
        and store["flips"] > 0
        and store["wrong_loads"] == store["exceptions"] == 0
    )


def table(found: dict) -> str:
    """Both tables as text."""
    lines = [
        f"{'fault':<28}{'injected':>9}{'detected':>9}{'learned from':>13}{'false handed out':>17}"
    ]
    for name, row in found["faults"].items():
        lines.append(
            f"{name:<28}{row['injected']:>9}{row['detected']:>9}"
            f"{row['learned_from']:>13}{row['false_samples']:>17}"
        )
    lines += ["", f"{'store':<28}{'cuts':>9}{'flips':>9}{'wrong loads':>13}{'exceptions':>17}"]
    store = found["store"]
    lines.append(
        f"{store['bytes']} bytes a slot".ljust(28) + f"{store['cuts']:>9}{store['flips']:>9}"
        f"{store['wrong_loads']:>13}{store['exceptions']:>17}"
    )
    return "\n".join(lines)
