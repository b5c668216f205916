"""Every fault of a bus and every cut of a write, injected: what was detected, what was learned."""

from .bus_faults import FAULTS, run_fault
from .store_faults import run_store
from .tables import table


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


def in_markdown(found: dict) -> str:
    """Both tables."""
    rows = [[name, *row.values()] for name, row in found["faults"].items()]
    store = found["store"]
    counts = [store[name] for name in ("cuts", "flips", "wrong_loads", "exceptions")]
    faults = table(["fault", "injected", "detected", "learned from", "false handed out"], rows)
    head = ["store", "cuts", "flips", "wrong loads", "exceptions"]
    return faults + "\n" + table(head, [[f"{store['bytes']} bytes a slot", *counts]])
