"""report.json, as design.md has it, with what a person needs beside it."""

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from ...model.effects import is_free, of_any_channel
from ...model.model import Slot
from ..fit.resampling import block_bootstrap, rms
from ..fit.single import STEPS_CHOSEN, WEAKER
from ..fit.smooth import draw
from ..read.sessions import Session
from ..search.periodic import QUICK_HZ
from ..search.selection import Found, Selection
from ..search.steps import Step
from ..verify.analysis import Analysis, slots
from ..verify.courses import AFTER, BEFORE, ONLINE, ONLINE_BEFORE
from ..verify.judge import residuals, rms_dps
from .motion_effects import interference, motion_effects
from .unexplained import measure_next, not_excluded, what_is_known

#: Of an analysis that no recording was replayed for.
FLOAT = "float reference of the effect slots and the line, means of blocks"
CAUSE_UNKNOWN = "time since power-on; cause not identified"
#: Standard deviations on either side in an interval of 95 %.
_CI95 = 1.96
NO_TEMPERATURE = "; no temperature was recorded, and the warm-up of every power-on looks like this"


def report(analysis: Analysis) -> dict[str, Any]:
    """Plain values, ready for JSON. Every figure in mdps is of the held-out part."""
    j = analysis.judgement
    effects = [*_effects(analysis), *motion_effects(analysis, _mdps(j.after_dps))]
    return {
        "split": _split(analysis),
        "measured_by": analysis.measured.by if analysis.measured else FLOAT,
        "floor_mdps": _mdps(analysis.floor_dps),
        "before_mdps": _mdps(j.before_dps),
        "after_mdps": _mdps(j.after_dps),
        "ci95_mdps": {"before": _interval(j.residual_before), "after": _interval(j.residual_after)},
        "in_all": _in_all(analysis),
        **_by_kernels(analysis),
        "truth": _truth(analysis),
        "effects": effects,
        "steps": effects,  # their name before; goes with the next version
        "events": _events(analysis),
        "interference": interference(analysis.lines),
        "unexplained": {
            "rms_mdps": _mdps(j.after_dps),
            "what_is_known": what_is_known(analysis, j.after_dps),
            "measure_next": measure_next(analysis),
            "cannot_be_shown_by_these_recordings": not_excluded(analysis),
        },
        "smallest_detectable_mdps": {
            k: round(1e3 * v, 3) for k, v in analysis.selection.smallest_dps.items()
        },
        "gate": _gate(analysis),
        "verdict": verdict(analysis),
    }


def verdict(analysis: Analysis) -> str:
    """nothing-found, effects-found or unexplained-residual."""
    in_the_bias = any(line.hz < QUICK_HZ for line in analysis.lines)
    if analysis.selection.found or analysis.motion.found or in_the_bias:
        return "effects-found"
    return "unexplained-residual" if analysis.judgement.residual_test.left else "nothing-found"


def _mdps(values: Iterable[float | np.ndarray]) -> list[float]:
    return [round(float(1e3 * v), 4) for v in values]


def _interval(parts: list[np.ndarray]) -> list[list[float]]:
    low, high = block_bootstrap(parts, rms)
    return [[a, b] for a, b in zip(_mdps(low), _mdps(high))]


def _in_all(analysis: Analysis) -> dict[str, Any]:
    """Root mean squares over the three axes together."""
    j = analysis.judgement
    whole = _mdps([j.before_rms, j.after_rms, rms(analysis.floor_dps)])
    return {
        **dict(zip(("before_mdps", "after_mdps", "floor_mdps"), whole)),
        "ci95_mdps": {
            name: _mdps(block_bootstrap(parts, lambda rows: rms(rows.ravel())))
            for name, parts in (("before", j.residual_before), ("after", j.residual_after))
        },
    }


def _by_kernels(analysis: Analysis) -> dict[str, Any]:
    """What only the firmware's kernels can tell: learning online, turn-on offset, rounding."""
    m, floor = analysis.measured, analysis.floor_dps
    if m is None:
        offsets = analysis.judgement.offsets_dps
        return {"turn_on_offset_dps": {"after": [[float(x) for x in o] for o in offsets]}}
    before, after = m.residuals(ONLINE_BEFORE), m.residuals(ONLINE)
    return {
        "online": {
            "before_mdps": _mdps(rms_dps(before)),
            "after_mdps": _mdps(rms_dps(after)),
            "ci95_mdps": {"before": _interval(before), "after": _interval(after)},
            "in_all": {
                name: _mdps([rms(rms_dps(parts))])[0]
                for name, parts in (("before_mdps", before), ("after_mdps", after))
            },
        },
        "turn_on_offset_dps": {
            way: [[float(x) for x in o] for o in m.offsets(way)] for way in (BEFORE, AFTER)
        },
        "integer_rounding_mdps": _mdps(m.rounding_dps),
        "integer_rounding_of_floor": round(float((m.rounding_dps / floor).max()), 4),
    }


def _truth(analysis: Analysis) -> dict[str, str]:
    """What the rates are compared with, at rest and in motion."""
    earth, turning = analysis.sessions[0].earth, analysis.motion.rate_scale
    return {
        "at_rest": "zero rate; " + (earth.said if earth else "Earth's rotation is in the rates"),
        "in_motion": turning.reference if turning else "none, so samples in motion are not used",
    }


