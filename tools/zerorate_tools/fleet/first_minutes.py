"""A device's first minutes with and without a prior: how far the firmware's bias is off."""

import tempfile
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
from scipy import stats

from ..loop.read.sessions import Session
from ..model import encoded
from ..recordings import Recording, Scales, open_recording
from ..replay import AT_REST_ALONE, replay
from .job import one_line, still_session
from .part import part_of
from .places import here
from .prior import prior_json, prior_model
from .replay_power_on import block_means, error_mdps

FOLDS = 5
LEAST_DEVICES = 10
MOST_DEVICES = 200
_PER_TASK = 16

Task = tuple[str, str, int]
Runner = Callable[[Callable[[list], Any], list[list]], Iterator[tuple[list, Any]]]
#: How long a device rests before it moves, and from when on its error counts, both in seconds.
SCENARIOS = {
    "never-at-rest": (0.0, 0.0),
    "at-rest-for-10-s": (10.0, 10.0),
    "always-at-rest": (np.inf, 5.0),
}
WAYS = ("without", "prior", "prefilled")
_MOTION_DPS, _MOTION_HZ = 30.0, 0.7
_MOST_LSB = 32767

#: Scenario -> way -> mdps.
Trial = dict[str, dict[str, float]]
_STEPS = 8
_SECONDS_A_STEP = 12.0
_NOISE_DPS = 0.05


@dataclass(frozen=True)
class Prior:
    """A prior on its way to a worker. model: bytes of model.bin; degc, bias_dps: its curve."""

    model: bytes
    degc: np.ndarray
    bias_dps: np.ndarray


def try_prior(prior: Prior, path: str, minutes: float) -> Trial:
    """Scenario -> way -> error in mdps over the first minutes of a recording of a left-out device.

    The firmware replays the recording as if the device had begun to move after its rest; the error
    is the rms over axes and still blocks, after that rest, of the rate less the firmware's bias. An
    empty dict where nothing is still. Raises BadRecording.
    """
    found: Trial = {}
    with tempfile.TemporaryDirectory(prefix="zerorate-prior-") as scratch:
        with here(path, scratch) as near:
            session, recording = still_session(near), beginning(near, minutes)
        files = _files(prior, recording, Path(scratch))
        for name, (rest_s, from_s) in SCENARIOS.items():
            moved = moving_from(recording, rest_s)
            errors = {
                way: _error(moved, session, files[way], from_s, 60 * minutes) for way in files
            }
            if all(value is not None for value in errors.values()):
                found[name] = {way: value for way, value in errors.items() if value is not None}
    return found


def try_batch(
    priors: Sequence[Prior], minutes: float, batch: Sequence[tuple[str, str, int]]
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


def _files(prior: Prior, recording: Recording, folder: Path) -> dict[str, dict[str, Any]]:
    """Way -> what `replay` is given for it."""
    model, state = folder / "model.bin", folder / "state.bin"
    model.write_bytes(prior.model)
    files: dict[str, dict[str, Any]] = {"without": {}, "prior": {"model": model}}
    if recording.has_temp and len(prior.degc) > 1:
        prefill(prior.degc, prior.bias_dps, recording.scales, state)
        files["prefilled"] = {"from_state": state}
    return files


def _error(
    recording: Recording, session: Session, files: dict[str, Any], from_s: float, to_s: float
) -> float | None:
    # of the made-up motion the accelerometer shows nothing
    table = replay(recording, options=AT_REST_ALONE, **files).table
    assert table is not None
    bias_dps = block_means(table.to_batches(), session) / recording.scales.gyro_lsb_per_dps
    errors = error_mdps(session, bias_dps, from_s, to_s)
    return None if errors is None else float(np.sqrt(np.mean(np.square(errors))))


# Measured beside the prior as a model: a new device lies off the part's level by more than a
# power-on's offset ever does, so the firmware holds its first rests back as implausible, and the
# estimators at other temperatures keep the part's level, not the device's.
def prefill(
    degc: np.ndarray, bias_dps: np.ndarray, scales: Scales, state: str | PathLike[str]
) -> None:
    """Write the state of a firmware that rested at eight temperatures of a curve: the other way to
    start a device from the part.

    degc: (n,) rising, bias_dps: (n, 3). Each rest is just long enough to be kept for long.
    """
    steps = np.linspace(degc[0], degc[-1], _STEPS)
    each = round(_SECONDS_A_STEP * scales.odr_hz)
    warm = np.repeat(steps, each)
    rates = np.stack([np.interp(warm, degc, bias_dps[:, a]) for a in range(3)], axis=1)
    rng = np.random.default_rng(1)
    rates = (rates + rng.normal(0, _NOISE_DPS, rates.shape)) * scales.gyro_lsb_per_dps
    replay(_recording(warm, rates, scales, rng), state=state, options=AT_REST_ALONE)


def _recording(warm, rates_lsb, scales: Scales, rng) -> Recording:
    n = len(warm)
    columns = {"t_us": (np.arange(n) * 1e6 / scales.odr_hz).astype(np.int64)}
    for axis, name in enumerate("xyz"):
        columns[f"g{name}"] = np.rint(rates_lsb[:, axis]).astype(np.int32)
        if scales.accel_lsb_per_g:
            level = scales.accel_lsb_per_g if name == "z" else 0.0
            columns[f"a{name}"] = np.rint(level + rng.normal(0, 20, n)).astype(np.int32)
    raw = (warm - (scales.temp_offset_degc or 0.0)) * (scales.temp_lsb_per_degc or 0.0)
    columns["temp"] = np.rint(raw).astype(np.int32)
    return Recording(columns, scales, "prior")


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
    priors = [_prior(names, curves, fold_of, fold, scales) for fold in range(FOLDS)]
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


def _prior(names, curves, fold_of, fold: int, scales: Scales) -> Prior:
    rest = [i for i, name in enumerate(names) if fold_of[name] != fold]
    part = part_of([names[i] for i in rest], [curves[i] for i in rest])
    assert part is not None
    curve = prior_json(part)["curve"]
    degc = np.array([point["degc"] for point in curve])
    bias_dps = np.array([point["bias_dps"] for point in curve])
    return Prior(encoded(prior_model(part, scales)), degc, bias_dps)


def _summary(found: dict[str, Any], minutes: float) -> dict[str, Any]:
    """Per scenario and way median and 95th percentile over devices, mdps, and the paired gain."""
    scenarios = {}
    for name in SCENARIOS:
        rows = [device[name] for device in found.values() if name in device]
        if rows:
            ways = [way for way in WAYS if way in rows[0]]
            columns = {way: np.array([row[way] for row in rows]) for way in ways}
            scenarios[name] = {**_errors(columns), "gain": _gain(columns), "devices": len(rows)}
    return {"minutes": minutes, "devices": len(found), "folds": FOLDS, "scenarios": scenarios}


def _errors(columns: dict[str, np.ndarray]) -> dict[str, dict[str, float]]:
    return {
        way: {"median_mdps": float(np.median(v)), "p95_mdps": float(np.quantile(v, 0.95))}
        for way, v in columns.items()
    }


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
