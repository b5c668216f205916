"""Rows that do not come in order of time."""

from pathlib import Path

import numpy as np

from ...errors import BadRecording
from ..report import cut_words
from .spool import PLACE, TIME, Spool

#: Rows that may wait for their turn: some 150 MB.
_MOST_WAITING = 2_000_000
#: Rows in a row, from which on a stretch in order counts as one of its own.
_LONG = 100
_SHARED = 0.1


class Runs:
    """Follows the order of time stamps: how many rows step back, and whether time begins anew."""

    def __init__(self) -> None:
        self.steps_back = 0
        self._long: list[tuple[float, float, int]] = []
        self._begin: tuple[float, int] | None = None
        self._last = 0.0
        self._rows = 0

    def add(self, t_us: np.ndarray, place: np.ndarray) -> None:
        """Take the time stamps of the next rows."""
        if not len(t_us):
            return
        if self._begin is None:
            self._begin, self._last = (t_us[0], int(place[0])), t_us[0]
        before = self._last
        back = np.flatnonzero(np.diff(t_us, prepend=before) < 0)
        self.steps_back += len(back)
        start = 0
        for at in back.tolist():
            self._rows += int(at - start)
            self._close(t_us[at - 1] if at else before)
            start, self._begin = int(at), (t_us[at], int(place[at]))
        self._rows += len(t_us) - start
        self._last = t_us[-1]

    def refuse_a_restart(self, path: Path) -> None:
        """Raise BadRecording where two long stretches claim the same time, or where one leads back
        to well before the one above it: a clock was set back, or a counter ran over. Halves in the
        wrong order fit together."""
        self._close(self._last)
        for (above, _, _), (begin, end, place) in zip(self._long, self._long[1:]):
            if above - end > _SHARED * (end - begin):
                row = place + 1
                raise BadRecording(path, "time begins anew", row=row, do=cut_words(path, row))
        latest, before = -np.inf, None
        for begin, end, place in sorted(self._long):
            if before is not None and latest - begin > _SHARED * (end - begin):
                row = max(place, before) + 1
                raise BadRecording(path, "time begins anew", row=row, do=cut_words(path, row))
            if end > latest:
                latest, before = end, place

    def _close(self, end: float) -> None:
        if self._begin is not None and self._rows >= _LONG and len(self._long) < 10_000:
            self._long.append((self._begin[0], end, self._begin[1]))
        self._rows = 0


def in_order(spool: Spool, path: Path, folder: Path | None) -> Spool:
    """The same rows by time; the spool itself where they are. Raises BadRecording."""
    pieces = spool.pieces
    if all(p.in_order for p in pieces) and all(
        a.last_us <= b.first_us for a, b in zip(pieces, pieces[1:])
    ):
        return spool
    out = Spool(spool.names, folder)
    numbers = sorted(range(len(pieces)), key=lambda n: pieces[n].first_us)
    waiting = {name: np.empty(0) for name in spool.names}
    for at, number in enumerate(numbers):
        piece = spool.read(number)
        waiting = {name: np.concatenate([waiting[name], piece[name]]) for name in spool.names}
        if len(waiting[TIME]) > _MOST_WAITING:
            problem = f"rows are out of order by more than {_MOST_WAITING} rows"
            raise BadRecording(path, problem, do="sort it by time first, as `sort -n` does")
        order = np.lexsort((waiting[PLACE], waiting[TIME]))
        waiting = {name: values[order] for name, values in waiting.items()}
        following = numbers[at + 1] if at + 1 < len(numbers) else None
        until = np.inf if following is None else pieces[following].first_us
        ready = int(np.searchsorted(waiting[TIME], until, "right" if following is None else "left"))
        out.append({name: values[:ready] for name, values in waiting.items()})
        waiting = {name: values[ready:] for name, values in waiting.items()}
    out.finish()
    spool.close()
    return out
