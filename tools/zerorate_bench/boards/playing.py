"""Frames through the firmware on an emulated Pico and on this host, and whether they end alike."""

from array import array
from dataclasses import dataclass, field
from importlib.resources import files
from statistics import median
from typing import Any

import numpy as np
from numpy.typing import NDArray
from zerorate import Corrector, Sensor
from zerorate.bursts import Bursts
from zerorate_tools.boards.connection import connected, told

from ..workload import REST
from .pico import EmulatedPico

SENSOR = (100.0, 131.0, 16384.0, 340.0, 36.53)
_MARKS = 3
_PATIENCE_S = 600


@dataclass(frozen=True)
class Play:
    """What is run: rows (n, 8) of dt_us and seven words, through a corrector of these options.

    state: what the corrector begins with, its own where None; its settings are always its own.
    at_once: samples a call, 0 for the kernels without the object; model: bytes of an effect model
    that is refined as well.
    """

    rows: NDArray[np.int32]
    options: dict[str, Any] = field(default_factory=REST.copy)
    sensor: tuple[float, ...] = SENSOR
    state: NDArray[np.int32] | None = None
    at_once: int = 1
    model: bytes = b""

    def corrector(self) -> Corrector:
        """A corrector as the play begins with."""
        made = Corrector(Sensor(*self.sensor), **self.options)
        if self.state is not None:
            made.state[:] = array("i", [int(word) for word in self.state])
        return made


@dataclass(frozen=True)
class Played:
    """How it ended: bytes of the frames, the settings and the states, and cycles of each call."""

    data: bytes
    cycles: tuple[int, ...] = ()

    @property
    def median(self) -> float:
        """Cycles of the median call."""
        return float(median(self.cycles))

    @property
    def worst(self) -> int:
        """Cycles of the longest call."""
        return max(self.cycles)


def on_pico(pico: EmulatedPico, play: Play) -> Played:
    """Run it on a Pico that has the packages. Raises BoardError and mpremote's errors."""
    pico.give(play.corrector().state.tobytes() + play.rows.astype("<i4").tobytes())
    pico.ask("spans")
    pico.taken()
    p = play
    call = f"run({p.options!r}, {p.sensor!r}, {len(p.rows)}, {p.at_once}, {p.model!r})\n"
    text = files(__package__).joinpath("on_pico.py").read_text(encoding="utf-8")
    with connected(pico.port) as board:
        told(board, text + call, patience_s=_PATIENCE_S)
    spans = pico.ask("spans")
    own = min(spans[:_MARKS])
    return Played(pico.taken(), tuple(span - own for span in spans[_MARKS:]))


def on_host(play: Play) -> Played:
    """The same here, by CPython."""
    corrector = play.corrector()
    if play.model:
        from zerorate.model import EffectModel

        effects = EffectModel()
        effects.load(play.model, corrector.sensor)
        effects.refine()
        corrector.use_model(effects)
    left = array("i")
    rows = [array("i", [int(word) for word in row]) for row in play.rows]
    if play.at_once > 1:
        take = Bursts(corrector).update
        for at in range(0, len(rows) - play.at_once + 1, play.at_once):
            frames = array("i")
            for row in rows[at : at + play.at_once]:
                frames.extend(row)
            take(frames, play.at_once)
            left.extend(frames)
    else:
        for row in rows:
            sample = row[1:]
            corrector.update(sample, row[0])
            left.extend(sample)
    c = corrector
    for words in (c.settings, c.motion_settings, c.gravity_settings, c.motion, c.gravity, c.state):
        if words is not None:
            left.extend(words)
    return Played(left.tobytes())
