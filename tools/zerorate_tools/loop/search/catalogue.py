"""What the bias of these sessions can follow: the rows of model/effects.py, each in its places."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import product
from typing import Any

import numpy as np

from ...model import effects
from ...model.effects import ANY_CHANNEL, SUPPLY, Effect, of_any_channel, table_of
from ...model.term import Term
from ..fit.smooth import is_curve, parts
from ..motion.columns import LONGEST_S
from ..read.sessions import Session, block_basis, common_sources

SUPPLY_NAMES = ("vdd", "vbat", "volt", "vcc", "supply")
_OWN = ("temp", "acc_x", "acc_y", "acc_z", "rate_x", "rate_y", "rate_z", "vib")
#: Sources that a device in the hand takes far beyond what they are at rest.
OF_MOTION = frozenset(_OWN) - {"temp"}
#: Parameters refined after the grid, with the limits they may take.
REFINED = {
    "lag_s": (8.0, 7200.0),
    "delay_s": (1.0, 1200.0),
    "decay_s": (40.0, 14400.0),
    "width": (0.3, 30.0),
    "knot": None,
    "centre": None,
    "second_centre": None,
}


#: Lowest, highest and mean value of a source.
Span = tuple[float, float, float]


@dataclass(frozen=True)
class Candidate:
    """An effect that may be there: a kind and the slots that would correct it."""

    kind: str
    terms: tuple[Term, ...]
    family: str  # catalogue or generic
    refine: tuple[str, ...] = field(default=())

    @property
    def is_free(self) -> bool:
        """Whether its terms are the parts of a curve that is still to be told: one slot."""
        return is_curve(self.terms)

    @property
    def slots(self) -> tuple[Term, ...]:
        """Terms of which the board needs a slot each."""
        return self.terms[:1] if self.is_free else self.terms

    @property
    def sources(self) -> list[str]:
        """Names of the channels it follows."""
        names = [t.source for t in self.terms] + [t.second for t in self.terms if t.second]
        return list(dict.fromkeys(n for n in names if n != "one"))

    @property
    def follows_time(self) -> bool:
        """Whether it needs no channel but the clock."""
        return not {*self.sources} - {"time"}

    @property
    def label(self) -> str:
        """The kind, with the channels for forms of any channel."""
        channels = f"({', '.join(self.sources)})" if of_any_channel(self.kind) else ""
        return self.kind + channels


def ranges(sessions: list[Session]) -> dict[str, Span]:
    """Source name -> lowest, highest and mean value in the blocks whose rate is known.

    The extremes are block means that several blocks share, so that no shock alone carries an
    effect, nor is an effect followed where nothing could judge it. Temperature, which is slow, and
    time have all of theirs.
    """
    out = {}
    for name in [*common_sources(sessions), "time"]:
        slow = name in ("temp", "time")
        values = np.concatenate([_known(s, name, slow) for s in sessions])
        few = 0 if slow else min(int(np.ceil(_FEW * len(values))), (len(values) - 1) // 2)
        ends = np.partition(values, (few, last := len(values) - 1 - few))
        out[name] = (float(ends[few]), float(ends[last]), float(values.mean()))
    return out


def _known(session: Session, name: str, by_ticks: bool) -> np.ndarray:
    """Values of a source in the blocks whose rate is known: of every tick, or the blocks' means."""
    if by_ticks:
        return session.source(name)[np.repeat(session.available, session.ticks_per_block)]
    return session.block_mean(session.source(name))[session.available]


def extra_channels(session: Session) -> tuple[str, ...]:
    """Names of the channels that no sensor of its own has, in the session's order."""
    return tuple(n for n in session.sources if n not in _OWN)


def is_supply(name: str) -> bool:
    """Whether a channel's name says it is the supply voltage."""
    return any(part in name.lower() for part in SUPPLY_NAMES)


#: Share of the blocks beyond either limit of a source's range.
_FEW = 0.01

#: Lags in s of all parts that may be late, each three times the last: between two nothing is lost.
_LAGS_S = (5.0, 15.0, 45.0, 135.0, 405.0, 1215.0)

#: Share of the range seen by which a source may leave it before the board holds its term. Within it
#: the posterior mean goes on: to hold a term at the edge made the next power-on worse.
MARGIN = 0.5


def beyond(lo: float, hi: float, name: str) -> tuple[float, float]:
    """The limits at which a term is held. A hand takes what motion carries far beyond what rests
    show, and time goes on forever: both are held where they end."""
    margin = 0.0 if name in (*OF_MOTION, "time") else MARGIN * (hi - lo)
    return lo - margin, hi + margin


def _fields(
    choice: Mapping[str, Any], span: Mapping[str, Span], source: str, drawn: bool = False
) -> dict[str, Any]:
    """Fields of a term. drawn: whether it follows a curve, which ends where the range seen does."""
    lo, hi, mean = span.get(source, (0.0, 1.0, 0.0))
    fields = dict(choice)
    fields["centre"] = _place(fields.get("centre", "mean"), (lo, hi, mean))
    if source in ("one", "time"):
        fields["centre"] = 0.0
    if source != "one":
        ends = (lo, hi) if drawn else beyond(lo, hi, source)
        fields.update(zip(("lo", "hi"), ends))
    if choice.get("power") == 2 and choice.get("centre") == 0.0:  # one side shows the other
        reach = max(-fields["lo"], fields["hi"])
        fields.update(lo=-reach, hi=reach)
    if "curve" in fields:
        fields["table"] = table_of(fields.pop("curve"), lo, hi)
    if "knot" in fields:
        fields["knot"] = lo + fields["knot"] * (hi - lo) - fields["centre"]
    if fields.get("second"):
        second = span[fields["second"]]
        centre = _place(fields.get("second_centre", "mean"), second)
        ends = beyond(second[0], second[1], fields["second"])
        fields.update(second_lo=ends[0], second_hi=ends[1], second_centre=centre)
    return fields


