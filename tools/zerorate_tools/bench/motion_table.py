"""The tables of `bench motion`, each figure beside what it must be."""

from collections.abc import Mapping, Sequence

import numpy as np

from .motion import run

__all__ = ["LIMITS_MDPS", "run", "table"]

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


def table(found: Mapping) -> str:
    """All tables as Markdown."""
    scenarios = found["simulated"]
    lines = ["# Bias without rest, measured", "", "`zerorate bench motion` wrote this page.", ""]
    lines += ["Simulated, RMS error after two minutes, mdps, each seed (windows learned):", ""]
    lines += _head(["", *scenarios])
    for way in next(iter(scenarios.values())):
        cells = [_cell(rows[way]) for rows in scenarios.values()]
        lines.append(f"| {way} | " + " | ".join(cells) + " |")
    wanted = [_wanted(name) for name in scenarios]
    lines.append("| **must be** | " + " | ".join(wanted) + " |")
    lines.append(
        "| **is it?** | " + " | ".join(_kept(scenarios, name) for name in scenarios) + " |"
    )
    lines += ["", *_honesty_lines(scenarios)]
    lines += ["", *_settling_lines(found["settling"])]
    lines += ["", "A sample of each source on a Cortex-M0+, in cycles: " + _cost(found["cost"])]
    if "broad" in found:
        lines += ["", *_broad_lines(found["broad"])]
    return "\n".join(lines)


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


def _honesty_lines(scenarios: Mapping) -> list[str]:
    lines = [
        "Truth within two sigma, mean over the seeds; must be 90 % of a source's verdicts, and of "
        "the decision at the end of each ten seconds:",
        "",
    ]
    lines += _head(["", *scenarios])
    for way in next(iter(scenarios.values())):
        within = [rows[way]["within"] for rows in scenarios.values()]
        if any(within):
            cells = [f"{100 * np.mean(one):.0f} %" if one else "" for one in within]
            lines.append(f"| {way} | " + " | ".join(cells) + " |")
    return lines


def _cost(found: Mapping | str) -> str:
    if isinstance(found, str):
        return f"not counted: {found}"
    costs = [
        f"{source} {one['cycles']:,.0f}, at worst {one['cycles_worst']:,.0f}"
        for source, one in found.items()
    ]
    return "; ".join(costs) + "."


def _settling_lines(forms: Mapping) -> list[str]:
    lines = [
        "Against gravity, a device at rest with biases of 2.0 and -1.5 dps; within "
        "50 mdps after, ripple (standard deviation) and mean error of the last 200 s:",
        "",
    ]
    lines += _head(["form", "s", "ripple, mdps", "mean error, mdps"])
    for form, row in forms.items():
        cells = (row["seconds"], row["ripple_mdps"], row["mean_mdps"])
        lines.append(f"| {form} | " + " | ".join(str(cell) for cell in cells) + " |")
    return lines


def _broad_lines(broad: Mapping) -> list[str]:
    lines = ["BROAD, RMS error after one minute, mdps: median over trials and axes (mean):", ""]
    lines += _head(["", "whole trial", "its motion alone", "motion: truth within 2 sigma"])
    for way in broad["whole"]:
        cells = []
        for part in ("whole", "motion"):
            errors = [x for row in broad[part][way].values() for x in row["rms_mdps"]]
            cells.append(f"{np.median(errors):.0f} ({np.mean(errors):.0f})")
        inside = [row.get("within_two_sigma") for row in broad["motion"][way].values()]
        known = [x for x in inside if x is not None]
        cells.append(f"{100 * np.mean(known):.0f} %" if known else "")
        lines.append(f"| {way} | " + " | ".join(cells) + " |")
    lines += ["", _beside_vqf(broad)]
    lines += ["", "True bias by the optical attitude, dps:", ""]
    lines += _head(["trial", "bias", "one sigma", "by its motion alone", "one sigma"])
    for name, truth in broad["trials"].items():
        columns = ("bias_dps", "sigma_dps", "motion_dps", "motion_sigma_dps")
        cells = [" ".join(f"{x:.3f}" for x in truth[column]) for column in columns]
        lines.append(f"| {name} | " + " | ".join(cells) + " |")
    return lines


def _beside_vqf(broad: Mapping) -> str:
    ours, theirs = (_median(broad["whole"][way]) for way in (_DECISION, "vqf"))
    kept = "yes" if ours <= theirs else "**no**"
    return f"The decision must be at or below vqf on the whole trial: {kept}."


def _median(rows: Mapping) -> float:
    return float(np.median([x for row in rows.values() for x in row["rms_mdps"]]))


def _head(cells: Sequence[str]) -> list[str]:
    return ["| " + " | ".join(cells) + " |", "|" + "---|" * len(cells)]
