"""Batches of devices through Dask: on this machine's cores, or on a cluster that is there."""

from __future__ import annotations

import asyncio
import logging
import os
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from tempfile import gettempdir
from types import ModuleType
from typing import TYPE_CHECKING, Any, TypeVar

from ..errors import MissingLibrary, ZerorateError
from .devices import Device

if TYPE_CHECKING:
    from distributed import Client

_T = TypeVar("_T")

#: So many tasks wait at the scheduler at most, whatever the size of the fleet.
MOST_WAITING = 1000
#: A task is worth its overhead from about a second on, and should be over within minutes.
MOST_DEVICES = 64
MOST_BYTES = 64 << 20
_TASKS_A_WORKER = 8
_CONNECT_S = 10
_ANSWER_S = 3
_POLL_S = 0.1
#: Of builtins alone: a worker without zerorate cannot even load a function of it.
_LACKS = """next((n for n in ("numpy", "pandas", "pyarrow", "zerorate_tools", "zerorate")
if __import__("importlib.util").util.find_spec(n) is None), "")"""


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


@contextmanager
def cluster(scheduler: str | None = None, workers: int | None = None) -> Iterator[Client]:
    """A client of the cluster at `scheduler`, or of one made here for as long as it is used.

    workers: processes of the latter, one core each, at most all cores. Raises MissingLibrary
    without Dask, ZerorateError for a scheduler that does not answer or whose workers lack zerorate.
    """
    try:
        import dask
        import distributed
    except ImportError as error:
        raise MissingLibrary("dask") from error
    if scheduler is not None:
        with _client_of(distributed, scheduler) as client:
            yield client
        return
    cores = os.cpu_count() or 1
    with (
        _safe_path(),
        dask.config.set(
            {
                # the first death of a worker tells as much as the fourth: see run_all
                "distributed.scheduler.allowed-failures": 0,
                # a worker that a busy machine starts anew in over 15 s is given up otherwise
                "distributed.deploy.lost-worker-timeout": "1 hour",
            }
        ),
        _started(distributed, min(workers or cores, cores)) as local,
        distributed.Client(local) as client,
    ):
        yield client


def _started(distributed: ModuleType, workers: int) -> Any:
    """A cluster of processes of this machine. Raises ZerorateError where none can begin."""
    try:
        return distributed.LocalCluster(
            n_workers=workers,
            threads_per_worker=1,
            dashboard_address="127.0.0.1:0",
            silence_logs=logging.CRITICAL,
        )
    except (OSError, RuntimeError) as error:
        room = f"make room in {gettempdir()}, or ask for fewer --workers"
        raise ZerorateError(f"no worker can be started here: {error}; {room}") from error


@contextmanager
def _safe_path() -> Iterator[None]:
    """Let no child that this process starts meanwhile import from the working folder."""
    before = os.environ.get("PYTHONSAFEPATH")
    os.environ["PYTHONSAFEPATH"] = "1"
    if sys.version_info < (3, 11):  # knows no such word; its children get our own paths later
        from multiprocessing import util

        util._args_from_interpreter_flags = lambda: ["-I"]  # type: ignore[attr-defined]
    try:
        yield
    finally:
        os.environ.pop("PYTHONSAFEPATH")
        if before is not None:
            os.environ["PYTHONSAFEPATH"] = before


def _client_of(distributed: ModuleType, address: str) -> Client:
    try:
        client = distributed.Client(address, timeout=_CONNECT_S)
    except (OSError, ValueError) as error:
        do = "name it as `dask scheduler` prints it, tcp://HOST:8786"
        raise ZerorateError(f"{address}: no Dask scheduler answers there; {do}") from error
    try:
        client.wait_for_workers(1, timeout=_CONNECT_S)
        _check_workers(client, address)
    except asyncio.TimeoutError as error:  # another one than Python's, before 3.11
        client.close()
        raise ZerorateError(f"{address}: no worker there; start some: dask worker") from error
    except ZerorateError:
        client.close()
        raise
    return client


