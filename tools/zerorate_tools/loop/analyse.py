"""The whole loop over the sessions of one device, from blocks to a judgement."""

from collections.abc import Mapping
from dataclasses import replace
from os import PathLike

import numpy as np
from threadpoolctl import threadpool_limits

from ..recordings import open_recording
from .fit.cross_products import whitener
from .fit.regression import floor_dps
from .fit.single import PiecesByLine
from .motion.by_windows import seen_in_words
from .motion.scales_and_timing import (
    InMotion,
    in_motion,
    may_show_motion,
    slots_of,
    without_scales,
)
from .read.blocks import sessions_from
from .read.gate import (
    GateReport,
    TooLittleRest,
    enough,
    readable,
    same_settings,
    shaken,
    usable_channels,
    without_long_gaps,
)
from .read.sessions import OWN_SOURCES, Session
from .read.ticks import Ticks
from .search.catalogue import extra_channels
from .search.naming import name_earth
from .search.periodic import periodic
from .search.select import select
from .search.selection import deployed
from .search.steps_first import remove_steps
from .verify.analysis import Analysis
from .verify.by_kernels import PiecesByKernels
from .verify.judge import rms_dps
from .verify.power_on import PowerOn, ideal_dps
from .verify.prune_by_holdout import prune_by_holdout

Logs = Mapping[str, str | PathLike[str]]

#: Recordings that are named, of those with too little rest.
_MOST_SAID = 3


# The matrices are small: more threads wait for each other three times as long as one works.
@threadpool_limits.wrap(limits=1, user_api="blas")
def analyse(
    sessions: list[Session],
    holdout: int | None = None,
    gate: GateReport | None = None,
    logs: Logs | None = None,
) -> Analysis:
    """Run the loop. holdout: index of the session to hold out, the last by default; logs: each
    session's recording, for the firmware's own kernels to be run over where it stands alone.
    """
    gate = gate or GateReport()
    at = len(sessions) - 1 if holdout is None else holdout
    train, held = _apart(sessions, at)
    motion = in_motion(train, held if len(sessions) > 1 else [], logs, gate.moving)
    shown = motion.rate_scale
    if shown is not None:
        gate.notes += shown.notes
        if gate.moving and not shown.found:
            gate.notes.append(
                f"found: nothing in motion; {seen_in_words(shown.before, shown.unit)}"
            )
    sessions = [without_scales(s, motion) for s in sessions]
    whiteners = [whitener(s.available) for s in sessions]  # while they live nobody makes them anew
    clean = remove_steps(sessions)
    analysis = _look(clean, at, gate, motion, logs)
    if len(sessions) == 1 and clean[0].steps:
        # beside a wide loop an offset a stretch can cost more than steps that stay in
        whole = _look([replace(sessions[0], listed=clean[0].steps)], at, gate, motion, logs)
        analysis = min(analysis, whole, key=lambda a: _left_dps(a, motion, logs))
    del whiteners
    return analysis


def _apart(sessions: list[Session], at: int) -> tuple[list[Session], list[Session]]:
    """The sessions to fit on, and the one held out; one alone is both."""
    held = [sessions[at]]
    return [s for i, s in enumerate(sessions) if i != at] or held, held


def _left_dps(analysis: Analysis, motion: InMotion, logs: Logs | None) -> float:
    """RMS of what is left of pieces of one recording, by the firmware's own kernels where they
    can be run: they have learned the steps, too."""
    s, on_pieces = analysis.selection, _on_pieces(analysis.sessions[0], motion, logs)
    left = rms_dps([on_pieces.residual(s.straight, s.terms, s.applied)])
    return float(np.nan_to_num((left**2).sum(), nan=np.inf) ** 0.5)


def _look(
    sessions: list[Session], at: int, gate: GateReport, motion: InMotion, logs: Logs | None
) -> Analysis:
    """Effects of sessions, steps taken out of them or not, and what they are worth."""
    taken = len(slots_of(motion))
    train, held = _apart(sessions, at)
    on_pieces = _on_pieces(train[0], motion, logs) if len(train) == 1 else None
    selection = select(train, taken, on_pieces, len(sessions) > 1)
    selection, judgement = prune_by_holdout(selection, held)
    whole = [*selection.straight, *selection.terms]
    floor = floor_dps(judgement.whole, whole)
    terms, coefficients = deployed(selection)
    name_earth(selection.found, terms, coefficients, selection.regression)
    lines = periodic(train, held, terms, coefficients)
    return Analysis(sessions, train, held, selection, judgement, floor, gate, motion, lines)


def _on_pieces(session: Session, motion: InMotion, logs: Logs | None) -> PiecesByLine:
    if not logs:
        return PiecesByLine(session)
    log = logs[session.name]
    scales, ideal = open_recording(log).scales, ideal_dps(session, motion)
    channels, lsb = extra_channels(session), scales.gyro_lsb_per_dps
    return PiecesByKernels(PowerOn(session, log, lsb, ideal, session.available, channels), scales)


def sessions_of(ticks: list[Ticks]) -> tuple[list[Session], GateReport]:
    """Gate recordings and make them sessions of equal blocks. Raises CannotClose."""
    gate = GateReport({t.name: t.faults for t in ticks})
    readable(ticks)
    same_settings(ticks)
    without_long_gaps(ticks)
    sessions = sessions_from(ticks)
    kept, problems, notes = [], [], []
    for s in sessions:
        try:
            enough(s)
            kept.append(s)
        except TooLittleRest as problem:
            problems.append(str(problem))
            moves = may_show_motion(s)
            gate.moving += [s] if moves else []
            notes.append(f"{'looked at in motion alone' if moves else 'left out'}: {problem}")
    gate.notes += _first(notes)
    if not kept:
        raise TooLittleRest("; ".join(_first(problems)))
    for name in {n for t in ticks for n in t.extra if n in OWN_SOURCES}:
        gate.dropped[name] = "named like a source of the model's own: rename the column"
    shaken(kept, gate)
    usable_channels(kept, gate)
    return kept, gate


def _first(said: list[str]) -> list[str]:
    """The first of many that are much alike, and how many more there are."""
    more = len(said) - _MOST_SAID
    return [*said[:_MOST_SAID], f"{more} more rest too little"] if more > 0 else said
