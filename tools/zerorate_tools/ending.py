"""Signals that end a program, noted while something must not be left half done."""

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager

_ENDING = [getattr(signal, n) for n in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, n)]


@contextmanager
def noted_signals() -> Iterator[list[int]]:
    """Yield a list that takes the numbers of signals instead of their ending the program.

    Which thread a signal reaches plays no part: its handler runs in the main one. Outside that one
    nothing can be noted, and the list stays empty. Ignored signals (nohup) stay ignored.
    """
    came: list[int] = []
    before = {}
    if threading.current_thread() is threading.main_thread():
        handlers = {number: signal.getsignal(number) for number in _ENDING}
        before = {n: h for n, h in handlers.items() if h not in (None, signal.SIG_IGN)}
    try:
        for number in before:
            signal.signal(number, lambda number, _: came.append(number))
        yield came
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)


@contextmanager
def undisturbed() -> Iterator[None]:
    """A signal that would end the program does so when the block has ended."""
    came: list[int] = []
    try:
        with noted_signals() as came:
            yield
    finally:
        for number in came[:1]:
            signal.raise_signal(number)
