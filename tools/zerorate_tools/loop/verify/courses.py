"""Before and after as the firmware's own kernels have it, with the model in its integer form.

The firmware learns the training sessions in their order, without a model and with it. Frozen, it
is run over every session, whose turn-on offset it takes from the first still minute; and it is run
over the held-out part once more learning as it goes. Of one recording alone every piece is run by
a firmware that has learned the others.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from ...model import Model, Slot
from ...recordings import Scales
from ...replay.samples import Frames
from ..search.selection import Selection
from .by_kernels import PiecesByKernels
from .firmware import Firmware, at_once
from .power_on import BlockMeans, PowerOn, TurnOn, turn_on

BY = "the firmware's own kernels, with the model in its integer form; means of blocks"
BEFORE, AFTER, ONLINE_BEFORE, ONLINE = "before", "after", "online_before", "online"

#: Called with the session's name, the samples, and what each way subtracts (n, 3), LSB in Q8.
Sink = Callable[[str, Frames, dict[str, np.ndarray]], None]
#: What is subtracted from samples, (n, 3) LSB in Q8.
Way = Callable[[Frames], np.ndarray]


@dataclass
class Course:
    """One session, block by block. bias, residual: (n, 3) dps by way: before, after, online and
    online_before, and after_K with the first K effects, in the sessions where it was run; residual
    is NaN where it is not scored. offset_dps: (3,) taken at turn-on, before and after; pieces: (n,)
    of which piece left out each block is, none where the session was held out whole.
    """

    time_s: np.ndarray
    bias: dict[str, np.ndarray]
    residual: dict[str, np.ndarray]
    offset_dps: dict[str, np.ndarray] = field(default_factory=dict)
    pieces: np.ndarray = field(default_factory=lambda: np.zeros(0, int))


@dataclass
class Courses:
    """What the kernels gave. sessions: by name; holdout: names of those held out; rounding_dps:
    (3,) RMS by which the model's integers differ from its numbers, on the held-out part; inside:
    names of others, pieces of which were left out in turn.
    """

    sessions: dict[str, Course]
    holdout: list[str]
    rounding_dps: np.ndarray
    by: str = BY
    inside: list[str] = field(default_factory=list)

    def residuals(self, way: str) -> list[np.ndarray]:
        """(n, 3) of each session held out."""
        return [self.sessions[name].residual[way] for name in self.holdout]

    def with_first(self, effects: int, names: Sequence[str] = ()) -> list[np.ndarray]:
        """As `residuals`, with the first so many effects alone; names: of other sessions."""
        way = after_first(effects)
        some = [self.sessions[name].residual for name in names or self.holdout]
        return [residual.get(way, residual[AFTER]) for residual in some]

    def offsets(self, way: str) -> list[np.ndarray]:
        """(3,) turn-on offset of each session held out, dps; zero where a part of its own power-on
        was learned."""
        held = [self.sessions[name].offset_dps for name in self.holdout]
        return [offsets.get(way, offsets.get(BEFORE, np.zeros(3))) for offsets in held]


def after_first(effects: int) -> str:
    """The way with the first so many effects; that with all of them may be AFTER instead."""
    return f"{AFTER}_{effects}" if effects else BEFORE


class SessionRuns:
    """Runs the firmware over the sessions of one device.

    train, holdout: names of sessions; models: none, then those of the first effects, at last the
    whole one; inside: of training sessions judged by pieces left out, what measures them.
    """

    def __init__(
        self,
        power_ons: Sequence[PowerOn],
        train: Sequence[str],
        holdout: Sequence[str],
        models: Sequence[Model | None],
        scales: Scales,
        inside: Mapping[str, PieceRuns],
    ) -> None:
        self.inside = inside
        self.power_ons = {p.session.name: p for p in power_ons}
        self.train, self.holdout = list(train), list(holdout)
        channels = power_ons[0].channels
        self.devices = [Firmware(scales, m, channels) for m in models]
        self.begun: dict[str, list[Firmware]] = {}

    def learn(self) -> None:
        """Let every device live through the training sessions; remember how each began."""
        for name in self.train:
            p = self.power_ons[name]
            for d in self.devices:
                d.power_on()
            self.begun[name] = [d.copy() for d in (self.devices[0], self.devices[-1])]
            for frames in p.frames():
                at_once([d.run for d in self.devices], frames)

    def course(self, name: str, online: bool, sink: Sink) -> Course:
        """Run the frozen devices over a session, and the learning ones where wanted."""
        if name in self.inside:
            return self.inside[name].course(sink, self._online(name) if online else {})
        p = self.power_ons[name]
        held_out = name in self.holdout
        ways, unscored, offsets = self._frozen(p, held_out)
        if online or held_out:
            ways.update(self._online(name))

        def biases(frames: Frames) -> dict[str, np.ndarray]:
            return dict(zip(ways, at_once(list(ways.values()), frames)))

        return scored(p, _means(p, ways, biases, sink), offsets, unscored)

    def _frozen(
        self, p: PowerOn, held_out: bool
    ) -> tuple[dict[str, Way], int, dict[str, np.ndarray]]:
        """Ways to run frames through a frozen copy of each device, its turn-on offset in place."""
        last = len(self.devices) - 1
        runs: dict[str, Way] = {}
        taken: dict[str, TurnOn] = {}
        for k, device in enumerate(self.devices):
            way = AFTER if k == last and k else after_first(k)
            if way not in (BEFORE, AFTER) and not held_out:
                continue
            ready = device.copy()
            ready.power_on()
            taken[way] = turn_on(device, p)
            ready.set_offset(taken[way].offset_q8)
            runs[way] = partial(ready.run, learn=False)
        offsets = {way: of.offset_q8 / (256.0 * p.lsb) for way, of in taken.items()}
        return runs, max(of.blocks for of in taken.values()), offsets

    def _online(self, name: str) -> dict[str, Way]:
        if name in self.begun:
            devices = self.begun[name]
        else:
            devices = [d.copy() for d in (self.devices[0], self.devices[-1])]
            for d in devices:
                d.power_on()
        return dict(zip((ONLINE_BEFORE, ONLINE), (d.run for d in devices)))


class PieceRuns:
    """Runs the firmware over one recording, every sample by a device that its piece was left out
    of, with the effects of a selection fitted without it.

    more: slots of what motion showed, beside those of all effects.
    """

    def __init__(self, pieces: PiecesByKernels, selection: Selection, more: Sequence[Slot]) -> None:
        self.pieces = pieces
        # the last, with all effects, is AFTER itself where motion has nothing to add
        effects = range(max(len(selection.found) + bool(more), 1))
        self.models = {after_first(k): self._models(selection.first(k)) for k in effects}
        if selection.found or more:
            self.models[AFTER] = self._models(selection, more)

    def _models(self, selection: Selection, more: Sequence[Slot] = ()) -> list[Model | None]:
        return self.pieces.models(selection.straight, selection.terms, selection.applied, more)

    def course(self, sink: Sink, learning: Mapping[str, Way] | None = None) -> Course:
        """Run the devices over the recording: frozen ones, and those that learn as they go, by
        default from nothing.
        """
        of, p = self.pieces, self.pieces.power_on
        frozen = {way: of.learned(models) for way, models in self.models.items()}
        ways: dict[str, Way] = {
            way: partial(of.bias_q8, devices) for way, devices in frozen.items()
        }
        if learning is None:
            *_, last = self.models.values()
            new = {ONLINE_BEFORE: of.new(self.models[BEFORE][:1]), ONLINE: of.new(last)}
            learning = {way: partial(of.bias_q8, d, learn=True) for way, d in new.items()}
        ways |= learning

        def biases(frames: Frames) -> dict[str, np.ndarray]:
            return {way: run(frames) for way, run in ways.items()}

        course = scored(p, _means(p, ways, biases, sink))
        course.residual = {way: of.about_stretches(r) for way, r in course.residual.items()}
        course.pieces = np.r_[0, np.diff(of.fold) != 0].cumsum()
        return course


def _means(
    p: PowerOn, ways: Iterable[str], biases: Callable[[Frames], dict[str, np.ndarray]], sink: Sink
) -> dict[str, np.ndarray]:
    """(n, 3) dps of each way by block. biases: what each subtracts from some samples, LSB in Q8."""
    means = {way: BlockMeans(p) for way in (*ways, AFTER)}
    for frames in p.frames():
        found = biases(frames)
        found.setdefault(AFTER, found[BEFORE])
        for way, bias_q8 in found.items():
            means[way].add(frames, bias_q8)
        sink(p.session.name, frames, found)
    return {way: m.blocks_dps() for way, m in means.items()}


def scored(
    p: PowerOn,
    bias: dict[str, np.ndarray],
    offsets: dict[str, np.ndarray] | None = None,
    unscored: int = 0,
) -> Course:
    """A course from (n, 3) dps by way; the first unscored blocks told the turn-on offset."""
    rate = np.where(p.scored[:, None], p.rate_dps, np.nan)
    rate[:unscored] = np.nan
    time_s = (np.arange(p.session.blocks) + 0.5) * p.session.block_s
    residual = {way: rate - b for way, b in bias.items()}
    return Course(time_s, bias, residual, offsets or {})
