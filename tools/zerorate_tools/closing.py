"""`zerorate close`: recordings in, what was found out."""

import json
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits

from .errors import ZerorateError
from .loop.analyse import analyse, sessions_of
from .loop.motion.by_windows import GIVEN, UNIT, RateScale, by_windows, seen_in_words
from .loop.motion.moving import moving_of
from .loop.motion.scales_and_timing import InMotion, slots_of
from .loop.read.gate import CannotClose, TooLittleRest
from .loop.read.ticks import AnyPath, Ticks, read_ticks, tick_seconds
from .loop.report.motion_effects import heading_in_words, heading_of, turning
from .loop.report.report import as_json, report
from .loop.report.result import LoopReport
from .loop.verify.analysis import Analysis
from .loop.verify.firmware import Firmware
from .loop.verify.run_kernels import CorrectedWriter, run_and_prune
from .model import Model, build_model, write_model
from .model.model import binding_of
from .recordings import open_recording
from .recordings.atomic import written_together
from .replay.samples import frames_in_batches


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
    named = (n for n, p in zip(names, paths) if p == Path(holdout) or p.name == str(holdout))
    name = next(named, None)
    if name is None:
        do = "name one of them to hold out"
        raise ZerorateError(f"{holdout}: none of the recordings given; {do}")
    if name not in kept:
        raise CannotClose(f"{holdout} cannot be held out: too little of it is still")
    return kept.index(name)


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


_AXES = "xyz"
_ROWS = 131_072
_BLIND = "no rest was long enough, so nothing that only rest shows was looked for"


# The matrices are small: more threads wait for each other longer than one works.
@threadpool_limits.wrap(limits=1, user_api="blas")
def shown_in_motion(ticks: Sequence[Ticks], holdout: int | None) -> RateScale | None:
    """What windows in motion show of the matrix; None without motion. holdout: index of the
    recording held out, by default the last. Raises CannotClose."""
    every = [moving_of(t.path, t) for t in ticks]
    at = (len(every) - 1 if holdout is None else holdout) if len(every) > 1 else None
    train = [m for i, m in enumerate(every) if m is not None and i != at]
    held = [] if at is None else [m for m in [every[at]] if m is not None]
    shown = by_windows(train, held)
    railed = [m.railed for m in (*train, *held) if m.railed]
    if shown is None and railed:
        raise CannotClose("; ".join(railed))
    return shown


def write_in_motion(
    shown: RateScale,
    logs: Sequence[AnyPath],
    holdout: int | None,
    folder: Path,
    advance: Callable[[float], None],
) -> dict[str, Any]:
    """Write model.json, model.bin, corrected.parquet and report.html; what report.json holds."""
    from .report.motion_page import motion_page  # its libraries are large

    scales = open_recording(logs[0]).scales
    slots = slots_of(InMotion(shown))
    model = build_model(slots, scales, binding=binding_of(scales))
    held = {Path(logs[-1 if holdout is None or len(logs) == 1 else holdout]).name}
    writer = CorrectedWriter(folder / "corrected.parquet")
    for log in logs:
        _correct(writer, Path(log), model, Path(log).name in held)
        advance(1)
    writer.close()
    write_model(model, folder)
    result = _result(shown, [Path(log).name for log in logs], sorted(held))
    (folder / "report.html").write_text(motion_page(result, folder), encoding="utf-8")
    return result


def _correct(writer: CorrectedWriter, log: Path, model: Model, test: bool) -> None:
    scales = open_recording(log).scales
    ways = {"before": Firmware(scales, None)}
    ways["after"] = Firmware(scales, model) if model.slots else ways["before"].copy()
    for frames in frames_in_batches(open_recording(log, keep_gaps=True), _ROWS, ()):
        biases = {way: device.run(frames, learn=False) for way, device in ways.items()}
        writer.write(log.name, frames, np.full(len(frames), test), biases)


def _result(shown: RateScale, names: list[str], held: list[str]) -> dict[str, Any]:
    nothing = [None] * 3
    without = {"before_mdps": nothing, "after_mdps": nothing}
    found = [turning(shown)] if shown.found else []
    train = names if len(names) == 1 else [n for n in names if n not in held]
    unit = "windows within one recording" if len(names) == 1 else "power-on session"
    return {
        "split": {"unit": unit, "train": train, "test": held},
        "floor_mdps": nothing,
        **without,
        "ci95_mdps": {"before": nothing, "after": nothing},
        "effects": [{**effect, **without, "confounded_with": []} for effect in found],
        "events": [],
        "in_motion": {
            "before": round(shown.before, 3),
            "after": round(shown.after if found else shown.before, 3),
            "unit": shown.unit,
            "matrix_percent": np.round(100 * shown.matrix, 4).tolist(),
            "ci95_percent": np.round(196 * shown.deviation, 4).tolist(),
            "not_seen": not_seen(shown),
            "windows": shown.runs,
            **(heading_of(shown) if found else {}),
        },
        "unexplained": {
            "what_is_known": "; ".join([_BLIND, *shown.notes]),
            "measure_next": advice(shown),
        },
        "verdict": "effects-found" if found else "nothing-found",
    }


def not_seen(shown: RateScale) -> list[str]:
    """Names of the entries that the motion did not show: the axis that reads, the axis turned."""
    at = zip(*np.nonzero(shown.unseen))
    return [f"{_AXES[i]} from {_AXES[j]}" if i != j else f"scale of {_AXES[i]}" for i, j in at]


def advice(shown: RateScale) -> list[str]:
    """What to record next: turns that were missing, and rest."""
    missing = [_AXES[j] for j in np.flatnonzero(shown.unseen.any(axis=0))]
    turns = [f"hold {axis} level and turn the device about it, several times" for axis in missing]
    return [*turns, "leave the device untouched for two minutes to show what only rest shows"]


def motion_in_words(result: Mapping[str, Any]) -> str:
    """The result in a few lines for a terminal."""
    m = result["in_motion"]
    effect = result["effects"][0] if result["effects"] else None
    seen_by = "the reference" if m["unit"] == UNIT[GIVEN] else "gravity"
    if effect:
        lines = [
            f"{effect['effect']} ({effect['confidence']}): {heading_in_words(m)}",
            f"on motion held out, {seen_by} sees {m['before']:.2f} -> {m['after']:.2f} {m['unit']}",
        ]
        rows = zip(_AXES, m["matrix_percent"], m["ci95_percent"])
        lines += [
            f"error of {axis}, % of the rate of x y z: "
            + "  ".join(f"{v:+.3f} +-{c:.3f}" for v, c in zip(values, spread))
            for axis, values, spread in rows
        ]
    else:
        lines = [f"found: nothing in motion; {seen_in_words(m['before'], m['unit'])}"]
    lines += [f"not seen in this motion: {', '.join(m['not_seen'])}"] if m["not_seen"] else []
    lines.append(f"note: {result['unexplained']['what_is_known']}")
    return "\n".join([*lines, *(f"next: {a}" for a in result["unexplained"]["measure_next"])])
