"""One power-on session of one device as the loop sees it: block means of the still rate, tick means
of everything else.
"""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ...model.term import Term, evaluate
from .earth import Earth
from .lines import Spectrum

#: Sources of effect slots that are not extra channels, whose names extra channels cannot have.
OWN_SOURCES = (
    *("one", "time", "temp", "vib", "acc_x", "acc_y", "acc_z", "rate_x", "rate_y", "rate_z"),
)

_MOST_KNOWN = 1000
_FIRST_STILL_S = 60.0


@dataclass
class Session:
    """A power-on session.

    rate_dps: (n, 3) mean rate of each block's still part, NaN where there is none. weight: (n,)
    share of the block that was still, 0..1. sources: name -> (n * ticks_per_block,) tick means, no
    NaN (gaps held), units as in effect slots. earth: Earth's rate, which rate_dps is without as
    far as it is known. delay: (m, 2) of `timing.products`, where there is a reference.
    ticks_dps: (n * ticks_per_block, 3) rate of each tick at rest, NaN elsewhere; welch: spectrum of
    the samples at rest; tick_weight: (n * ticks_per_block,) samples that count in rate_dps.
    steps: of its bias, already out of rate_dps and ticks_dps; level_dps: (n * ticks_per_block, 3)
    what they were; listed: steps that are still in them. temp_step_degc: of the thermometer's
    readings, 0 where it is too fine to be seen. known: block means of terms, of these
    sources or of those that were replaced.
    """

    name: str
    block_s: float
    ticks_per_block: int
    rate_dps: np.ndarray
    weight: np.ndarray
    sources: dict[str, np.ndarray] = field(default_factory=dict)
    start_us: int = 0
    noise_dps: np.ndarray | None = None
    earth: Earth | None = None
    delay: np.ndarray | None = None
    ticks_dps: np.ndarray | None = None
    welch: Spectrum | None = None
    tick_weight: np.ndarray | None = None
    steps: tuple[Any, ...] = ()
    listed: tuple[Any, ...] = ()
    level_dps: np.ndarray | None = None
    temp_step_degc: float = 0.0
    known: dict[Any, Any] = field(default_factory=dict, repr=False, compare=False)

    @property
    def blocks(self) -> int:
        """Number of blocks, still or not."""
        return len(self.rate_dps)

    @property
    def tick_s(self) -> float:
        """Seconds per tick: the period at which effect slots are updated."""
        return self.block_s / self.ticks_per_block

    @property
    def available(self) -> np.ndarray:
        """(n,) bool: blocks with a usable rate."""
        return np.isfinite(self.rate_dps).all(axis=1) & (self.weight > 0)

    @property
    def first_still(self) -> np.ndarray:
        """Indices of the blocks of the first still minute, by which the turn-on offset is told."""
        return np.flatnonzero(self.available)[: max(1, round(_FIRST_STILL_S / self.block_s))]

    @property
    def stretch(self) -> np.ndarray:
        """(n,) number of steps before each block: what has one has an offset of its own."""
        return np.searchsorted([s.block for s in self.steps], np.arange(self.blocks), side="right")

    def less_offsets(self, values: np.ndarray, there: np.ndarray) -> np.ndarray:
        """(n, K) block values less their mean over the blocks there, stretch by stretch; a stretch
        with none has the offset of all."""
        out = values - values[there].mean(axis=0)
        for k in range(len(self.steps) + 1 if self.steps else 0):
            own = self.stretch == k
            if (own & there).any():
                out[own] = values[own] - values[own & there].mean(axis=0)
        return out

    @property
    def moving_s(self) -> float:
        """Seconds that it was not at rest."""
        still = np.zeros(0) if self.ticks_dps is None else self.ticks_dps[:, 0]
        return float(np.isnan(still).sum() * self.tick_s)

    @property
    def moved(self) -> np.ndarray:
        """(n,) bool: blocks whose rate is known beside a reference though they were not at rest."""
        if self.ticks_dps is None:
            return np.zeros(self.blocks, bool)
        at_rest = np.isfinite(self.ticks_dps).all(axis=1)
        return self.available & (self.block_mean(at_rest.astype(float)) < 0.5)

    def block_mean(self, ticks: np.ndarray) -> np.ndarray:
        """Mean over each block of a (n * ticks_per_block,) series: over the ticks that count in its
        rate, so that cause and effect are of one time, and over all where none does.
        """
        rows = ticks.reshape(self.blocks, self.ticks_per_block)
        if self.tick_weight is None:
            return rows.mean(axis=1)
        weight = self.tick_weight.reshape(rows.shape)
        weight = weight + ~weight.any(axis=1, keepdims=True)
        return np.average(rows, axis=1, weights=weight)

    def time_s(self) -> np.ndarray:
        """(n * ticks_per_block,) seconds since power-on at the middle of each tick."""
        return (np.arange(self.blocks * self.ticks_per_block) + 0.5) * self.tick_s

    def source(self, name: str) -> np.ndarray:
        """Ticks of a source by name; `time` and `one` are always there. Raises KeyError."""
        if name == "time":
            return self.time_s()
        if name == "one":
            return np.ones(self.blocks * self.ticks_per_block)
        return self.sources[name]


def block_means(ticks: np.ndarray, weight: np.ndarray, blocks: int) -> np.ndarray:
    """(blocks, K) means of (ticks, K) by their (ticks,) weight, NaN where none has any."""
    per = len(weight) // max(blocks, 1)
    total = weight.reshape(blocks, per).sum(axis=1)[:, None]
    values = np.where(weight[:, None] > 0, ticks, 0.0) * weight[:, None]
    with np.errstate(invalid="ignore", divide="ignore"):
        return values.reshape(blocks, per, ticks.shape[1]).sum(axis=1) / total


def common_sources(sessions: list[Session]) -> list[str]:
    """Names of the sources that every session has, in the first session's order."""
    return [n for n in sessions[0].sources if all(n in s.sources for s in sessions)]


def block_basis(term: Term, session: Session) -> np.ndarray:
    """(n,) mean over each block of the basis, kept: parts of a session are fitted in turn."""
    sources, basis = session.known.get(term, (None, None))
    if sources is not session.sources or basis is None:
        basis = _basis(term, session)
        if len(session.known) > _MOST_KNOWN:
            session.known.clear()
        session.known[term] = session.sources, basis
    return basis


def _basis(term: Term, session: Session) -> np.ndarray:
    return session.block_mean(evaluate(term, session.source, session.tick_s))
