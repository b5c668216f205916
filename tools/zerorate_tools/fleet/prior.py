"""The prior for a new device of a part, and the error of its first minutes with and without it."""

import json
import tempfile
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
from scipy import stats

from ..loop.read.sessions import Session
from ..model import Model, Slot, build_model, encoded, write_model
from ..model.term import Term
from ..recordings import Recording, Scales, open_recording
from ..recordings.atomic import written_together
from ..replay import AT_REST_ALONE, replay
from .devices import here
from .job import block_means, error_mdps, one_line, still_session
from .part import Part, part_of, scale_of
from .population import TERMS

FOLDS = 5
LEAST_DEVICES = 10
MOST_DEVICES = 200
_PER_TASK = 16

Task = tuple[str, str, int]
Runner = Callable[[Callable[[Any], Any], list[Any]], Iterator[tuple[Any, Any]]]
#: In words; how long a device rests before it moves, and from when on its error counts, in seconds.
SCENARIOS = {
    "never-at-rest": ("never at rest", 0.0, 0.0),
    "at-rest-for-10-s": ("at rest for 10 s, then moving", 10.0, 10.0),
    "always-at-rest": ("always at rest", np.inf, 5.0),
}
WAYS = {"without": "without a prior", "prior": "with the prior"}
_MOTION_DPS, _MOTION_HZ = 30.0, 0.7
_MOST_LSB = 32767

#: Scenario -> way -> mdps.
Trial = dict[str, dict[str, float]]


def try_prior(prior: bytes, path: str, minutes: float) -> Trial:
    """Scenario -> way -> error in mdps over the first minutes of a recording of a left-out device.

    prior: the bytes of a model.bin. The firmware replays the recording as if the device had begun
    to move after its rest; the error is the rms over axes and still blocks, after that rest, of the
    rate less the firmware's bias. An empty dict where nothing is still. Raises BadRecording.
    """
    found: Trial = {}
    with tempfile.TemporaryDirectory(prefix="zerorate-prior-") as scratch:
        with here(path, scratch) as near:
            session, recording = still_session(near), beginning(near, minutes)
        model = Path(scratch) / "model.bin"
        model.write_bytes(prior)
        for name, (_, rest_s, from_s) in SCENARIOS.items():
            moved = moving_from(recording, rest_s)
            errors = {
                way: _error(moved, session, file, from_s, 60 * minutes)
                for way, file in zip(WAYS, (None, model))
            }
            if all(value is not None for value in errors.values()):
                found[name] = {way: value for way, value in errors.items() if value is not None}
    return found


def try_batch(
    priors: Sequence[bytes], minutes: float, batch: Sequence[tuple[str, str, int]]
) -> dict[str, Trial | str]:
    """One task: device -> `try_prior`, or why it failed, for each (device, path, its prior)."""
    found: dict[str, Trial | str] = {}
    for device, path, fold in batch:
        try:
            found[device] = try_prior(priors[fold], path, minutes)
        except Exception as error:  # of a stranger's file; the others go on
            found[device] = one_line(error)
    return found


def beginning(path: str, minutes: float) -> Recording:
    """The first minutes of a recording, no more of it read. Raises BadRecording."""
    opened, parts = open_recording(path, keep_gaps=True), []
    for batch in opened.batches(rows=8192):
        parts.append(batch)
        end_us = int(parts[0]["t_us"][0] + 60e6 * minutes)
        if batch["t_us"][-1] >= end_us:
            break
    columns = {name: np.concatenate([p[name] for p in parts]) for name in parts[0]}
    recording = Recording(columns, opened.scales, opened.name)
    return recording.between(0, int(np.searchsorted(columns["t_us"], end_us)))


def moving_from(recording: Recording, rest_s: float) -> Recording:
    """The recording as if the device swung about all axes from rest_s on."""
    columns = dict(recording.columns)
    seconds = (columns["t_us"] - columns["t_us"][0]) * 1e-6
    swing = _MOTION_DPS * recording.scales.gyro_lsb_per_dps * (seconds >= rest_s)
    for phase, name in enumerate(("gx", "gy", "gz")):
        added = swing * np.sin(2 * np.pi * (_MOTION_HZ * seconds + (phase + 0.5) / 3))
        moved = np.clip(np.rint(columns[name] + added), -_MOST_LSB, _MOST_LSB)
        columns[name] = moved.astype(np.int32)
    return Recording(columns, recording.scales, recording.name)


def _error(
    recording: Recording, session: Session, model: Path | None, from_s: float, to_s: float
) -> float | None:
    # of the made-up motion the accelerometer shows nothing
    table = replay(recording, model=model, options=AT_REST_ALONE).table
    assert table is not None
    bias_dps = block_means(table.to_batches(), session) / recording.scales.gyro_lsb_per_dps
    errors = error_mdps(session, bias_dps, from_s, to_s)
    return None if errors is None else float(np.sqrt(np.mean(np.square(errors))))


