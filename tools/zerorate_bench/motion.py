"""Bias without rest: both sources and the decision beside vqf, simulated and on BROAD."""

from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from zerorate_tools.demo.broad import Trial, TrueBias, rms_mdps, trials, true_bias
from zerorate_tools.errors import MissingRuntime
from zerorate_tools.peers import Given, Peer, given, vqf_default
from zerorate_tools.simulate import simulate
from zerorate_tools.simulate.description import load_description
from zerorate_tools.simulate.schema import Description

from .native.native_cost import source_cost
from .peers import Decision, Judged, Source, vqf_clip_raised
from .tables import measured, table

#: Scene -> its words, and the most RMS error of the decision after two minutes, mdps, of every seed
#: or of the median one; None: no window may be learned wrongly.
SCENARIOS: dict[str, tuple[str, float | None]] = {
    "never-rests": ("swings, strides and waves, never at rest", 15.0),
    "rests-30": ("the same, at rest 30 % of the time", 10.0),
    "short-rests": ("handled, rests of one second", 6.0),
    "trembling": ("a trembling hand", 30.0),
    "slow-tilt": ("a boat that tilts slowly", 20.0),
    "slow-log": ("the same at 5 samples a second", 30.0),
    "turntable": ("one slow turn about a level axis", None),
    "turntable-vertical": ("one slow turn about the vertical", None),
    "car": ("a car in curves", None),
}
SEEDS = (1, 2, 3, 4, 5)
SETTLED_S = 120.0
TRIAL_SETTLED_S = 60.0
#: What sigma expects of a part until its rests tell: the scenes' own parts have white noise alone.
FLICKER_DPS = 0.002
FLICKERING = f"decision, of a part with {1000 * FLICKER_DPS:g} mdps of flicker noise"
#: No estimator but a floor: what the windows tell of a bias whose curve over temperature is known.
TOLD = "in motion, curve over temperature given"
NEAR_MDPS = 50.0
_RIPPLE_S = 200.0
_OBSERVABLE = (0, 1)
_RESTING = {
    "name": "flat on a table",
    "seed": 1,
    "sensor": {"odr_hz": 100.0, "gyro_noise_dps": 0.05},
    "bias": {"b0": [2.0, -1.5, 0.7]},
    "session": [
        {
            "start_degc": 25.0,
            "temperature": [{"to": 25.0, "minutes": 15}],
            "motion": [{"kind": "rest", "minutes": 15}],
        }
    ],
}
_OWN_FORM = {"document": True, "threshold": 0}
FORMS: dict[str, dict[str, Any]] = {
    "coarse, then fine (the default)": {},
    "the document's own form, steps of 50 mdps": {**_OWN_FORM, "coarse_dps": 0.05},
    "the document's own form, steps of 12.5 mdps": {**_OWN_FORM, "coarse_dps": 0.0125},
}
FLICKERS_MDPS = (0, 1, 2, 4)
SCENES = ("rests-30", "short-rests", "turntable")
FLICKER_SEEDS = range(1, 11)


def peers() -> dict[str, Peer]:
    """Every way that is measured, by its name in the tables."""
    return {
        "vqf": vqf_default,
        "vqf, clip 25 dps": vqf_clip_raised,
        "in motion, the document's own form": Source("in_motion", document=True),
        "in motion": Source("in_motion"),
        "in motion, bias within 0.5 dps as vqf assumes": Source("in_motion", start_dps=0.5),
        "gravity, the document's own form": Source("gravity", document=True),
        "gravity": Source("gravity"),
        "decision, bias within 0.5 dps": Decision(motion_start_dps=0.5),
        "rests alone": Decision(motion=False, gravity=False),
        "decision": Decision(),
    }


def simulated(ways: Mapping[str, Peer]) -> dict[str, Any]:
    """Scenario -> way -> each seed's RMS error after two minutes, mdps, windows, honesty."""
    found: dict[str, Any] = {}
    for name in measured(SCENARIOS):
        described = load_description(name)
        straight = replace(described, bias=replace(described.bias, b1=0.0, b2=0.0, b3=0.0))
        scenes: list[tuple[str | Description, Mapping[str, Peer]]] = [
            (name, ways),
            (with_flicker(name, FLICKER_DPS), {FLICKERING: Decision()}),
            (straight, {TOLD: Source("in_motion", slope_dps_per_degc=0.0001)}),
        ]
        rows = found[name] = {
            way: {"rms_mdps": [], "learned": 0, "wrong": 0, "within": []}
            for way in (*ways, FLICKERING, TOLD)
        }
        for seed, (scene, some) in product(SEEDS, scenes):
            _measure(rows, some, scene, seed)
    return found


def _measure(
    rows: dict[str, dict[str, Any]], ways: Mapping[str, Peer], scene: str | Description, seed: int
) -> None:
    one, bias = _seen(scene, seed)
    for way, peer in ways.items():
        with suppress(ValueError):  # too slow a rate for the source in motion
            error, row = _measured(peer, one, bias)
            after = round(SETTLED_S * one.odr_hz)
            rows[way]["rms_mdps"].append(round(rms_mdps(error[after:]), 1))
            for count in ("learned", "wrong") if row else ():
                rows[way][count] += row[count]
            if row and row["within_two_sigma"] is not None:
                rows[way]["within"].append(row["within_two_sigma"])


