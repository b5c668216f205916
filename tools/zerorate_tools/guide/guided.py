"""A recording that says what to do while it is made, and ends when all is known."""

from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from types import TracebackType

from ..recordings import Scales
from ..recordings.recording import TIME, Columns
from .known import KnownSoFar
from .screen import Shown

#: A window of 10 s, the shortest, ends this often.
_LOOK_S = 2.5


class Guide:
    """For `record`: `heard` takes its samples, `done` shows what they say and ends it.

    waits: whether the recording waits for each look; else looks run beside it, since a chip's FIFO
    holds less than a second.
    """

    def __init__(self, shown: Shown, waits: bool = False) -> None:
        self.known: KnownSoFar | None = None
        self._shown, self._waits = shown, waits
        self._waiting: list[Columns] = []
        self._pool = ThreadPoolExecutor(1)
        self._look: Future[None] | None = None

    def __enter__(self) -> "Guide":
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        at: TracebackType | None,
    ) -> None:
        self._pool.shutdown()

    def heard(self, scales: Scales) -> Callable[[Columns], None]:
        """What each batch of verified samples is given to."""
        self.known = KnownSoFar(scales)
        return self._waiting.append

    def done(self, seconds: float) -> bool:
        """Begin a look where one is due, show what the last one found; whether all is known."""
        if self.known is None:
            return False
        if self._look is None and self._has_come_s() >= _LOOK_S:
            batches = self._waiting[:]
            self._waiting.clear()
            self._look = self._pool.submit(self.known.look, batches)
        if self._look is not None and (self._waits or self._look.done()):
            self._look.result()
            self._look = None
            self._shown.show(self.known)
            return self.known.all_known
        return False

    def _has_come_s(self) -> float:
        if not self._waiting:
            return 0.0
        return float(self._waiting[-1][TIME][-1] - self._waiting[0][TIME][0]) * 1e-6
