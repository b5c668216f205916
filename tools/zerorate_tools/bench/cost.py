"""`zerorate bench cost`: what a sample costs, and what was promised of it."""

from __future__ import annotations

from collections.abc import Callable, Mapping

from ..errors import MissingRuntime
from .instructions import instructions_per_sample, seconds_per_sample
from .memory import heap_bytes_per_update, import_heap_bytes, mpy_sizes, state_bytes
from .replay_speed import HOURS, replay_speed
from .tables import machine, machine_line, number, table
from .workload import workload
from .worst_sample import worst_against_median

STEPS = 8


def cost(advance: Callable[[float], None] = lambda n: None, hours=HOURS) -> dict:
    """All figures; what cannot be measured here is None, and `left_out` says why."""
    work = workload()
    left_out: dict[str, str] = {}

    def measured(name: str, measure: Callable[[], object]) -> object:
        try:
            return measure()
        except MissingRuntime as missing:
            left_out[name] = str(missing)
            return None
        finally:
            advance(1)

    heap = measured("heap_bytes_per_update", lambda: heap_bytes_per_update(work))
    replay = measured("replay", lambda: replay_speed(hours))
    sizes = state_bytes()
    return {
        "machine": machine(),
        "instructions_per_sample": measured(
            "instructions_per_sample", lambda: instructions_per_sample(work)
        ),
        "armhf_seconds_per_sample": measured(
            "armhf_seconds_per_sample", lambda: seconds_per_sample(work)
        ),
        "worst_sample": measured("worst_sample", lambda: worst_against_median(work)),
        "heap_bytes_per_update": max(heap.values()) if isinstance(heap, dict) else None,
        "heap_bytes_per_update_by_interpreter": heap,
        "state_bytes": sizes["state"],
        "state_bytes_by_array": sizes,
        "import_heap_bytes": measured("import_heap_bytes", import_heap_bytes),
        "mpy_bytes": measured("mpy_bytes", mpy_sizes),
        "replay_samples_per_s": _slowest(replay),
        "replay_by_hours": replay,
        "left_out": left_out,
    }


def _slowest(replay: object) -> float | None:
    if not isinstance(replay, dict):
        return None
    return min(figures["samples_per_s"] for figures in replay.values())


def in_markdown(found: Mapping) -> str:
    """The tables of `cost`."""
    parts = ["# Cost\n", machine_line(), *_promises(found), *_sizes(found), *_replay(found)]
    parts += [f"Left out: {name}: {why}.\n" for name, why in found["left_out"].items()]
    return "\n".join(parts)


def _promises(found: Mapping) -> list[str]:
    rows: list[list[str]] = []
    for name, title in (
        ("instructions_per_sample", "instructions a sample, x86"),
        ("armhf_seconds_per_sample", "time a sample under qemu-arm, against C"),
    ):
        if figures := found[name]:
            unit = figures["c"] if name.startswith("armhf") else 1
            kinds = ("bytecode", "viper", "c")
            rows.append([title, "; ".join(f"{k} {figures[k] / unit:,.1f}" for k in kinds), ""])
    if figures := found["instructions_per_sample"]:
        rows.append(["viper against C", f"{figures['viper'] / figures['c']:.1f} x", "at most 4 x"])
        fewer = figures["bytecode"] / figures["viper"]
        rows.append(["viper against bytecode", f"{fewer:.1f} x fewer", "at least 15 x"])
    if worst := found["worst_sample"]:
        rows.append(["worst sample against median", f"{worst['ratio']:.1f} x", "at most 10 x"])
    if (heap := found["heap_bytes_per_update"]) is not None:
        rows.append(["heap an update", f"{heap:g} bytes", "0 bytes"])
    return [table(["figure", "measured", "promised"], rows)]


def _sizes(found: Mapping) -> list[str]:
    rows = [
        [f"array of {name}", f"{size:,}"] for name, size in found["state_bytes_by_array"].items()
    ]
    if found["import_heap_bytes"] is not None:
        rows.append(["heap of the import, wasm", f"{found['import_heap_bytes']:,}"])
    rows += [[f".mpy, {name}", f"{size:,}"] for name, size in (found["mpy_bytes"] or {}).items()]
    return ["## Sizes\n", table(["what", "bytes"], rows)]


def _replay(found: Mapping) -> list[str]:
    rows = [
        [f"{hours} h", f"{f['samples_per_s']:,.0f}", number(f["peak_bytes"] / 1e6)]
        for hours, f in (found["replay_by_hours"] or {}).items()
    ]
    header = ["at 100 Hz", "samples/s", "peak memory, MB"]
    return ["## Replay on one core, Parquet in and out\n", table(header, rows)]