def benefit(
    names: Sequence[str],
    curves: Sequence[Any],
    first: dict[str, str],
    scales: Scales,
    minutes: float,
    run: Runner,
) -> dict[str, Any] | None:
    """Errors in the first minutes of left-out devices, without and with a prior.

    Five priors, each from four fifths of the devices, are tried on the other fifth, at most 200
    devices in all. first: device -> the recording to try; run: runs a function over batches.
    None for fewer than ten devices.
    """
    if len(names) < LEAST_DEVICES:
        return None
    order = np.random.default_rng(1).permutation(len(names))
    fold_of = {names[i]: place % FOLDS for place, i in enumerate(order)}
    priors = []
    for fold in range(FOLDS):
        rest = [(name, of) for name, of in zip(names, curves) if fold_of[name] != fold]
        part = part_of(*zip(*rest))
        assert part is not None
        priors.append(encoded(prior_model(part, scales)))
    tried = [names[i] for i in order[:MOST_DEVICES]]
    tasks: list[Task] = [(name, first[name], fold_of[name]) for name in tried]
    batches = [tasks[i : i + _PER_TASK] for i in range(0, len(tasks), _PER_TASK)]
    found: dict[str, Any] = {}
    failed: dict[str, str] = {}
    for batch, result in run(partial(try_batch, priors, minutes), batches):
        if isinstance(result, BaseException):
            result = {name: one_line(result) for name, _, _ in batch}
        found.update({name: r for name, r in result.items() if not isinstance(r, str)})
        failed.update({name: r for name, r in result.items() if isinstance(r, str)})
    in_order = {name: found[name] for name in tried if name in found}
    return {**_summary(in_order, minutes), "failed": failed}


def _summary(found: dict[str, Any], minutes: float) -> dict[str, Any]:
    """Per scenario and way median and 95th percentile over devices, mdps, and the paired gain."""
    scenarios = {}
    for name in SCENARIOS:
        rows = [device[name] for device in found.values() if name in device]
        if rows:
            columns = {way: np.array([row[way] for row in rows]) for way in WAYS}
            errors = {
                way: {"median_mdps": float(np.median(v)), "p95_mdps": float(np.quantile(v, 0.95))}
                for way, v in columns.items()
            }
            scenarios[name] = {**errors, "gain": _gain(columns), "devices": len(rows)}
    return {"minutes": minutes, "devices": len(found), "folds": FOLDS, "scenarios": scenarios}


def _gain(columns: dict[str, np.ndarray]) -> dict[str, Any]:
    """Median over devices of the error without less that with the prior, with a 95 % interval."""
    gain = columns["without"] - columns["prior"]
    known = stats.bootstrap((gain,), np.median, n_resamples=2000, method="percentile", rng=1)
    interval = known.confidence_interval
    return {
        "median_mdps": float(np.median(gain)),
        "ci95_mdps": [float(interval.low), float(interval.high)],
        "share_better": float((gain > 0).mean()),
    }


_POINTS = 9


def prior_model(part: Part, scales: Scales) -> Model:
    """The part's mean curve in effect slots: a level, a slope and a bend over temperature.

    Each coefficient is shrunken towards 0 by how unsure the mean is (James and Stein's positive
    part), so that noise is never handed on. The firmware subtracts the curve and learns what the
    new device differs from it by. As a state, as if it had been learned, the curve would hold: a
    new device lies off the part's level by more than a power-on's offset ever does, so its first
    rests would be implausible. Raises CannotDeploy.
    """
    slots = []
    for power in range(3):
        mean = np.array([axis.mean[power] for axis in part.axes])
        error = np.array([axis.mean_error[power] for axis in part.axes])
        beyond = np.maximum(0.0, mean**2 - error**2)
        value = np.divide(beyond, mean, np.zeros(3), where=mean != 0) * scale_of(power)
        if not value.any() or (power and not scales.temp_lsb_per_degc):
            continue
        term = Term("one")
        if power:
            term = Term("temp", part.low_degc, part.high_degc, part.reference_degc, power)
        x, y, z = map(float, value)
        slots.append(Slot(term, (x, y, z), f"prior: {TERMS[power]}"))
    return build_model(slots, scales)


def prior_json(part: Part) -> dict[str, Any]:
    """The expected curve with its spread for people and other programs, dps per axis x y z."""
    found: dict[str, Any] = {
        "devices": int(min(axis.used.sum() for axis in part.axes)),
        "reference_degc": part.reference_degc,
    }
    warm = not np.isnan(part.low_degc)
    degc = np.linspace(part.low_degc, part.high_degc, _POINTS) if warm else np.array([25.0])
    mean, deviation = part.at(degc)
    found["curve"] = [
        {"degc": round(float(t), 2), "bias_dps": m.tolist(), "deviation_dps": d.tolist()}
        for t, m, d in zip(degc, mean, deviation)
    ]
    return found


def write_prior(part: Part, scales: Scales, folder: str | PathLike[str]) -> Model:
    """Write prior.json, model.json and model.bin into a folder: all of them, or none."""
    model = prior_model(part, scales)
    with written_together(folder) as draft:
        text = json.dumps(prior_json(part), indent=1)
        (draft / "prior.json").write_text(text, encoding="utf-8")
        write_model(model, draft)
    return model
