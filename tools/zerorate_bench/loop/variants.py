"""Real recordings as others might have made them: cut, without a sensor, with a step.

What is deployed is scored where nobody fitted it: on pieces or a recording left out, and, for a
half, on the other half, as a later power-on at temperatures that the half has shown.
"""

import tempfile
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from zerorate_tools.closing import load
from zerorate_tools.errors import ZerorateError
from zerorate_tools.importers import import_recording
from zerorate_tools.loop.analyse import sessions_of
from zerorate_tools.loop.read.blocks import session_of
from zerorate_tools.loop.read.sessions import Session
from zerorate_tools.loop.read.ticks import read_ticks, tick_seconds
from zerorate_tools.loop.report.report import report
from zerorate_tools.loop.verify.analysis import Analysis
from zerorate_tools.loop.verify.firmware import Firmware
from zerorate_tools.loop.verify.power_on import BlockMeans, PowerOn, ideal_dps, turn_on
from zerorate_tools.loop.verify.run_kernels import run_and_prune
from zerorate_tools.model import Model
from zerorate_tools.recordings import Recording, open_recording, read_recording, write_recording
from zerorate_tools.recordings.checks import GAP
from zerorate_tools.recordings.recording import ACCEL, GYRO, TEMP, TIME
from zerorate_tools.replay.samples import frames_in_batches

from ..public_data import CLOSED_ALONE, recordings_folder, told_of
from ..tables import machine_line, measured, table, table_of
from .real import noise_dps, rms_mdps

#: A step that is put in: where in the course, and of how many times the noise of a block.
_STEP_AT, _STEP_NOISES = 0.6, 10.0
_STEP_WAY = np.array([1.0, -0.7, 0.5])
#: What counts as worse, and the blocks that the other half must have to be scored.
_WORSE, _LEAST_BLOCKS = 1.02, 10
_NEAR_DEGC = 0.2


def _cut(recording: Recording, first: float, last: float) -> Recording:
    """A part of it, from one share of its samples to another."""
    return recording.between(int(first * len(recording)), int(last * len(recording)))


def _without(recording: Recording, names: Sequence[str]) -> Recording:
    kept = {n: v for n, v in recording.columns.items() if n not in names}
    return replace(recording, columns=kept)


def _with_step(recording: Recording, size_dps: float) -> Recording:
    """With a step of the bias, dithered so that half a count is one."""
    after = np.arange(len(recording)) >= _STEP_AT * len(recording)
    rng, columns = np.random.default_rng(0), dict(recording.columns)
    for name, way in zip(GYRO, _STEP_WAY):
        counts = size_dps * way * recording.scales.gyro_lsb_per_dps * after
        columns[name] = np.floor(columns[name] + counts + rng.random(len(after))).astype(np.int32)
    return replace(recording, columns=columns)


STEP, FIRST, SECOND = "a step put in", "its first half", "its second half"
#: Variant -> its recordings, by shares of the samples.
CUTS = {
    FIRST: [(0.0, 0.5)],
    SECOND: [(0.5, 1.0)],
    "its middle third": [(1 / 3, 2 / 3)],
    "two halves, as two recordings": [(0.0, 0.5), (0.5, 1.0)],
}


def run(data: Path | None) -> list[dict[str, Any]]:
    """A row for each recording and variant: before and after in mdps where it was not fitted, what
    was found, steps listed; `refused` says why there is none.
    """
    rows, folder = [], recordings_folder(data)
    with tempfile.TemporaryDirectory() as scratch:
        for path in measured([folder / n for n in CLOSED_ALONE if (folder / n).exists()]):
            recording = _imported(path, Path(scratch))
            for variant, made in _of(recording, Path(scratch)).items():
                row = {"recording": path.name, "variant": variant}
                rows.append(row | _looked_at(recording, variant, made, Path(scratch)))
    return rows


def _imported(path: Path, scratch: Path) -> Recording:
    """A recording without the channels that have gaps."""
    log = scratch / "imported.parquet"
    import_recording(path, log, **told_of(path))
    recording = read_recording(log, keep_gaps=True)
    gaps = [n for n in recording.extra_channels if (recording.columns[n] == GAP).any()]
    return _without(recording, gaps)


def _of(recording: Recording, scratch: Path) -> dict[str, list[Recording]]:
    """Those variants that change anything."""
    made = {name: [_cut(recording, *span) for span in spans] for name, spans in CUTS.items()}
    if recording.has_accel:
        made["without accelerometer"] = [_without(recording, ACCEL)]
    if recording.has_temp:
        made["without temperature"] = [_without(recording, [TEMP])]
    log = _written(recording, scratch / "whole.parquet")
    noise = noise_dps(sessions_of([read_ticks(log, tick_seconds(log))])[0])
    return made | {STEP: [_with_step(recording, _STEP_NOISES * noise)]}


def _written(recording: Recording, path: Path) -> Path:
    write_recording(recording, path)
    return path


