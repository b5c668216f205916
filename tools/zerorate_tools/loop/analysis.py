"""The whole loop over the sessions of one device, from blocks to a judgement."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from os import PathLike

import numpy as np
from threadpoolctl import threadpool_limits

from ..recordings import open_recording
from .blocks import sessions_from
from .by_kernels import PiecesByKernels
from .catalogue import extra_channels
from .earth import ROTATION, name_earth
from .floor import floor_dps
from .gate import (
    CannotClose,
    GateReport,
    enough,
    readable,
    same_settings,
    shaken,
    usable_channels,
    without_long_gaps,
)
from .in_motion import InMotion, in_motion, slots_of, without_scales
from .judge import Judgement
from .line import deployed
from .lines import Line
from .measured import Measured
from .periodic import periodic
from .power_on import PowerOn, ideal_dps
from .select import select
from .selection import Selection
from .sessions import OWN_SOURCES, Session
from .single import pieces, split
from .ticks import Ticks
from .uphold import upheld

#: Power-ons to fit on below which nothing is confirmed: of two, one in two devices has a chance
#: agreement of all signs.
LEAST_CONFIRMING = 3


@dataclass
class Analysis:
    """What was fitted on what, what was found, and what the locked part says of it.

    motion, lines: what is not fitted on blocks at rest, `in_motion` and `periodic`; measured: what
    the firmware's kernels made of it, None before `measure`, after which the judgement is by them.
    """

    sessions: list[Session]
    train: list[Session]
    locked: list[Session]
    selection: Selection
    judgement: Judgement
    floor_dps: np.ndarray
    gate: GateReport = field(default_factory=GateReport)
    motion: InMotion = field(default_factory=InMotion)
    lines: list[Line] = field(default_factory=list)
    measured: Measured | None = None

    @property
    def single(self) -> bool:
        """Whether one recording was split in time."""
        return len(self.sessions) == 1

    @property
    def few(self) -> bool:
        """Whether so few power-ons were fitted that all may agree by chance."""
        return len(self.train) < LEAST_CONFIRMING

    @property
    def coefficients(self) -> np.ndarray:
        """(straight line and terms, 3) dps per unit, as deployed."""
        return deployed(self.selection)[1]

    def confidence(self, i: int) -> str:
        """confirmed or tentative; with fewer than three power-ons to fit on, for what Earth can do,
        and for time alone where no temperature was recorded, nothing is confirmed.
        """
        found = self.selection.found[i]
        unsure = self.few or ROTATION in found.confounded_with or self.may_be_heat(i)
        return "tentative" if unsure else self.judgement.confidence(i)

    def may_be_heat(self, i: int) -> bool:
        """Whether the i-th effect follows time alone, and no temperature tells it from warming."""
        blind = "temp" not in self.sessions[0].sources
        return blind and not set(self.selection.found[i].candidate.sources) - {"time"}


# The matrices are small: more threads wait for each other three times as long as one works.
@threadpool_limits.wrap(limits=1, user_api="blas")
def analyse(
    sessions: list[Session],
    holdout: int | None = None,
    gate: GateReport | None = None,
    logs: Mapping[str, str | PathLike[str]] | None = None,
) -> Analysis:
    """Run the loop. holdout: index of the session to lock away, the last by default; logs: each
    session's recording, for the firmware's own kernels to be run over where it stands alone.
    """
    gate = gate or GateReport()
    at = len(sessions) - 1 if holdout is None else holdout
    motion = in_motion(
        [s for i, s in enumerate(sessions) if i != at] or sessions,
        [sessions[at]] if len(sessions) > 1 else [],
        len(sessions) == 1,
    )
    sessions = [without_scales(s, motion) for s in sessions]
    taken = len(slots_of(motion))
    if len(sessions) == 1:
        train_part, locked_part, folds = split(sessions[0])
        train, locked = [train_part], [locked_part]
    else:
        train, locked = [s for i, s in enumerate(sessions) if i != at], [sessions[at]]
        folds = pieces(train[0]) if len(train) == 1 else []
    by_kernels = _on_pieces(train[0], folds, motion, logs) if folds and logs else None
    selection = select(train, folds, taken, by_kernels)
    selection, judgement = upheld(selection, locked)
    whole = [*selection.straight, *selection.terms]
    floor = floor_dps(judgement.whole, whole)
    terms, coefficients = deployed(selection)
    name_earth(selection.found, terms, coefficients, train)
    lines = periodic(train, locked, terms, coefficients)
    return Analysis(sessions, train, locked, selection, judgement, floor, gate, motion, lines)


def _on_pieces(train, folds, motion, logs):
    log = logs[train.name]
    scales, ideal = open_recording(log).scales, ideal_dps(train, motion)
    channels, lsb = extra_channels(train), scales.gyro_lsb_per_dps
    power_on = PowerOn(train, log, lsb, ideal, train.available, channels)
    return PiecesByKernels(power_on, train, folds, scales)


def sessions_of(ticks: list[Ticks]) -> tuple[list[Session], GateReport]:
    """Gate recordings and make them sessions of equal blocks. Raises CannotClose."""
    gate = GateReport({t.name: t.faults for t in ticks})
    readable(ticks)
    same_settings(ticks)
    without_long_gaps(ticks)
    sessions = sessions_from(ticks)
    kept = []
    for s in sessions:
        try:
            enough(s)
            kept.append(s)
        except CannotClose as problem:
            if len(sessions) == 1:
                raise
            gate.notes.append(f"left out: {problem}")
    if not kept:
        raise CannotClose("; ".join(n.removeprefix("left out: ") for n in gate.notes))
    for name in {n for t in ticks for n in t.extra if n in OWN_SOURCES}:
        gate.dropped[name] = "named like a source of the model's own: rename the column"
    shaken(kept, gate)
    usable_channels(kept, gate)
    return kept, gate
