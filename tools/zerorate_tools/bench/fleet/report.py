"""The bench's figures as Markdown."""

from typing import Any

from ...fleet.fleet_in_words import WAYS, scenario_in_words
from ..tables import machine_line, table


def in_markdown(found: dict[str, Any]) -> str:
    """Scaling, the prior's worth, and a million devices."""
    length = (
        f"Each device has one recording of {found['minutes']:g} minutes at {found['odr_hz']:g} Hz "
        f"({found['bytes_per_recording'] / 1e3:.0f} kB of Parquet), simulated; `seconds` are those "
        "of the replays, without the cluster's start and the report at the end."
    )
    parts = ["# Fleet", machine_line(), "## Scaling", length, _scaling(found["scaling"])]
    parts += ["## A prior for a new device", _about(found["prior"]), _prior(found["prior"])]
    parts += ["## A million devices, on paper", _million(found["million"])]
    return "\n\n".join(part.strip() for part in parts) + "\n"


def _scaling(rows: list[dict[str, float]]) -> str:
    header = (
        *("devices", "workers", "tasks", "devices a task", "seconds", "devices/s"),
        *("million samples/s", "CPU ms a device", "idle or overhead", "peak MB a worker"),
        *("start s", "report and prior s"),
    )
    cells = [
        (
            *(f"{r['devices']:g}", f"{r['workers']:g}", f"{r['tasks']:g}"),
            *(f"{r['devices'] / r['tasks']:.1f}", f"{r['seconds']:.1f}"),
            *(f"{r['devices_per_s']:.1f}", f"{r['samples_per_s'] / 1e6:.2f}"),
            *(f"{1e3 * r['cpu_s'] / r['devices']:.1f}", f"{r['overhead_share']:.1%}"),
            *(f"{r['peak_bytes'] / 1e6:.0f}", f"{r['start_s']:.1f}", f"{r['conclude_s']:.1f}"),
        )
        for r in rows
    ]
    return table(header, cells)


def _about(tried: dict[str, Any]) -> str:
    return (
        f"Error of the firmware's bias in the first {tried['minutes']:g} minutes of "
        f"{tried['devices']} devices, each left out of the prior that it starts from "
        f"({tried['folds']} priors, each from the other four fifths of the fleet): RMS over axes "
        "in mdps, median over devices and 95th percentile."
    )


def _prior(tried: dict[str, Any]) -> str:
    rows = []
    for name, found in tried["scenarios"].items():
        for way, words in WAYS.items():
            if way in found:
                median, p95 = found[way]["median_mdps"], found[way]["p95_mdps"]
                rows.append((scenario_in_words(name), words, f"{median:.4g}", f"{p95:.4g}"))
        gain, (low, high) = found["gain"]["median_mdps"], found["gain"]["ci95_mdps"]
        better = f"{gain:.4g} ({low:.4g} to {high:.4g})"
        rows.append(("", "gain by the prior, 95 %", better, f"{found['gain']['share_better']:.0%}"))
    header = ("device", "start", "median", "95th percentile (of gain: share better)")
    return table(header, rows)


def _million(m: dict[str, Any]) -> str:
    return (
        f"{m['devices']:,} devices with {m['hours_a_device']:g} hour each at {m['odr_hz']:g} Hz "
        f"take {m['cpu_s_a_device']:.2f} s of a core each: on {m['cores']} cores {m['hours']:.1f} "
        f"hours. The recordings are {m['recordings_bytes'] / 1e12:.2f} TB of Parquet, the results "
        f"{m['results_bytes'] / 1e9:.1f} GB. A task takes up to {m['devices_per_task']} devices or "
        f"64 MiB, so there are {m['tasks']:,} tasks of {m['seconds_a_task']:.0f} s, "
        f"{m['tasks_per_s']:.2f} a second; Dask's scheduler spends about a millisecond on each, "
        f"{m['scheduler_share']:.2%} of its time, and holds no more than {m['most_waiting']:,} of "
        "them, for the rest waits in the client. One task a device would be "
        f"{m['devices']:,} tasks, {m['devices'] * 1e-3 / m['hours'] / 3600:.1%} of its time."
    )
