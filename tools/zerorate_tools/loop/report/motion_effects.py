"""Effects not fitted on blocks, in the form of the report: of motion, and periodic ones."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from ..motion.by_windows import RateScale
from ..motion.scales_and_timing import Timing
from ..read.lines import Line
from ..search.periodic import QUICK_HZ
from ..verify.analysis import Analysis


def motion_effects(analysis: Analysis, after_mdps: list[float]) -> list[dict[str, Any]]:
    """Effects in report.json's form. after_mdps: of the blocks held out: these leave it."""
    motion = analysis.motion
    same = {"before_mdps": after_mdps, "after_mdps": after_mdps, "confounded_with": []}
    out = []
    if motion.scales is not None:
        out.append({**turning(motion.scales), **same})
    if motion.timing is not None and motion.timing.found:
        out.append({**_timing(motion.timing), **same})
    slow = (line for line in analysis.lines if line.hz < QUICK_HZ)
    return [*out, *({**_line(line, analysis.few), **same} for line in slow)]


def interference(lines: list[Line]) -> list[dict[str, Any]]:
    """Quick lines in report.json's form: they average out of the bias, so they are no effects."""
    return [
        {
            "kind": "line",
            "hz": line.hz,
            "size_mdps": [round(float(1e3 * a), 3) for a in line.amplitude_dps],
            "p_value": line.p_value,
            "in_what_was_held_out": line.in_holdout,
        }
        for line in lines
        if line.hz >= QUICK_HZ
    ]


def heading_of(t: RateScale) -> dict[str, float]:
    """Degrees a minute of heading lost before and after, by the entries, and where an attitude
    tells."""
    names = ("lost_before", "lost_after", "heading_before", "heading_after")
    return dict(zip(names, np.round([*t.lost, *(t.heading or ())], 3).tolist()))


def heading_in_words(m: Mapping[str, Any]) -> str:
    """A clause each of what the entries tell and, if there is one, an attitude."""
    before, after = f"{m['lost_before']:.2f}", f"{m['lost_after']:.2f}"
    said = f"it turns the heading by {before} -> {after} degrees a minute"
    if before == after:  # axes turned alike
        said = "it changes the tilt, not the heading"
    if "heading_before" not in m:
        return said
    return f"{said}; against the attitude {m['heading_before']:.2f} -> {m['heading_after']:.2f}"


def turning(t: RateScale) -> dict[str, Any]:
    names = ("rate_x", "rate_y", "rate_z")
    heading = heading_of(t)
    return {
        "effect": t.kind,
        "sources": list(names),
        "parameters": [{"source": n, "limit_dps": float(f)} for n, f in zip(names, t.fastest_dps)],
        "coefficients": {n: [float(v) for v in c] for n, c in zip(names, t.deployed.T)},
        "deviation": {n: [float(v) for v in c] for n, c in zip(names, t.deviation.T)},
        "confidence": "confirmed" if t.confirmed else "tentative",
        "p_value": t.p_value,
        "in_motion": {"before": t.before, "after": t.after, "unit": t.unit, **heading},
        "said": f"{t.kind} over {t.runs} windows, measured beside {t.reference}; it does not "
        f"show at rest, where before and after are measured; {heading_in_words(heading)}",
    }


def _timing(t: Timing) -> dict[str, Any]:
    late = "late" if t.delay_s > 0 else "early"
    return {
        "effect": "sample-timing",
        "sources": ["time"],
        "parameters": [{"delay_s": t.delay_s, "deviation_s": t.deviation_s}],
        "coefficients": {},
        "confidence": "tentative",
        "p_value": t.p_value,
        "said": f"readings are {1e3 * abs(t.delay_s):.2f} ms {late} beside the reference (or it "
        "beside them); no bias, so not corrected: shift the stamps",
    }


def _line(line: Line, few: bool) -> dict[str, Any]:
    size = ", ".join(f"{1e3 * a:.2f}" for a in np.atleast_1d(line.amplitude_dps))
    return {
        "effect": "periodic-interference",
        "sources": [],
        "parameters": [{"hz": line.hz, "period_s": 1.0 / line.hz}],
        "coefficients": {},
        "amplitude_mdps": [float(1e3 * a) for a in line.amplitude_dps],
        "confidence": "confirmed" if line.in_holdout and not few else "tentative",
        "p_value": line.p_value,
        "said": f"a line at {line.hz:.5g} Hz of {size} mdps; its phase is free at each power-on, "
        "so not corrected; record at a data rate 2 % higher: a line that moves is an alias",
    }
