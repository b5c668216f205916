"""What a prior is worth: on devices that it was not made from."""

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import Any

import numpy as np
from scipy import stats

from ..model import encoded
from ..recordings import Scales
from .first_minutes import SCENARIOS, WAYS, Prior, try_batch
from .job import one_line
from .part import part_of
from .prior import prior_json, prior_model

FOLDS = 5
LEAST_DEVICES = 10
MOST_DEVICES = 200
_PER_TASK = 16

Task = tuple[str, str, int]
Runner = Callable[[Callable[[list], Any], list[list]], Iterator[tuple[list, Any]]]


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
