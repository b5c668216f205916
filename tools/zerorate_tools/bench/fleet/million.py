"""A million devices on paper, from what one machine's run measured."""

from ...fleet.batches import MOST_BYTES, MOST_DEVICES
from ...fleet.cluster import MOST_WAITING

DEVICES = 1_000_000
HOURS_A_DEVICE = 1.0
CORES = 64
#: Dask's own measure of what its scheduler spends on a task, and keeps of one: about 1 ms (up to
#: 0.2 ms at best) and some kilobytes (distributed documentation, "Scheduling overhead").
SCHEDULER_S_A_TASK = 1e-3


def on_paper(row: dict[str, float], minutes: float, odr_hz: float, size_bytes: float) -> dict:
    """Cores, hours, storage and tasks for a million devices with an hour each at this rate.

    row: of the largest run measured. A device's cost is taken to grow with its samples, which
    overstates it, for opening files does not.
    """
    times = HOURS_A_DEVICE * 60 / minutes
    cpu_s = row["cpu_s"] / row["devices"] * times
    recording_bytes = size_bytes * times
    per_task = max(1, min(MOST_DEVICES, int(MOST_BYTES // recording_bytes)))
    tasks = -(-DEVICES // per_task)
    hours = DEVICES * cpu_s / CORES / 3600
    return {
        "devices": DEVICES,
        "hours_a_device": HOURS_A_DEVICE,
        "odr_hz": odr_hz,
        "cores": CORES,
        "cpu_s_a_device": cpu_s,
        "hours": hours,
        "recordings_bytes": DEVICES * recording_bytes,
        "results_bytes": DEVICES * row["out_bytes"] / row["devices"],
        "devices_per_task": per_task,
        "tasks": tasks,
        "seconds_a_task": per_task * cpu_s,
        "tasks_per_s": tasks / (hours * 3600),
        "scheduler_share": tasks * SCHEDULER_S_A_TASK / (hours * 3600),
        "most_waiting": MOST_WAITING,
    }
