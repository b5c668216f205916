"""Devices in batches: one task of the cluster each, so that tasks stay few."""

from collections.abc import Sequence

from .devices import Device

#: A task is worth its overhead from about a second on, and should be over within minutes.
MOST_DEVICES = 64
MOST_BYTES = 64 << 20
_TASKS_A_WORKER = 8


def in_batches(
    devices: Sequence[Device], workers: int, devices_per_task: int | None = None
) -> list[list[Device]]:
    """Cut devices into batches of at most 64 devices and 64 MiB of recordings.

    Fewer devices where a worker would get less than eight batches; devices_per_task: that many,
    whatever their size.
    """
    most = devices_per_task or min(MOST_DEVICES, -(-len(devices) // (_TASKS_A_WORKER * workers)))
    batches: list[list[Device]] = []
    room = 0
    for device in devices:
        size = 0 if devices_per_task else device.size_bytes
        if not batches or len(batches[-1]) >= most or size > room:
            batches.append([])
            room = MOST_BYTES
        batches[-1].append(device)
        room -= size
    return batches