def _looked_at(
    whole: Recording, variant: str, made: list[Recording], scratch: Path
) -> dict[str, Any]:
    logs = [_written(r, scratch / f"part-{i}.parquet") for i, r in enumerate(made)]
    try:
        analysis, model = run_and_prune(load([*logs]), logs, scratch / "corrected.parquet")
    except ZerorateError as problem:
        return {"refused": str(problem)}
    result = report(analysis)
    row = {
        "before_mdps": rms_mdps(np.vstack(analysis.judgement.residual_before)),
        "after_mdps": rms_mdps(np.vstack(analysis.judgement.residual_after)),
        "found": ", ".join(effect["effect"] for effect in result["effects"]),
        "steps_listed": len(result["events"]),
    }
    if variant == STEP:
        row["found_the_step"] = _is_listed(result["events"], made[0])
    if variant in (FIRST, SECOND):
        other = _cut(whole, *CUTS[SECOND if variant == FIRST else FIRST][0])
        row |= _elsewhere(analysis, model, logs[0], _written(other, scratch / "other.parquet"))
    return row


def _is_listed(events: list[dict[str, Any]], recording: Recording) -> bool:
    """Whether a step is listed within a fiftieth of the course of the one put in."""
    at = recording.columns[TIME]
    true = at[int(np.ceil(_STEP_AT * len(at)))]
    return any(abs(event["t_us"] - true) < 0.02 * (at[-1] - at[0]) for event in events)


def _elsewhere(analysis: Analysis, model: Model, log: Path, other: Path) -> dict[str, float]:
    """Before and after on a part that was not given, by a firmware that has learned the part that
    was and takes its offset from the first still minute; at temperatures that both have."""
    own, scales = analysis.sessions[0], open_recording(other).scales
    session = session_of(read_ticks(other, tick_seconds(other)), own.block_s)
    power_on = PowerOn(
        session, other, scales.gyro_lsb_per_dps, ideal_dps(session, analysis.motion),
        session.available, model.channels,
    )  # fmt: skip
    there, errors = session.available & _seen(own, session), []
    for deployed in (None, model if model.slots else None):
        device = Firmware(scales, deployed, model.channels)
        device.power_on()
        for frames in frames_in_batches(open_recording(log), 1 << 17, model.channels):
            device.run(frames)
        taken = turn_on(device, power_on)
        device.power_on()
        device.set_offset(taken.offset_q8)
        means = BlockMeans(power_on)
        for frames in power_on.frames():
            means.add(frames, device.run(frames, learn=False))
        left = (power_on.rate_dps - means.blocks_dps())[taken.blocks :]
        errors.append(left[there[taken.blocks :]])
    if min(map(len, errors)) < _LEAST_BLOCKS:
        return {}
    return dict(zip(("other_before_mdps", "other_after_mdps"), map(rms_mdps, errors)))


def _seen(own: Session, other: Session) -> np.ndarray:
    """(n,) blocks of another session at temperatures that the first has."""
    if "temp" not in own.sources:
        return np.ones(other.blocks, bool)
    known = own.block_mean(own.sources["temp"])[own.available]
    degc = other.block_mean(other.sources["temp"])
    return (degc > known.min() - _NEAR_DEGC) & (degc < known.max() + _NEAR_DEGC)


def in_markdown(rows: list[dict[str, Any]]) -> str:
    """The page of `zerorate bench variants`: how many of each variant are worse, then the rows."""
    lines = [
        "# Real recordings, cut, without a sensor, and with a step",
        "",
        "`zerorate bench variants` wrote this page. " + machine_line(),
        "`deployed` is something found and in model.bin; `worse` is by more than 2 %.",
        "",
    ]
    header = ("variant", "closed", "refused", "deployed", "worse", "after over before, median")
    variants = dict.fromkeys(row["variant"] for row in rows)
    lines.append(
        table(header, [_counted(v, [r for r in rows if r["variant"] == v]) for v in variants])
    )
    for half, other in ((FIRST, "second"), (SECOND, "first")):
        own = [r for r in rows if r["variant"] == half and "other_after_mdps" in r]
        worse = [r for r in own if r["other_after_mdps"] > _WORSE * r["other_before_mdps"]]
        names = ", ".join(r["recording"] for r in worse) or "none"
        lines.append(f"By {half} alone, worse on the {other} of {len(own)}: {names}.")
    steps = [r["found_the_step"] for r in rows if "found_the_step" in r]
    said = f"Steps of {_STEP_NOISES:g} times the noise of a block listed"
    lines += [f"{said}: {sum(steps)} of {len(steps)}.", ""]
    shown = [r for r in rows if r.get("found") or r.get("refused") or "found_the_step" in r]
    lines += [f"In the {len(rows) - len(shown)} rows that are left out here nothing was found.", ""]
    return "\n".join([*lines, table_of(shown)])


def _counted(variant: str, rows: list[dict[str, Any]]) -> list[Any]:
    closed = [r for r in rows if "after_mdps" in r]
    ratios = [r["after_mdps"] / r["before_mdps"] for r in closed]
    median = round(float(np.median(ratios)), 2) if ratios else ""
    deployed, worse = sum(bool(r["found"]) for r in closed), sum(r > _WORSE for r in ratios)
    return [variant, len(closed), len(rows) - len(closed), deployed, worse, median]
