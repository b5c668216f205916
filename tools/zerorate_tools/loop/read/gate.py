"""Data quality before any regression: what is refused, what is set aside, what is said."""

from dataclasses import dataclass, field
from math import ceil, floor
from typing import Any

import numpy as np
from scipy.stats import spearmanr
from zerorate.settings import DEFAULTS

from ...errors import ZerorateError
from ...model.model import ACCELERATIONS, binding_of
from .sessions import OWN_SOURCES, Session
from .ticks import Ticks

LEAST_BLOCKS = 15
#: Half of it is the turn-on minute, which nothing is judged by.
LEAST_S = 120.0
_MOST_FAULTY = 0.5
_MOST_GAP = 0.5
#: What a sensor that gives such samples needs.
_REMEDY = {
    "clipped": "the rates are at the rails: choose a wider range",
    "repeated": "the rates never change: poll no faster than the data rate, and check the bus",
    "all-zero": "every word is 0: wake the sensor and check the bus",
    "temperature-jump": "the temperature leaps: check the bus and the temperature's scale",
}
_COPY = 0.99999
#: Rank correlation of what a channel and a rate change by from tick to tick, where white noise is
#: most of a rate's change: no cause has the sensor's own noise.
_OWN_NOISE = 0.9
#: Of a data rate: so far two recordings of one device may be apart, each by its own clock.
_MOST_RATE_APART = 0.05
#: Of the rests, beyond which it is said that the firmware takes them for motion.
_MOST_SHAKEN = 0.3
_SETTINGS = (
    *("sensor", "odr_hz", "gyro_lsb_per_dps", "accel_lsb_per_g", "temp_lsb_per_degc"),
    "temp_offset_degc",
)


class CannotClose(ZerorateError):
    """Recordings from which nothing can be learned; the text says what is needed."""


@dataclass
class GateReport:
    """What was set aside: faults by recording, dropped channels by reason, sentences for the
    report; and moving, the sessions of which only motion may show anything.
    """

    faults: dict[str, dict[str, int]] = field(default_factory=dict)
    dropped: dict[str, str] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)
    moving: list[Session] = field(default_factory=list)


def same_settings(ticks: list[Ticks]) -> None:
    """Raise CannotClose for a session of another chip, sensor or scale, or a recording or a name
    given twice.
    """
    first, seen = _settings(ticks[0]), {ticks[0].digest: ticks[0].name}
    for t in ticks[1:]:
        for name, other in _settings(t).items():
            one = first[name]
            if not _alike(name, one, other):
                ours, theirs = (f"{x:.4g}" if name == "odr_hz" else x for x in (other, one))
                raise CannotClose(
                    f"{t.name}: {name} is {ours}, but {theirs} in {ticks[0].name}; sessions must "
                    f"be of one device with one setting{_how_alike(name, one, other)}"
                )
        if t.digest in seen:
            raise CannotClose(
                f"{t.name} holds the same samples as {seen[t.digest]}; name each recording once"
            )
        if t.name in seen.values():
            raise CannotClose(
                f"two recordings are named {t.name}; rename one: a report tells them by their names"
            )
        seen[t.digest] = t.name


def _settings(ticks: Ticks) -> dict[str, Any]:
    chip = {f"its {name}": code for name, code in vars(binding_of(ticks.scales)).items()}
    return {name: getattr(ticks.scales, name) for name in _SETTINGS} | chip


def _alike(name: str, one: Any, other: Any) -> bool:
    """Whether two recordings may have these settings: equal, a data rate within five percent, a
    chip's own where both are known."""
    if name == "odr_hz":
        return abs(one - other) <= _MOST_RATE_APART * max(one, other)
    return one == other or (name.startswith("its ") and None in (one, other))


def _how_alike(name: str, one: Any, other: Any) -> str:
    """How to import what differs by a name that nobody gave, by a scale that was chosen alone, or
    by a clock that nobody holds, as a phone's."""
    if name == "sensor" and "unknown" in (one, other):
        part = other if one == "unknown" else one
        return f": if it is the same part, import the other with --sensor {part}"
    if name == "odr_hz" and max(one, other) < 2**0.5 * min(one, other):  # a chip's are twice apart
        hz = f"{(one * other) ** 0.5:.3g}"
        return f": if the setting is one and only the log's rate wavers, import both with --hz {hz}"
    if "_lsb_" not in name or None in (one, other):
        return ""
    option = f"--{name.replace('_', '-')} {min(one, other):g}"
    return f": if only the imports differ, import both with {option}"


def readable(ticks: list[Ticks]) -> None:
    """Raise CannotClose for a recording most of which are faults; the text says of which kind."""
    for t in ticks:
        for kind, count in t.faults.items():
            if count > _MOST_FAULTY * t.samples:
                raise CannotClose(
                    f"{t.name}: {100 * count / t.samples:.0f} % of its samples are {kind}; "
                    f"{_REMEDY[kind]}"
                )


