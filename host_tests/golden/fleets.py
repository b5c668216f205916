"""What a fleet's devices have in common, of parts made by hand."""

from dataclasses import replace

import numpy as np
import pyarrow as pa
from zerorate_tools.fleet import plots
from zerorate_tools.fleet.fleet_in_words import table_of
from zerorate_tools.fleet.job import block_means, error_mdps
from zerorate_tools.fleet.part import curve_effects, part_of, step_effects
from zerorate_tools.fleet.population import curve_of
from zerorate_tools.fleet.prior import _summary, moving_from, prior_json, prior_model
from zerorate_tools.loop.read.sessions import Session
from zerorate_tools.recordings import Recording, Scales
from zerorate_tools.report.page import plain

_FOUND = {"effect": "thermal-lag", "confidence": "confirmed", "before_mdps": [5, 5, 3],
          "after_mdps": [3, 5, 5]}  # fmt: skip


def _device(rng, number, tempered, power_ons, far=10):
    """Power-ons of a device over 25 degrees, with gaps; two of many are unlike the others."""
    sessions = []
    level = rng.normal(0.5, 0.3) + 9.0 * (number == far)
    slope = rng.normal(0.02, 0.002) + 0.1 * (number == 12)
    for one in range(power_ons):
        degc = np.linspace(12 + number % 4 + one, 37 + one, 90)
        noise = np.cumsum(rng.normal(0, 1e-3, (90, 3)), axis=0) + rng.normal(0, 4e-3, (90, 3))
        course = level + slope * (degc - 25) + 1e-4 * (number % 3) * (degc - 25) ** 2
        rates = course[:, None] * [1, -0.5, 0.1] + rng.normal(0, 0.02, 3) + noise
        rates[40:44] = np.nan
        temp = {"temp": degc} if tempered else {}
        sessions.append(Session(str(one), 5.0, 1, rates, np.ones(90), temp, start_us=7_000_000))
    return sessions


def _part_of(seed, number, tempered=True, far=10):
    rng = np.random.default_rng(seed)
    curves = [curve_of(_device(rng, n, tempered, 1 + n % 3, far)) for n in range(number)]
    return part_of([f"d{n}" for n in range(number)], curves)


def _told(part):
    """Curves of a part's devices, and what is made of them."""
    warm, curves = Scales("X", 25.0, 131.0, None, 340.0, 36.53), part.curves
    models = [prior_model(part, scales) for scales in (warm, Scales("X", 25.0, 131.0))]
    kept = ("own", "own_covariance", "p_unusual", "used", "mean_covariance")
    own = {name: [getattr(a, name).ravel().tolist() for a in part.axes] for name in kept}
    slots = [[s.coefficient_dps, vars(s.term)] for m in models for s in m.slots]
    return {
        "curves": [[c.information.ravel().tolist(), c.score.tolist(), c.to_json()["degc"], c.blocks]
                   for c in curves], "shown": [c.shown for c in curves],
        "effects": curve_effects(part), "own": own, "json": prior_json(part), "slots": slots,
        "centre": part.to_centre.tolist(), "few": part_of(["a"] * 4, curves[:4]),
    }  # fmt: skip


def _shown(part):
    """Rows of the table of some of a part's devices and of one that is in none, and the plots."""
    results = [
        {"device": f"d{n}", "curve": c.to_json(), "sessions": [0] * (1 + n % 3), "steps": []}
        for n, c in enumerate(part.curves[:2])
    ]
    alone = {"device": "lone", "steps": [_FOUND | {"p_value": 0.25}], "sessions": [0]}
    rows = table_of([*results, results[1] | alone, results[0] | {"curve": None}], part)
    return [rows.to_pylist(), *map(plain, plots.plots_of({"prior": None}, part))]


def _steps():
    """What close found in 40 devices: an effect of all, of half of them, of a few."""
    step = _FOUND | {"effect": "of all"}
    half = step | {"effect": "of half", "confidence": "tentative", "before_mdps": [9, 4, 1]}
    return step_effects([
        {"device": f"d{n}", "steps": [step, step] * (n < 38) + [half] * (n % 2)
         + [half | {"effect": "of few"}] * (n < 3)} for n in range(40)
    ])  # fmt: skip


def parts_of_a_fleet():
    """Of parts made by hand: their devices' curves, what they share, priors, what close found."""
    (session, *_) = _device(np.random.default_rng(1), 0, True, 1)
    bias = np.linspace(0.3, 0.6, 90)[:, None] * [1, -0.5, 0.1]
    errors = [error_mdps(session, bias, *of) for of in ((), (60.0,), (60.0, 300.0), (445.0, 449.0))]
    at = np.arange(40)
    t_us = 7_000_000 + at * 1_250_000 + 90_000_000 * (at > 30)
    biases = {f"bias_g{axis}": np.sin(at / n) for n, axis in enumerate("xyz", 2)}
    batches = pa.table({"t_us": t_us, **biases}).to_batches(max_chunksize=9)
    means = block_means(batches, replace(session, rate_dps=bias[:12]))
    columns = {"t_us": at * 40_000 + 9, "gx": at, "gy": 9 * at, "gz": 0 * at + 31_000}
    swung = moving_from(Recording(columns, Scales("X", 25.0, 131.0), "swung"), 0.6).columns
    rows = ({"without": 9.0 + n, "prior": 4.0 + n * n / 9} for n in range(12))
    gains = {str(n): {"always-at-rest": row} for n, row in enumerate(rows)}
    return {
        "fifteen": _told(_part_of(1, 15)), "six": _told(_part_of(2, 6)),
        "five": _told(_part_of(4, 5, far=4)), "cold": _told(_part_of(3, 9, tempered=False)),
        "shown": _shown(_part_of(1, 15)),
        "few blocks": curve_of([Session("s", 5.0, 1, np.ones((4, 3)), np.ones(4))]),
        "steps": _steps(), "errors": errors, "benefit": _summary(gains, 2.0),
        "means": means.T.tolist(), "swung": [swung[name].tolist() for name in ("gx", "gy", "gz")],
    }  # fmt: skip
