"""`zerorate bench cost`: what a sample costs, and what a replay does."""

from collections.abc import Callable
from typing import Any

from ..errors import MissingRuntime
from .limits import COST, verdicts
from .memory import heap_bytes_per_update, import_heap_bytes, mpy_sizes, state_bytes
from .native_cost import code_bytes, effects_cost, native_cost
from .replay_speed import HOURS, replay_speed
from .tables import machine
from .workload import Workload, workload

STEPS = 6


def cost(advance: Callable[[float], None] = lambda n: None, hours=HOURS) -> dict[str, Any]:
    """All figures; what cannot be measured here is None, and `left_out` says why."""
    work = workload()
    left_out: dict[str, str] = {}
    found: dict[str, Any] = {"machine": machine()}
    for name, measure in _measures(work, hours).items():
        try:
            found[name] = measure()
        except MissingRuntime as missing:
            found[name], left_out[name] = None, str(missing)
        advance(1)
    heap, replay = found["heap_bytes_per_update_by_interpreter"], found["replay_by_hours"]
    found["heap_bytes_per_update"] = max(heap.values()) if heap else None
    found["state_bytes_by_array"] = state_bytes()
    found["state_bytes"] = found["state_bytes_by_array"]["state"]
    found["replay_samples_per_s"] = min(one["samples_per_s"] for one in replay.values())
    found["left_out"] = left_out
    found["limits"] = [verdict.to_json() for verdict in verdicts(found, COST)]
    return found


def _measures(work: Workload, hours) -> dict[str, Callable[[], Any]]:
    return {
        "heap_bytes_per_update_by_interpreter": lambda: heap_bytes_per_update(work),
        "native": lambda: native_cost(work),
        "effects": effects_cost,
        "code_bytes": code_bytes,
        "import_heap_bytes": import_heap_bytes,
        "mpy_bytes": mpy_sizes,
        "replay_by_hours": lambda: replay_speed(hours),
    }