def without_long_gaps(ticks: list[Ticks]) -> None:
    """Raise CannotClose for a recording most of whose time nothing was recorded."""
    for t in ticks:
        filled = np.flatnonzero(t.count > 0)
        longest = int(np.diff(filled).max(initial=0))
        if longest > _MOST_GAP * len(t.count):
            unit, span_s = ("h", 3600) if longest * t.tick_s > 7200 else ("min", 60)
            gap, whole = (n * t.tick_s / span_s for n in (longest, len(t.count)))
            raise CannotClose(
                f"{t.name}: nothing for {gap:.1f} {unit} of its {whole:.1f} {unit}; "
                "cut it there (zerorate cut): what follows is a recording of its own"
            )


class TooLittleRest(CannotClose):
    """No recording rests long enough; what only motion shows may still be found."""


def enough(session: Session) -> None:
    """Raise CannotClose where too little of a recording is still."""
    needed_s = max(LEAST_BLOCKS * session.block_s, LEAST_S)
    have_s = session.blocks * session.block_s
    still_s = int(session.available.sum()) * session.block_s
    if have_s < needed_s:
        raise TooLittleRest(
            f"{session.name}: {_have(have_s)} minutes are too short; {_needed(session, needed_s)}, "
            "better an hour"
        )
    if still_s < needed_s:
        raise TooLittleRest(
            f"{session.name}: only {_have(still_s)} minutes are still; "
            f"{_needed(session, needed_s)}: leave the device untouched for longer"
        )


def _have(seconds: float) -> str:
    """Minutes rounded down, and what is needed up, so that the two are told apart."""
    return f"{floor(seconds / 6) / 10:.1f}"


def _needed(session: Session, seconds: float) -> str:
    return (
        f"{ceil(seconds / 6) / 10:g} minutes at rest are needed ({LEAST_BLOCKS} blocks of "
        f"{session.block_s:g} s, no less than {LEAST_S / 60:g} minutes)"
    )


def shaken(sessions: list[Session], report: GateReport) -> None:
    """Say in the report where the firmware learns little because its accelerometer sees shaking."""
    seen = [s for s in sessions if "vib" in s.sources]
    if not seen:
        return
    limit = DEFAULTS["still_g"]
    over = [(s.block_mean(s.sources["vib"]) > limit**2)[s.available] for s in seen]
    share = float(np.concatenate(over).mean())
    if share > _MOST_SHAKEN:
        report.notes.append(
            f"in {100 * share:.0f} % of the rests the acceleration varies by more than {limit} g: "
            "the firmware takes that for motion and learns nothing there, so before and after are "
            "those of a curve learned from the others; record with less vibration, or give "
            "the firmware a larger still_g"
        )


def usable_channels(sessions: list[Session], report: GateReport) -> None:
    """Take out of the sessions every source that is constant, copied or not in all of them; say so
    in the report.
    """
    kept: list[str] = []
    for name in dict.fromkeys(n for s in sessions for n in s.sources):
        reason = _unusable(name, sessions) or _twin(name, kept, sessions)
        if not reason:
            kept.append(name)
            continue
        report.dropped[name] = reason
        for s in sessions:
            s.sources.pop(name, None)


def _twin(name: str, among: list[str], sessions: list[Session]) -> str | None:
    twins = (
        f"a copy of {n}: the two cannot be told apart" for n in among if _copies(n, name, sessions)
    )
    return next(twins, None)


def _unusable(name: str, sessions: list[Session]) -> str | None:
    missing = [s.name for s in sessions if name not in s.sources]
    if missing:
        return f"not in {', '.join(missing)}"
    if not all(np.isfinite(s.sources[name]).all() for s in sessions):
        return "no values"
    if name not in ACCELERATIONS and not any(np.ptp(s.sources[name]) for s in sessions):
        return "constant"
    own, time_s = [s.sources[name] for s in sessions], [s.time_s() for s in sessions]
    if name not in OWN_SOURCES and _same_course(own, time_s):
        return "a clock: it only counts the time"
    if name not in OWN_SOURCES and all(_has_the_noise(s, name) for s in sessions):
        return "it has the gyroscope's own noise: a copy of what is to be explained, no cause of it"
    return None


def _has_the_noise(session: Session, name: str) -> bool:
    """Whether a channel changes from tick to tick as the rate about an axis does."""
    if session.ticks_dps is None:
        return False
    own = np.diff(session.sources[name][: len(session.ticks_dps)])
    rates = np.diff(session.ticks_dps, axis=0)
    there = np.isfinite(rates).all(axis=1) & (own != 0)
    if there.sum() < max(LEAST_BLOCKS, 0.5 * len(own)) or not np.ptp(own[there]):
        return False
    alike = [abs(spearmanr(own[there], r).statistic) for r in rates[there].T if np.ptp(r)]
    return max(alike, default=0.0) > _OWN_NOISE


def _copies(a: str, b: str, sessions: list[Session]) -> bool:
    if a.startswith(("acc_", "rate_")) and b.startswith(("acc_", "rate_")):
        return False
    return _same_course([s.sources[a] for s in sessions], [s.sources[b] for s in sessions])


def _same_course(a: list[np.ndarray], b: list[np.ndarray]) -> bool:
    """Whether one is the other, scaled, in all sessions together, offsets aside."""
    x, y = (np.concatenate([part - part.mean() for part in of]) for of in (a, b))
    scale = np.sqrt((x @ x) * (y @ y))
    return bool(abs(x @ y) > _COPY * scale)