def _seen(scene: Any, seed: int | None = None) -> tuple[Given, NDArray[np.float64]]:
    """A scene's first session, and its true bias (n, 3), dps."""
    recording, truth = simulate(scene, session=1, seed=seed)
    return given(recording), truth.bias_lsb / recording.scales.gyro_lsb_per_dps


def on_broad(ways: Mapping[str, Peer], folder: Path) -> dict[str, Any]:
    """trials: each one's true bias; whole, motion: way -> errors per trial and axis, mdps."""
    found: dict[str, Any] = {"trials": {}, "whole": defaultdict(dict), "motion": defaultdict(dict)}
    for trial in measured(list(trials(folder))):
        truth = true_bias(trial)
        found["trials"][trial.name] = {n: np.round(v, 5).tolist() for n, v in vars(truth).items()}
        for part, cut in (("whole", trial), ("motion", trial.in_motion())):
            for way, peer in ways.items():
                found[part][way][trial.name] = _on_trial(peer, cut, truth)
    return found


def _on_trial(peer: Peer, trial: Trial, truth: TrueBias) -> dict[str, Any]:
    one = given(trial.recording())
    error, row = _measured(peer, one, np.tile(truth.bias_dps, (len(one.rate_dps), 1)))
    error = error[round(TRIAL_SETTLED_S * trial.hz) :]
    return {"rms_mdps": [round(rms_mdps(axis), 1) for axis in error.T], **row}


def _measured(
    peer: Peer, one: Given, bias: NDArray[np.float64]
) -> tuple[NDArray[np.float64], dict[str, Any]]:
    """(n, 3) error, dps; of a peer that says how sure it is, what it learned, too."""
    if isinstance(peer, Judged):
        peer.truth_dps = [bias]
    error = peer([one])[0] - bias
    if not isinstance(peer, Judged):
        return error, {}
    inside = float(np.mean(peer.within)) if peer.within else None
    return error, {"learned": peer.learned, "wrong": peer.wrong, "within_two_sigma": inside}


def run(data: Path | None) -> dict[str, Any]:
    """Measure and return all figures.

    data: the folder of BROAD's .mat files; without it only the simulated table is made.
    Raises ZerorateError for a folder without one.
    """
    ways = peers()
    found: dict[str, Any] = {} if data is None else {"broad": on_broad(ways, data)}
    found |= {"simulated": simulated(ways), "flicker": by_flicker(), "settling": settling()}
    try:
        return found | {"cost": source_cost()}
    except MissingRuntime as error:
        return found | {"cost": str(error)}


def settling() -> dict[str, Any]:
    """Form -> seconds until within 50 mdps, and the ripple (standard deviation) at the end, mdps.

    On a device that lies flat with biases of 2.0 and -1.5 dps on its level axes; the slower, and
    the worse, of the two. The third axis points along gravity and is not observable.
    """
    one, bias = _seen(_RESTING)
    found = {}
    for form, options in FORMS.items():
        error = 1000 * (Source("gravity", **options)([one])[0] - bias)[:, _OBSERVABLE]
        near = np.abs(error) < NEAR_MDPS
        first = np.where(near.any(axis=0), near.argmax(axis=0) / one.odr_hz, np.inf)
        last = error[-round(_RIPPLE_S * one.odr_hz) :]
        found[form] = {
            "seconds": round(float(first.max()), 1),
            "ripple_mdps": round(float(last.std(axis=0).max()), 1),
            "mean_mdps": round(float(np.abs(last.mean(axis=0)).max()), 1),
        }
    return found


def by_flicker() -> dict[str, list[float]]:
    """Scene -> mean share of the truth within two sigma, for each flicker noise."""
    found: dict[str, list[float]] = {}
    for name in SCENES:
        scenes = [with_flicker(name, mdps / 1000) for mdps in FLICKERS_MDPS]
        shares = [[_within(scene, seed) for scene in scenes] for seed in FLICKER_SEEDS]
        found[name] = [round(float(share), 4) for share in np.mean(shares, axis=0)]
    return found


def with_flicker(name: str, flicker_dps: float) -> Description:
    """The bundled scene, its part with that flicker noise."""
    described = load_description(name)
    return replace(described, noise=replace(described.noise, bias_instability_dps=flicker_dps))


def _within(scene: Description, seed: int) -> float:
    firmware = Decision()
    _measured(firmware, *_seen(scene, seed))
    return float(np.mean(firmware.within))


