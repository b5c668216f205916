"""How far long work has come, on a terminal's standard error; silent in a pipe."""

import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any


@contextmanager
def redrawn() -> Iterator[Any]:
    """Yield a part of the terminal that is drawn anew, a rich Live.

    Its escapes go to standard output itself, which the command line lets nothing else write to, so
    what is not our own text in it must be printable().
    """
    from rich.console import Console
    from rich.live import Live

    with Live(console=Console(file=sys.__stdout__), auto_refresh=False) as area:
        yield area


@contextmanager
def progress(what: str, total: float | None = None) -> Iterator[Callable[[float], None]]:
    """Yield `advance(n)`, to be called as n more of `total` are done.

    total: in any unit, or None where the end is not known.
    """
    if not sys.stderr.isatty():
        yield lambda n: None
        return
    from rich.console import Console
    from rich.progress import Progress

    with Progress(console=Console(stderr=True), transient=True) as bars:
        task = bars.add_task(what, total=total)
        yield lambda n: bars.advance(task, n)


#: For so long nothing is said while a network is waited for.
QUIET_S = 5.0


@contextmanager
def waiting(what: str) -> Iterator[None]:
    """As progress, of what nobody knows how long it takes; a pipe gets a line now and then."""
    with progress(what):
        if sys.stderr.isatty():
            yield
            return
        done = threading.Event()
        speaker = threading.Thread(target=_say_now_and_then, args=(what, done), daemon=True)
        speaker.start()
        try:
            yield
        finally:
            done.set()
            speaker.join()


def _say_now_and_then(what: str, done: threading.Event) -> None:
    passed_s = 0.0
    while not done.wait(QUIET_S):
        passed_s += QUIET_S
        print(f"{what}: {passed_s:.0f} s so far", file=sys.stderr, flush=True)
