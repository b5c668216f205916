"""Time stamps that are coarser than the samples: rows that share one are spread over its time."""

from pathlib import Path

import numpy as np

from ...errors import BadRecording
from .clock import GAP_INTERVALS, duration
from .spool import PLACE, TIME, Spool

#: Of all steps: beyond that the stamps are coarser than the samples.
_REPEATED = 0.2
#: Rows that one stamp may have more or less than a steady rate gives: its ends fall on either side.
_ROWS_OFF = 2.0
#: Of the stamps: so many may be short of a row that was lost, and the rest still tells the rate.
_MOST_UNEVEN = 0.1


class Ticks:
    """What the stamps of the first samples tell: how long one lasts, and how long a sample."""

    def __init__(self, t_us: np.ndarray) -> None:
        steps = np.diff(t_us)
        went = steps[steps > 0]
        self.coarse = len(went) > 1 and bool((steps == 0).mean() > _REPEATED)
        self.tick_us = float(np.median(went)) if len(went) else 0.0
        self.sample_us = self.tick_us
        if self.coarse:
            at = np.flatnonzero(steps > 0) + 1
            rows, lasted = np.diff(at), np.diff(t_us[at])
            whole = lasted <= GAP_INTERVALS * self.tick_us
            # of which the first tick, the last, and those beside a gap are a part each
            whole[1:] &= whole[:-1]
            if whole.any():
                self.sample_us = float(lasted[whole].sum() / rows[whole].sum())


class _Spread:
    def __init__(self, ticks: Ticks) -> None:
        self.ticks = ticks
        self.begins = True
        self.uneven = self.groups = 0
        self.fewest, self.most = np.inf, 0.0

    def __call__(self, rows: dict[str, np.ndarray], following_us: float) -> dict[str, np.ndarray]:
        """The same rows, each with a time of its own. following_us: the stamp after the last."""
        t_us = rows[TIME]
        starts = np.flatnonzero(np.diff(t_us, prepend=-np.inf) > 0)
        stamps = t_us[starts]
        group = np.searchsorted(stamps, t_us, "right") - 1
        samples = np.isfinite(rows["gx"])
        first, lasts = self._windows(
            np.bincount(group[samples], minlength=len(stamps)),
            np.diff(stamps, append=following_us),
        )
        spread = t_us.copy()
        for kind in (samples, ~samples):
            own, count = group[kind], np.bincount(group[kind], minlength=len(stamps))
            number = np.arange(len(own)) - (np.cumsum(count) - count)[own]
            spread[kind] += first[own] + number * lasts[own] / count[own]
        order = np.lexsort((rows[PLACE], spread))
        return {name: values[order] for name, values in {**rows, TIME: spread}.items()}

    def _windows(self, count: np.ndarray, step_us: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """(when its rows begin after its stamp, how long they last) of each stamp, microseconds."""
        tick_us, sample_us = self.ticks.tick_us, self.ticks.sample_us
        due = np.minimum(step_us, GAP_INTERVALS * tick_us) / sample_us
        ends = (step_us > 1.5 * tick_us) & (count < due - _ROWS_OFF)
        begins = np.concatenate([[self.begins], ends[:-1]])
        self.begins = bool(ends[-1])
        off = np.abs(count - due)
        partly = (begins | ends) & (count <= np.minimum(due, tick_us / sample_us) + _ROWS_OFF)
        odd = (off > _ROWS_OFF) & ~partly & (count > 0)
        self.uneven += int(odd.sum())
        self.groups += int((count > 0).sum())
        inner = count[(count > 0) & ~begins & ~ends].astype(float)
        self.fewest = min(self.fewest, inner.min(initial=np.inf))
        self.most = max(self.most, inner.max(initial=0.0))
        within = np.where(ends, tick_us, step_us)
        own = np.where(count > 0, np.minimum(within, count * sample_us), within)
        lasts = np.where((begins | ends) & (off > _ROWS_OFF), own, within)
        return np.where(begins & ~ends, step_us - lasts, 0.0), lasts

    def refuse_uneven(self, path: Path) -> None:
        """Raise BadRecording where no steady rate gives so many rows a stamp."""
        if self.uneven > _MOST_UNEVEN * self.groups:
            problem = (
                f"{self.fewest:.0f} to {self.most:.0f} rows share each time stamp of "
                f"{duration(self.ticks.tick_us * 1e-6)}, so nothing tells their times"
            )
            do = "write finer times; where no row was lost, give --hz, rows a second"
            raise BadRecording(path, problem, do=do)

    def note(self) -> str:
        ticks = self.ticks
        said = (
            f"rows that share a time stamp of {duration(ticks.tick_us * 1e-6)} are spread over it"
        )
        lost = f"; in {self.uneven} of them rows are lost" if self.uneven else ""
        return f"{said}, {ticks.tick_us / ticks.sample_us:.4g} each{lost}"


def evenly(spool: Spool, ticks: Ticks, path: Path, folder: Path | None) -> tuple[Spool, str]:
    """(The same rows in order of time, each at its share of the time of its stamp; what was done).

    Raises BadRecording where the rows of a stamp do not come evenly.
    """
    out, spread = Spool(spool.names, folder), _Spread(ticks)
    rest = {name: np.empty(0) for name in spool.names}
    for columns in spool:
        rows = {name: np.concatenate([rest[name], columns[name]]) for name in spool.names}
        t_us = rows[TIME]
        ready = int(np.searchsorted(t_us, t_us[-1], "left"))
        rest = {name: values[ready:] for name, values in rows.items()}
        if ready:
            out.append(spread({name: v[:ready] for name, v in rows.items()}, t_us[ready]))
    out.append(spread(rest, np.inf))
    out.finish()
    spool.close()
    spread.refuse_uneven(path)
    return out, spread.note()