def _place(named: str | float, span: Span) -> float:
    """A value, or the one of lowest, highest and mean that is named."""
    lo, hi, mean = span
    return {"mean": mean, "lo": lo, "hi": hi}[named] if isinstance(named, str) else named


def _expand(
    row: Effect, source: str, family: str, span: Mapping[str, Span], others: Sequence[str] = ()
) -> list[Candidate]:
    """The row's candidates of a source; others: sources that a product can have beside it."""
    grids = {n: (tuple(others) if v == "every" else v) for n, v in row.grids.items()}
    fixed = {**row.fields, **({"curve": row.curve} if row.curve else {})}
    refine = tuple(n for n in grids if n in REFINED)
    out = []
    for values in product(*grids.values()):
        choice = {**fixed, **dict(zip(grids, values))}
        fields = _fields(choice, span, source, bool(row.free or row.curve))
        term = Term(source, **fields)
        terms = parts(term) if row.free else (term,)
        out.append(Candidate(row.kind, terms, family, refine))
    return out


def candidates(sessions: list[Session]) -> list[Candidate]:
    """Every candidate that these sessions' channels allow; what does not vary is left out."""
    span = ranges(sessions)
    varied = [n for n in span if varies(n, sessions)]
    supply = [n for n in varied if n not in _OWN and is_supply(n)]
    out = []
    for row in effects.EFFECTS:
        if isinstance(row.source, tuple):
            out += _group(row, span, varied, sessions)
        elif row.source != ANY_CHANNEL:
            for name in supply if row.source == SUPPLY else [row.source]:
                there = name in varied or name in ("one", "time")
                if there and row.fields.get("second", name) in (*varied, name):
                    out += _expand(row, name, "catalogue", span)
    extra = [n for n in varied if n not in _OWN and n != "time"]
    forms = [row for row in effects.EFFECTS if row.source == ANY_CHANNEL]
    for i, name in enumerate(extra):
        others = [*(["temp"] if "temp" in varied else []), *extra[i + 1 :]]
        for row in forms:
            out += _expand(row, name, "generic", span, others)
    return [c for c in out if _is_finite(c, sessions)]


def lags(sessions: list[Session]) -> list[Term]:
    """The temperature less its lags, and the squares: what parts add that are late, or early."""
    own = [
        Term("temp", centre=mean, lag_s=lag, lag_mode="difference")
        for mean in _mean_degc(sessions)
        for lag in _LAGS_S
    ]
    return [replace(t, power=k, power_first=k > 1) for t in own for k in (1, 2)]


def late(sessions: list[Session]) -> list[Candidate]:
    """What a part adds that is late behind its thermometer by seconds, or early: the rate of
    temperature times the slope of the bias, which bends with temperature."""
    rate = Term("temp", lag_s=_LAGS_S[0], lag_mode="rate")
    products = (replace(rate, second="temp", second_centre=mean) for mean in _mean_degc(sessions))
    return [Candidate("thermal-rate", (rate, product), "catalogue") for product in products]


def _mean_degc(sessions: list[Session]) -> list[float]:
    """Mean temperature of all sessions, these weighing alike; nothing where it is unknown."""
    there = "temp" in common_sources(sessions)
    return [float(np.mean([s.sources["temp"].mean() for s in sessions]))] if there else []


def _group(
    row: Effect, span: Mapping[str, Span], varied: Sequence[str], sessions: list[Session]
) -> list[Candidate]:
    """The row's candidate of several sources at once, where any of them varies."""
    if row.kind == "rate-scale" and _told_by_turns(sessions):
        return []
    if not any(n in varied for n in row.source) or not all(n in span for n in row.source):
        return []
    shown = [n for n in row.source if n in varied]
    terms = tuple(Term(n, **_fields(dict(row.fields), span, n)) for n in shown)
    return [Candidate(row.kind, terms, "catalogue")]


def _told_by_turns(sessions: list[Session]) -> bool:
    """Whether `in_motion` looked at the scale of the rates by samples, which tell it better."""
    return any(s.delay is not None and s.moving_s > LONGEST_S for s in sessions)


def _is_finite(candidate: Candidate, sessions: Sequence[Session]) -> bool:
    columns = np.concatenate([block_basis(t, sessions[0]) for t in candidate.terms])
    return bool(np.isfinite(columns).all() and np.ptp(columns) > 0)


#: Below this peak-to-peak of block means a source says nothing.
SMALLEST = {"temp": 0.3, "acc_x": 0.1, "acc_y": 0.1, "acc_z": 0.1}
SMALLEST |= {"rate_x": 2.0, "rate_y": 2.0, "rate_z": 2.0}


def varies(name: str, sessions: list[Session]) -> bool:
    """Whether a source moves enough within a session, where the rate is known, to show anything."""
    if name == "time":
        return True
    known = [_known(s, name, False) for s in sessions]
    return max(np.ptp(k) for k in known if len(k)) > SMALLEST.get(name, 1e-12)
