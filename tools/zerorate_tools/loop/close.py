"""`zerorate close`: recordings in, what was found out."""

from __future__ import annotations

import json
from collections.abc import Callable
from os import PathLike
from pathlib import Path

from ..errors import ZerorateError
from ..model import write_model
from ..recordings import open_recording
from ..recordings.atomic import written_beside
from .analysis import Analysis, analyse, sessions_of
from .corrected import write_corrected
from .gate import CannotClose
from .model import model_of
from .report import as_json, report
from .ticks import read_ticks


def load(
    logs: list[str | PathLike[str]],
    holdout: str | PathLike[str] | None = None,
    advance: Callable[[float], None] = lambda n: None,
) -> Analysis:
    """Read recordings of one device and run the loop. Raises ZerorateError.

    holdout: the recording to lock away, the last by default; advance: called for each recording.
    """
    ticks = []
    for log in logs:
        ticks.append(read_ticks(log))
        advance(1)
    sessions, gate = sessions_of(ticks)
    at = None
    if holdout is not None:
        at = _index(holdout, logs, [t.name for t in ticks], [s.name for s in sessions])
    return analyse(sessions, at, gate)


def _index(holdout, logs, names, kept):
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
    logs: list[str | PathLike[str]],
    out: str | PathLike[str],
    holdout: str | PathLike[str] | None = None,
    advance: Callable[[float], None] = lambda n: None,
) -> dict:
    """Run the loop; write report.json, model.json, model.bin and corrected.parquet into a folder.

    Returns what report.json holds. Raises ZerorateError (BadRecording, CannotClose, CannotDeploy).
    """
    analysis = load(logs, holdout, advance)
    folder = Path(out)
    folder.mkdir(parents=True, exist_ok=True)
    model = model_of(analysis, open_recording(logs[0]).scales)
    result = report(analysis)
    with written_beside(folder / "report.json") as temporary:
        text = json.dumps(result, indent=1, allow_nan=False, default=as_json)
        temporary.write_text(text, encoding="utf-8")
    write_model(model, folder)
    write_corrected(analysis, list(logs), folder / "corrected.parquet")
    return result