def _split(analysis: Analysis) -> dict[str, Any]:
    out: dict[str, Any] = {
        "unit": "time within one recording" if analysis.single else "power-on session",
        "train": [s.name for s in analysis.train],
        "test": [s.name for s in analysis.holdout],
        "block_s": analysis.sessions[0].block_s,
        "blocks": {s.name: int(s.available.sum()) for s in analysis.sessions},
    }
    if analysis.single:
        stepped = analysis.sessions[0].steps or analysis.sessions[0].listed
        out["how_much_weaker"] = WEAKER + (STEPS_CHOSEN if stepped else "")
    if analysis.measured and analysis.measured.inside:
        out["pieces_of"] = inside = analysis.measured.inside
        for way, effects in (("before", 0), ("after", len(analysis.selection.found))):
            left = analysis.measured.with_first(effects, inside)
            out[f"pieces_{way}_mdps"] = _mdps(rms_dps(left))
    return out


def _effects(analysis: Analysis) -> list[dict[str, Any]]:
    """Effects in the order found, each with the held-out part's error before and after it."""
    selection, out = analysis.selection, []
    fitted = slots(selection, analysis.coefficients)
    so_far = [_after(analysis, k) for k in range(len(selection.found) + 1)]
    at = 0
    for i, f in enumerate(selection.found):
        own = fitted[at : at + len(f.candidate.terms)]
        at += len(own)
        before, after = so_far[i], so_far[i + 1]
        out.append(
            {
                "effect": f.candidate.label,
                "sources": f.candidate.sources,
                "parameters": _parameters(own),
                "coefficients": {_name(s, own): list(s.coefficient_dps) for s in own},
                "confidence": analysis.confidence(i),
                "before_mdps": _mdps(rms_dps(before)),
                "after_mdps": _mdps(rms_dps(after)),
                "ci95_mdps": _interval(after),
                "p_value": f.decision.p_value,
                "confounded_with": f.confounded_with,
                "probabilities": {name: round(p, 2) for name, p in f.probabilities.items()},
                "likelihood_ratio": round(f.decision.ratio, 2),
                "noise_inflation": round(f.decision.inflation, 2),
                "nats_on_sessions_left_out": [round(float(g), 2) for g in f.decision.session_gains],
                "nats_on_holdout": round(float(analysis.judgement.gains[i]), 2),
                "said": _said(f)
                + (NO_TEMPERATURE if analysis.may_be_heat(i) else "")
                + _uncorrected_axes(f),
                **_lost(selection, i),
            }
        )
    return out


def _lost(selection: Selection, i: int) -> dict[str, float]:
    """Of a curve of any form, what the slot's one form for all axes loses of its squares."""
    [term, *more] = selection.found[i].candidate.terms
    if more or not is_free(term):
        return {}
    rest = selection.without(i)
    lost = draw(selection.regression, [*rest.straight, *rest.terms], term)[1]
    return {"lost_by_projection": round(lost, 4)}


def _name(slot: Slot, own: Sequence[Slot]) -> str:
    """A slot's source, with its power where an effect has several slots of one source; a bend with
    its place."""
    term = slot.term
    if term.knot is not None:
        return f"{term.source}>{term.centre + term.knot:.4g}"
    alone = sum(other.term.source == term.source for other in own) == 1
    return term.source if alone else f"{term.source}^{term.power}"


def _parameters(own: Sequence[Slot]) -> list[dict[str, Any]]:
    rows = [s.term.to_dict() for s in own]
    return [{k: v for k, v in row.items() if v not in (None, "none")} for row in rows]


def _said(found: Found) -> str:
    kind, sources = found.candidate.kind, ", ".join(found.candidate.sources)
    if kind in ("time-drift", "power-on-transient"):
        return CAUSE_UNKNOWN
    if of_any_channel(kind):
        return f"not in the catalogue; depends on {sources}; mechanism unknown"
    return f"{kind} of {sources}"


def _uncorrected_axes(found: Found) -> str:
    axes = [axis for axis, used in zip("xyz", found.axes) if not used]
    why = "where the error would grow"
    return f"; not corrected on {', '.join(axes)}, {why}" if axes else ""


def _after(analysis: Analysis, effects: int) -> list[np.ndarray]:
    """Residuals of the held-out part under the first so many effects alone."""
    if analysis.measured is not None:
        return analysis.measured.with_first(effects)
    return [r for r, _ in residuals(analysis.selection.first(effects), analysis.holdout)]


def _events(analysis: Analysis) -> list[dict[str, Any]]:
    """Steps as they were looked for before the effects: of what an effect leaves, its own misfit is
    a step more often than a step is."""
    known = [(s, step) for s in analysis.sessions for step in (*s.steps, *s.listed)]
    every = sorted(known, key=lambda pair: (pair[0].name, pair[1].at_s))
    return [_event(s, step) for s, step in every]


def _event(session: Session, step: Step) -> dict[str, Any]:
    half = _CI95 * step.deviation_dps
    return {
        "kind": "step",
        "t_us": int(session.start_us + step.at_s * 1e6),
        "recording": session.name,
        "size_mdps": _mdps(step.size_dps),
        "ci95_mdps": list(zip(_mdps(step.size_dps - half), _mdps(step.size_dps + half))),
        "p_value": step.p_value,
        **({"said": step.said} if step.said else {}),
    }


def _gate(analysis: Analysis) -> dict[str, Any]:
    kept = {f.candidate.label for f in analysis.selection.found}
    return {
        "faults": analysis.gate.faults,
        "channels_dropped": analysis.gate.dropped,
        "notes": analysis.gate.notes,
        "blocks_set_aside": analysis.selection.outliers,
        "withdrawn": [list(r) for r in analysis.selection.withdrawn],
        "considered_and_refused": [
            [what, why.replace("sessions", "pieces") if analysis.single else why]
            for what, why in dict.fromkeys(analysis.selection.refused)
            if what not in kept  # another of the kind was, which reads as if it were this one
        ],
    }


def as_json(value: Any) -> Any:
    """NumPy scalars as plain numbers, for `json.dumps(default=...)`."""
    return np.asarray(value).tolist()
