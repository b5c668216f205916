"""Every fault of a bus and every cut of a write, injected: what was detected, what was learned."""

from .bus_faults import FAULTS, run_fault
from .store_faults import run_store


def run() -> dict:
    """Inject everything and return both tables.

    faults: name -> injected, detected, learned_from (false samples that what was learned holds),
    false_samples (those that the driver handed out as good). store: cuts, flips, wrong_loads,
    exceptions.
    """
    return {"faults": {name: run_fault(name) for name in FAULTS}, "store": run_store()}


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
