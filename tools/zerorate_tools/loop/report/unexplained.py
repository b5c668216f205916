"""What is known of what remains, and what to record next."""

from collections.abc import Iterable, Sequence

import numpy as np

from ...model import effects
from ...numbers import fixed
from ..read.sessions import Session
from ..search.catalogue import is_supply, varies
from ..verify.analysis import Analysis
from ..verify.courses import BEFORE

#: A sensor of the part's own that was not recorded, by a name of what it gives.
_LACKING = {
    "temp": "record the sensor's own temperature, which most biases follow",
    "acc_x": "record acceleration, in which a slow turn shows that looks like a rest",
}
_ORIENTATION = "hold the device in six orientations, each twice, at constant temperature"
_COOLING = "record a cool-down as fast as the warm-up, to tell lag, rate and hysteresis apart"
_WARMING = "record a warm-up as fast as the cool-down, to tell lag, rate and hysteresis apart"
_SUPPLY = "record the supply voltage, and step it by 100 mV up and down at constant temperature"
_POWER = "record three power-ons at constant temperature, one of them a warm restart"
_MORE = "record more power-ons, 6 or more in all: each tests every effect once more"
_LOGGERS, _LOOSEN = "log {} beside the device", "loosen one screw"
#: What may be at work unseen, and what a channel of it is called.
_LOGGED = {"humidity": "hum", "board temperature": "_temp"}
#: Share of the widest range that is a course up or down.
_OF_RANGE = 0.3
_LONGER = "let each recording rest for an hour or more"
_ONE_DEVICE = (
    "check that all recordings are of one device: {} begins {:.2g} dps away from the others"
)
_WHOLE_RANGE = (
    "record the whole range of temperature in every power-on: {} has {:.0f} to {:.0f} degC, the "
    "fitted ones {:.0f} to {:.0f}"
)
#: Beyond it, a turn-on offset is rather another device's: parts repeat theirs far better.
_ANOTHERS_DPS = 0.5
#: Times the floor up to which a residual without a form of its own is the sensor's noise.
_OF_FLOOR = 3.0
_WANDERS = "It varies slowly, as noise does, and follows no recorded channel."
#: Share of what is held out at temperatures that nothing fitted has seen, and by how much.
_UNSEEN_SHARE, _UNSEEN_DEGC = 0.25, 1.0


def what_is_known(analysis: Analysis, after_dps: np.ndarray) -> str:
    """A sentence or two on the residual of the held-out part, given its RMS (3,) in dps."""
    residual, floor = analysis.judgement.residual_test, analysis.floor_dps
    times = (after_dps / np.maximum(floor, 1e-12)).max()
    size = f"{fixed(1e3 * after_dps.max(), 1)} mdps at worst"
    if not residual.left and times <= _OF_FLOOR:
        return f"{size}. It looks like sensor noise."
    if not residual.left:
        return f"{size}, {times:.1f} times the noise floor. {_WANDERS}"
    parts = [f"{size}, {times:.1f} times the noise floor, which is more than noise"]
    if residual.smooth:
        parts.append("it drifts slowly")
    if residual.common:
        ratio = residual.direction / np.abs(residual.direction).max()
        parts.append("x, y and z move together as " + " : ".join(fixed(r, 2) for r in ratio))
    parts.append(_nearest_channel(analysis))
    return "; ".join(parts) + "."


def _nearest_channel(analysis: Analysis) -> str:
    s = analysis.selection
    if not s.pool:
        return "no recorded channel could explain it"
    terms = [*s.straight, *s.bend, *s.terms]
    ratios = s.regression.gains(terms, [c.terms for c in s.pool]).sum(axis=1)
    best = s.pool[int(ratios.argmax())]
    sources = " and ".join(best.sources) or "time since power-on"
    return f"the nearest recorded channel is {sources}, which does not explain it"


def measure_next(analysis: Analysis) -> list[str]:
    """What to record so that more could be told, the most useful first."""
    sessions, found = analysis.sessions, analysis.selection.found
    kinds = {f.candidate.kind for f in found}
    out = [advice for name, advice in _LACKING.items() if name not in sessions[0].sources]
    out += [*_another_device(analysis), *_other_temperatures(analysis)]
    if len(sessions) < 5:
        out.append(_MORE)
    out += _other_way(sessions)
    if kinds & {"power-on-transient", "time-drift"}:
        out.append(_POWER)
    if not _turned(sessions):
        out.append(_ORIENTATION)
    if not any(is_supply(n) for n in sessions[0].sources):
        out.append(_SUPPLY)
    if analysis.judgement.residual_test.left:
        out.append(_unrecorded(sessions[0].sources))
    if max(s.blocks * s.block_s for s in sessions) < 3000:
        out.append(_LONGER)
    return out


def _unrecorded(sources: Iterable[str]) -> str:
    """What to log beside the device, less what is there."""
    there = " ".join(sources).lower()
    missing = [what for what, mark in _LOGGED.items() if mark not in there]
    logger = [_LOGGERS.format(" and ".join(missing))] if missing else []
    return ", ".join([*logger, _LOOSEN])


def _another_device(analysis: Analysis) -> list[str]:
    """The question whether what is held out is of the same device, where it begins far off."""
    if analysis.single:
        return []
    m = analysis.measured
    offsets = m.offsets(BEFORE) if m else analysis.judgement.offsets_dps
    far = [(float(np.abs(o).max()), s.name) for o, s in zip(offsets, analysis.holdout)]
    return [_ONE_DEVICE.format(name, dps) for dps, name in far if dps > _ANOTHERS_DPS]


def _other_temperatures(analysis: Analysis) -> list[str]:
    """The range to record, where much of what is held out lies outside of what was fitted."""
    if analysis.single or "temp" not in analysis.sessions[0].sources:
        return []
    seen = np.concatenate([_temperatures(s) for s in analysis.train])
    out = []
    for s in analysis.holdout:
        t = _temperatures(s)
        outside = (t < seen.min() - _UNSEEN_DEGC) | (t > seen.max() + _UNSEEN_DEGC)
        if outside.mean() > _UNSEEN_SHARE:
            out.append(_WHOLE_RANGE.format(s.name, t.min(), t.max(), seen.min(), seen.max()))
    return out


def _temperatures(session: Session) -> np.ndarray:
    return session.block_mean(session.sources["temp"])[session.available]


def _other_way(sessions: Sequence[Session]) -> list[str]:
    """The course of temperature that none of the sessions has: down, or up."""
    if "temp" not in sessions[0].sources:
        return []
    courses = [s.block_mean(s.sources["temp"]) for s in sessions]
    least = _OF_RANGE * max(np.ptp(t) for t in courses)
    cools = max((np.maximum.accumulate(t) - t).max() for t in courses) > least
    warms = max((t - np.minimum.accumulate(t)).max() for t in courses) > least
    return ([] if cools else [_COOLING]) + ([] if warms else [_WARMING])


def _turned(sessions: list[Session]) -> bool:
    names = ("acc_x", "acc_y", "acc_z")
    return all(n in sessions[0].sources for n in names) and any(varies(n, sessions) for n in names)


def not_excluded(analysis: Analysis) -> list[str]:
    """Kinds of effect that these recordings cannot show because nothing in them varies it."""
    shown = {c.kind for c in analysis.selection.pool}
    if analysis.motion.rate_scale is not None:
        shown.add("rate-scale")
    kinds = [row.kind for row in effects.EFFECTS if row.source != effects.ANY_CHANNEL]
    return [kind for kind in kinds if kind not in shown]
