"""The tables of `bench motion`, each figure beside what it must be."""

from collections.abc import Iterator, Mapping

import numpy as np

from .motion import FLICKER_SEEDS, FLICKERS_MDPS, run
from .tables import table

__all__ = ["LIMITS_MDPS", "in_markdown", "run"]

# most RMS error of the decision after two minutes, mdps, of every seed or of the median one; None:
# no window may be learned wrongly
LIMITS_MDPS: dict[str, float | None] = {
    "never-rests": 15.0,
    "rests-30": 10.0,
    "short-rests": 6.0,
    "trembling": 30.0,
    "slow-tilt": 20.0,
    "slow-log": 30.0,
    "turntable": None,
    "turntable-vertical": None,
    "car": None,
}
_BY_MEDIAN = {"never-rests"}
_DECISION = "decision"
_SCENES = {
    "never-rests": "swings, strides and waves, never at rest",
    "rests-30": "the same, at rest 30 % of the time",
    "short-rests": "handled, rests of one second",
    "trembling": "a trembling hand",
    "slow-tilt": "a boat that tilts slowly",
    "slow-log": "the same at 5 samples a second",
    "turntable": "one slow turn about a level axis",
    "turntable-vertical": "one slow turn about the vertical",
    "car": "a car in curves",
}
_MEDIANS = {"vqf, clip 25 dps": "vqf, clip 25 dps", "rests alone": "zerorate, rests alone"}
_HONESTY = """\
Truth within two sigma, mean over the seeds; must be 90 % of a source's verdicts, and of the \
decision at the end of each ten seconds:
"""
_FLICKER = f"""\
Truth within two sigma, by flicker noise of the part, mean of {len(FLICKER_SEEDS)} seeds:
"""
_FLICKER_HEAD = ["", *(f"{mdps} mdps" for mdps in FLICKERS_MDPS)]
_SETTLING = """\
Against gravity, a device at rest with biases of 2.0 and -1.5 dps; within 50 mdps after, ripple \
(standard deviation) and mean error of the last 200 s:
"""
_SETTLING_HEAD = ["form", "s", "ripple, mdps", "mean error, mdps"]
_BROAD = "BROAD, RMS error after one minute, mdps: median over trials and axes (mean):\n"
_BROAD_HEAD = ["", "whole trial", "its motion alone", "motion: truth within 2 sigma"]
_TRUTH_HEAD = ["trial", "bias", "one sigma", "by its motion alone", "one sigma"]
_TRUTH = ("bias_dps", "sigma_dps", "motion_dps", "motion_sigma_dps")


def in_markdown(found: Mapping) -> str:
    return "\n".join(_parts(found))


def _parts(found: Mapping) -> Iterator[str]:
    scenarios = found["simulated"]
    yield "# Bias without rest, measured\n\n`zerorate bench motion` wrote this page.\n"
    yield "Simulated, RMS error after two minutes, mdps, median over the seeds:\n"
    yield table(["device", *_MEDIANS.values(), "zerorate"], list(_medians(scenarios)))
    yield "The same of each seed (windows learned):\n"
    yield table(["", *scenarios], list(_errors(scenarios)))
    yield _HONESTY
    yield table(["", *scenarios], list(_honesty(scenarios)))
    yield _FLICKER
    yield table(_FLICKER_HEAD, list(_by_flicker(found["flicker"])))
    yield _SETTLING
    yield table(_SETTLING_HEAD, [[form, *row.values()] for form, row in found["settling"].items()])
    yield f"A sample of each source on a Cortex-M0+, in cycles: {_cost(found['cost'])}\n"
    if "broad" in found:
        broad = found["broad"]
        yield _BROAD
        yield table(_BROAD_HEAD, list(_on_broad(broad)))
        yield _beside_vqf(broad) + "\n"
        yield "True bias by the optical attitude, dps:\n"
        yield table(_TRUTH_HEAD, list(_truth(broad["trials"])))


def _medians(scenarios: Mapping) -> Iterator[list[str]]:
    for name, rows in scenarios.items():
        errors = [np.median(rows[way]["rms_mdps"]) for way in (*_MEDIANS, _DECISION)]
        yield [f"{name}: {_SCENES[name]}", *(f"{x:,.1f}" for x in errors)]


def _errors(scenarios: Mapping) -> Iterator[list[str]]:
    for way in next(iter(scenarios.values())):
        yield [way, *(_cell(rows[way]) for rows in scenarios.values())]
    yield ["**must be**", *(_wanted(name) for name in scenarios)]
    yield ["**met**", *(_kept(scenarios, name) for name in scenarios)]


def _cell(row: Mapping) -> str:
    learned = f" ({row['learned']})" if row["learned"] else ""
    return ", ".join(f"{x:.1f}" for x in row["rms_mdps"]) + learned


def _wanted(name: str) -> str:
    limit = LIMITS_MDPS[name]
    if limit is None:
        return "wrongly learned 0"
    return f"decision <= {limit:.0f}" + (", median" if name in _BY_MEDIAN else "")


def _kept(scenarios: Mapping, name: str) -> str:
    limit, rows = LIMITS_MDPS[name], scenarios[name]
    if limit is None:
        return "yes" if rows["in motion"]["wrong"] == 0 else "**no**"
    errors = rows[_DECISION]["rms_mdps"]
    judged = np.median(errors) if name in _BY_MEDIAN else max(errors)
    return "yes" if judged <= limit else "**no**"


def _honesty(scenarios: Mapping) -> Iterator[list[str]]:
    for way in next(iter(scenarios.values())):
        within = [rows[way]["within"] for rows in scenarios.values()]
        if any(within):
            yield [way, *(f"{100 * np.mean(one):.0f} %" if one else "" for one in within)]


def _by_flicker(scenes: Mapping) -> Iterator[list[str]]:
    for name, shares in scenes.items():
        yield [name, *(f"{100 * share:.0f} %" for share in shares)]


def _cost(found: Mapping | str) -> str:
    if isinstance(found, str):
        return f"not counted: {found}"
    costs = [
        f"{source} {one['cycles']:,.0f}, at worst {one['cycles_worst']:,.0f}"
        for source, one in found.items()
    ]
    return "; ".join(costs) + "."


def _on_broad(broad: Mapping) -> Iterator[list[str]]:
    for way in broad["whole"]:
        cells = []
        for part in ("whole", "motion"):
            errors = _errors_of(broad[part][way])
            cells.append(f"{np.median(errors):.0f} ({np.mean(errors):.0f})")
        inside = [row.get("within_two_sigma") for row in broad["motion"][way].values()]
        known = [x for x in inside if x is not None]
        yield [way, *cells, f"{100 * np.mean(known):.0f} %" if known else ""]


def _truth(trials: Mapping) -> Iterator[list[str]]:
    for name, truth in trials.items():
        yield [name, *(" ".join(f"{x:.3f}" for x in truth[column]) for column in _TRUTH)]


def _beside_vqf(broad: Mapping) -> str:
    ours, theirs = (np.median(_errors_of(broad["whole"][way])) for way in (_DECISION, "vqf"))
    kept = "yes" if ours <= theirs else "**no**"
    return f"The decision must be at or below vqf on the whole trial: {kept}."


def _errors_of(rows: Mapping) -> list[float]:
    return [x for row in rows.values() for x in row["rms_mdps"]]
