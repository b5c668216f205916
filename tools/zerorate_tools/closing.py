"""`zerorate close`: recordings in, what was found out."""

import json
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from .closing_in_motion import shown_in_motion, write_in_motion
from .errors import ZerorateError
from .loop.analyse import analyse, sessions_of
from .loop.read.gate import CannotClose, TooLittleRest
from .loop.read.ticks import AnyPath, read_ticks, tick_seconds
from .loop.report.report import as_json, report
from .loop.report.result import LoopReport
from .loop.verify.analysis import Analysis
from .loop.verify.run_kernels import run_and_prune
from .model import write_model
from .recordings.atomic import written_together


def load(
    logs: list[AnyPath],
    holdout: AnyPath | None = None,
    advance: Callable[[float], None] = lambda n: None,
) -> Analysis:
    """Read recordings of one device and run the loop. Raises ZerorateError.

    holdout: the recording to hold out, the last by default; advance: called for each recording.
    """
    ticks, tick_s = [], max(map(tick_seconds, logs))
    for log in logs:
        ticks.append(read_ticks(log, tick_s))
        advance(1)
    sessions, gate = sessions_of(ticks)
    at = _index(holdout, logs, [t.name for t in ticks], [s.name for s in sessions])
    return analyse(sessions, at, gate, {t.name: log for t, log in zip(ticks, logs)})


def _index(
    holdout: AnyPath | None, logs: list[AnyPath], names: list[str], kept: list[str]
) -> int | None:
    if holdout is None:
        return None
    paths = [Path(log) for log in logs]
    at = next(
        (i for i, p in enumerate(paths) if p == Path(holdout) or p.name == str(holdout)), None
    )
    if at is None:
        raise ZerorateError(
            f"{holdout}: none of the recordings given; name one of them to hold out"
        )
    if names[at] not in kept:
        raise CannotClose(f"{holdout} cannot be held out: too little of it is still")
    return kept.index(names[at])


def close(
    logs: list[AnyPath],
    out: AnyPath,
    holdout: AnyPath | None = None,
    advance: Callable[[float], None] = lambda n: None,
    online: bool = False,
) -> LoopReport:
    """Run the loop; write report.html, report.json, model.json, model.bin and corrected.parquet.

    out: the folder, made where it is not there; online: what the learning firmware subtracts goes
    into corrected.parquet, too; advance: called twice for each recording. The files are all
    replaced, or none is. Returns what report.json holds. Raises ZerorateError (BadRecording,
    CannotClose, CannotDeploy, Refused).
    """
    from .report import write_report  # its libraries are large

    try:
        analysis = load(logs, holdout, advance)
    except TooLittleRest as problem:
        return _close_in_motion(logs, out, holdout, advance, problem)
    with written_together(out) as folder:
        corrected = folder / "corrected.parquet"
        analysis, model = run_and_prune(analysis, logs, corrected, online, advance)
        write_model(model, folder)
        result = _written(report(analysis), folder)
        write_report(analysis, result, logs, folder)
    return result


def _close_in_motion(
    logs: list[AnyPath],
    out: AnyPath,
    holdout: AnyPath | None,
    advance: Callable[[float], None],
    problem: TooLittleRest,
) -> LoopReport:
    """Close the loop on what motion shows; the problem is raised where it shows nothing."""
    ticks = [read_ticks(log) for log in logs]
    names = [t.name for t in ticks]
    at = _index(holdout, logs, names, names)
    shown = shown_in_motion(ticks, at)
    if shown is None and all(t.scales.accel_lsb_per_g is None for t in ticks):
        raise TooLittleRest(f"{problem}; or record acceleration: gravity tells what moves")
    if shown is None:
        raise problem
    with written_together(out) as folder:
        return _written(write_in_motion(shown, logs, at, folder, advance), folder)


def _written(result: Mapping[str, Any], folder: Path) -> LoopReport:
    """What report.json holds, which is written into the folder."""
    text = json.dumps(result, default=as_json, indent=1, allow_nan=False)
    (folder / "report.json").write_text(text, encoding="utf-8")
    return json.loads(text)