_BY_MEDIAN = {"never-rests"}
_DECISION = "decision"
_MEDIANS = {"vqf, clip 25 dps": "vqf, clip 25 dps", "rests alone": "zerorate, rests alone"}
_HONESTY = """\
Truth within two sigma, mean over the seeds; must be 90 % of a source's verdicts, and of the \
decision at the end of each ten seconds:
"""
_FLICKER = f"""\
Truth within two sigma, by flicker noise of the part, mean of {len(FLICKER_SEEDS)} seeds:
"""
_SETTLING = """\
Against gravity, a device at rest with biases of 2.0 and -1.5 dps; within 50 mdps after, ripple \
(standard deviation) and mean error of the last 200 s:
"""
_SETTLING_HEAD = ["form", "s", "ripple, mdps", "mean error, mdps"]
_BROAD = "BROAD, RMS error after one minute, mdps: median over trials and axes (mean):\n"
_BROAD_HEAD = ["", "whole trial", "its motion alone", "motion: truth within 2 sigma"]
_TRUTH_HEAD = ["trial", "bias", "one sigma", "by its motion alone", "one sigma"]
_TRUTH = ("bias_dps", "sigma_dps", "motion_dps", "motion_sigma_dps")


def in_markdown(found: Mapping[str, Any]) -> str:
    return "\n".join(_parts(found))


def _parts(found: Mapping[str, Any]) -> Iterator[str]:
    scenarios, ways = found["simulated"], list(next(iter(found["simulated"].values())))
    yield "# Bias without rest, measured\n\n`zerorate bench motion` wrote this page.\n"
    yield "Simulated, RMS error after two minutes, mdps, median over the seeds:\n"
    rows: list[list[str]] = []
    for name, of in scenarios.items():
        errors = [np.median(of[way]["rms_mdps"]) for way in (*_MEDIANS, _DECISION)]
        rows.append([f"{name}: {SCENARIOS[name][0]}", *(f"{x:,.1f}" for x in errors)])
    yield table(["device", *_MEDIANS.values(), "zerorate"], rows)
    yield "The same of each seed (windows learned):\n"
    rows = [[way, *(_cell(of[way]) for of in scenarios.values())] for way in ways]
    wanted, met = zip(*(_kept(of, name) for name, of in scenarios.items()))
    yield table(["", *scenarios], [*rows, ["**must be**", *wanted], ["**met**", *met]])
    yield _HONESTY
    within = {way: [of[way]["within"] for of in scenarios.values()] for way in ways}
    rows = [[way, *map(_percent, shares)] for way, shares in within.items() if any(shares)]
    yield table(["", *scenarios], rows)
    yield _FLICKER
    rows = [[name, *(_percent([s]) for s in shares)] for name, shares in found["flicker"].items()]
    yield table(["", *(f"{mdps} mdps" for mdps in FLICKERS_MDPS)], rows)
    yield _SETTLING
    yield table(_SETTLING_HEAD, [[form, *row.values()] for form, row in found["settling"].items()])
    yield f"A sample of each source on a Cortex-M0+, in cycles: {_cost_words(found['cost'])}\n"
    if "broad" in found:
        yield from _of_broad(found["broad"])


def _percent(shares: Sequence[float]) -> str:
    return f"{100 * np.mean(shares):.0f} %" if shares else ""


def _cell(row: Mapping[str, Any]) -> str:
    learned = f" ({row['learned']})" if row["learned"] else ""
    return ", ".join(f"{x:.1f}" for x in row["rms_mdps"]) + learned


def _kept(rows: Mapping[str, Any], name: str) -> tuple[str, str]:
    """What a scene's decision must keep, and whether it does."""
    limit = SCENARIOS[name][1]
    if limit is None:
        return "wrongly learned 0", "**no**" if rows["in motion"]["wrong"] else "yes"
    of, words = (np.median, ", median") if name in _BY_MEDIAN else (max, "")
    met = of(rows[_DECISION]["rms_mdps"]) <= limit
    return f"decision <= {limit:.0f}{words}", "yes" if met else "**no**"


def _cost_words(found: Mapping[str, Any] | str) -> str:
    if isinstance(found, str):
        return f"not counted: {found}"
    costs = (
        f"{source} {one['cycles']:,.0f}, at worst {one['cycles_worst']:,.0f}"
        for source, one in found.items()
    )
    return "; ".join(costs) + "."


def _of_broad(broad: Mapping[str, Any]) -> Iterator[str]:
    rows, whole = [], {}
    for way in broad["whole"]:
        errors = [
            [x for row in broad[part][way].values() for x in row["rms_mdps"]]
            for part in ("whole", "motion")
        ]
        whole[way] = np.median(errors[0])
        inside = [row.get("within_two_sigma") for row in broad["motion"][way].values()]
        cells = [f"{np.median(some):.0f} ({np.mean(some):.0f})" for some in errors]
        rows.append([way, *cells, _percent([x for x in inside if x is not None])])
    yield _BROAD
    yield table(_BROAD_HEAD, rows)
    kept = "yes" if whole[_DECISION] <= whole["vqf"] else "**no**"
    yield f"The decision must be at or below vqf on the whole trial: {kept}.\n"
    yield "True bias by the optical attitude, dps:\n"
    rows = [
        [name, *(" ".join(f"{x:.3f}" for x in truth[column]) for column in _TRUTH)]
        for name, truth in broad["trials"].items()
    ]
    yield table(_TRUTH_HEAD, rows)