def _check_workers(client: Client, address: str) -> None:
    """Raise ZerorateError naming a worker that does not answer, or lacks what the jobs need.

    They are asked beside their work, so one that is busy for long answers, too.
    """
    for worker in client.nthreads():
        try:
            lacks = client.run(eval, _LACKS, workers=[worker], callback_timeout=_CONNECT_S).get(
                worker
            )
        except (OSError, asyncio.TimeoutError) as error:
            do = "end it there, then start this command again"
            raise ZerorateError(f"{address}: worker {worker} does not answer; {do}") from error
        if lacks:
            do = "pip install 'zerorate[tools,fleet]' there"
            raise ZerorateError(f"{address}: worker {worker} lacks {lacks}; {do}")


def size_of(client: Client) -> int:
    """Threads of all workers."""
    return max(1, sum(client.nthreads().values()))


def run_all(
    client: Client, function: Callable[[list[_T]], Any], batches: Sequence[list[_T]]
) -> Iterator[tuple[list[_T], Any]]:
    """Yield (batch, result) as they finish.

    When a worker dies, Dask blames all that it had been given. So a blamed batch comes again an
    item a task, and a blamed item once more with nothing beside it; the result of one whose worker
    died even then is the exception, as is that of a function that raised.
    """
    from distributed import as_completed
    from distributed.scheduler import KilledWorker

    waiting = list(reversed(batches))
    suspects: list[list[_T]] = []
    under_way: dict[Any, list[_T]] = {}
    finished = as_completed()

    def submit(batch: list[_T]) -> None:
        future = client.submit(function, batch, pure=False)
        under_way[future.key] = batch
        finished.add(future)

    def go_on() -> bool:
        """Whether one item is alone now."""
        while waiting and len(under_way) < MOST_WAITING:
            submit(waiting.pop())
        if under_way or not suspects:
            return False
        submit(suspects.pop())
        return True

    workers = _workers_of(client) or []
    alone = go_on()
    for future in _each(client, finished, workers):
        batch = under_way.pop(future.key)
        error = future.exception() if future.status == "error" else None
        blamed = isinstance(error, KilledWorker) and not alone
        if blamed and len(batch) > 1:
            waiting += [[item] for item in batch]
        elif blamed:
            suspects.append(batch)
        else:
            yield batch, error if error is not None else future.result()
        future.release()
        alone = go_on()


def _workers_of(client: Client) -> list[str] | None:
    """Addresses of the workers; None where the scheduler does not answer."""
    if client.status != "running" or client.scheduler is None:
        return None
    try:
        return list(client.sync(client.scheduler.ncores, callback_timeout=_ANSWER_S))
    except (OSError, asyncio.TimeoutError):
        return None


def _each(client: Client, finished: Any, seen: list[str]) -> Iterator[Any]:
    """Futures as they finish. seen: addresses of workers. Raises ZerorateError where a cluster of
    others has lost its last worker, or its scheduler; one made here starts workers anew."""
    last_s = time.monotonic()
    address = str(client.scheduler.address if client.scheduler is not None else "")
    while finished.count():
        if finished.has_ready():
            future = next(finished)
            if future.cancelled():  # as all are when the scheduler is lost
                raise _gone(address, None, seen)
            yield future
            continue
        time.sleep(_POLL_S)
        if client.cluster is not None:
            continue
        workers = _workers_of(client)
        if workers:
            seen, last_s = workers, time.monotonic()
        elif time.monotonic() - last_s > _CONNECT_S:
            raise _gone(address, workers, seen)


def _gone(address: str, workers: list[str] | None, seen: list[str]) -> ZerorateError:
    who, it = "its workers are gone", "them"
    if workers is None:
        who, it = "the scheduler is gone", "it"
    elif seen:
        who += f" ({', '.join(seen)})"
    do = f"start {it} again, then this command: what was done is kept"
    return ZerorateError(f"{address}: {who}; {do}")
