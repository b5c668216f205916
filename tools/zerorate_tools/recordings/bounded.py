"""A bound on memory that does not depend on what a file says of itself."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TypeVar

STEP_MB = 300
"""What one step of reading may take beyond what the process has."""

T = TypeVar("T")


@contextmanager
def at_most(megabytes: int = STEP_MB) -> Iterator[None]:
    """Within the block, memory beyond so much more than there is raises MemoryError.

    Where the system has no such limit (all but Linux) nothing is bounded.
    """
    taken = _taken_bytes()
    if taken is None:
        yield
        return
    import resource

    soft, hard = resource.getrlimit(resource.RLIMIT_DATA)
    most = taken + (megabytes << 20)
    limits = [limit for limit in (soft, hard) if limit != resource.RLIM_INFINITY]
    resource.setrlimit(resource.RLIMIT_DATA, (min([most, *limits]), hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_DATA, (soft, hard))


def each_at_most(items: Iterator[T], megabytes: int = STEP_MB) -> Iterator[T]:
    """The same items, each made within the bound."""
    while True:
        with at_most(megabytes):
            try:
                item = next(items)
            except StopIteration:
                return
        yield item


def _taken_bytes() -> int | None:
    try:
        with open("/proc/self/statm") as file:
            return int(file.read().split()[5]) * os.sysconf("SC_PAGE_SIZE")
    except (OSError, ValueError, IndexError):
        return None
