"""The firmware itself over a session, by its own kernels: learning as it goes, or frozen."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from copy import deepcopy

import numpy as np
from zerorate import Corrector
from zerorate.effects.model_file import LOADED, REASONS
from zerorate.model import EffectModel

from zerorate_tools.layout import AXIS, SETTINGS, STATE, axis_at

from ...errors import ZerorateError
from ...model import Model, encoded
from ...model.files import sensor_for
from ...recordings import Scales
from ...replay.engines import Engine, NativeEngine, engine
from ...replay.samples import Frames


class Refused(ZerorateError):
    """Scales or a model that the firmware does not take; the text says why."""


class Firmware:
    """A device that runs the firmware, with an effect model or without.

    channels: names of the extra channels in the order of `Frames.extra`. Raises Refused.
    """

    def __init__(self, scales: Scales, model: Model | None, channels: Sequence[str] = ()) -> None:
        try:
            self._corrector = Corrector(sensor_for(scales), motion=False, gravity=False)
        except ValueError as problem:
            raise Refused(f"the firmware cannot run at these scales: {problem}") from problem
        self._engine: Engine = engine("native")
        self._extra: list[int] = []
        if model is not None:
            self._load(model, channels)
        self._learning = self._corrector.settings
        # a spread above nothing is in every window: no rest, so nothing is learned
        self._frozen = deepcopy(self._learning)
        self._frozen[SETTINGS.STILL_ACCEL_Q8] = -1

    def _load(self, model: Model, channels: Sequence[str]) -> None:
        effects = EffectModel()
        reason = effects.load(encoded(model), self._corrector.sensor)
        if reason != LOADED:
            raise Refused(f"the firmware refuses the model: {REASONS[reason]}")
        self._corrector.use_model(effects)
        self._extra = [channels.index(name) for name in effects.channels]

    def copy(self) -> Firmware:
        """Another device in the very same state."""
        return deepcopy(self)

    def power_on(self) -> None:
        """Begin a session with what has been learned."""
        self._corrector.power_on()

    def run(self, frames: Frames, learn: np.ndarray | bool = True) -> np.ndarray:
        """(n, 3) what is subtracted from each sample, LSB in Q8; the frames are left as they are.

        learn: whether rests are learned, (n,) bool or one for all.
        """
        learn = np.broadcast_to(learn, len(frames))
        if isinstance(self._engine, NativeEngine):
            own = self._own(frames)
            return self._engine.run_partly(self._corrector, own, learn, self._frozen).bias_q8
        edges = np.flatnonzero(np.diff(learn)) + 1
        parts = zip(np.r_[0, edges], np.r_[edges, len(frames)])
        return np.vstack([self._run(rows(frames, a, b), bool(learn[a])) for a, b in parts])

    def _run(self, frames: Frames, learn: bool) -> np.ndarray:
        self._corrector.settings = self._learning if learn else self._frozen
        return next(iter(self._engine.run(self._corrector, [self._own(frames)]))).bias_q8

    def _own(self, frames: Frames) -> Frames:
        extra = np.ascontiguousarray(frames.extra[:, self._extra])
        return Frames(frames.t_us, frames.frames.copy(), frames.dt_us, extra)

    @property
    def target_q8(self) -> np.ndarray:
        """(3,) bias without effects that the latest window asks for, LSB in Q8."""
        return np.array(self._corrector.state[STATE.TARGET_Q8 : STATE.TARGET_Q8 + 3], np.int64)

    @property
    def offset_is_known(self) -> np.ndarray:
        """(3,) bool: whether rests have told the axis' offset since power-on, beyond doubt."""
        s, unknown = self._corrector.state, self._learning[SETTINGS.TURN_ON_VARIANCE_Q8]
        return np.array(
            [
                s[a + AXIS.OFFSET_VARIANCE_Q8] != unknown and s[a + AXIS.SUSPECT] <= 0
                for a in self._axes()
            ]
        )

    def set_offset(self, offset_q8: Iterable[int]) -> None:
        """Put each axis' offset from the learned curve, (3,) LSB in Q8, in place."""
        for a, offset in zip(self._axes(), offset_q8):
            self._corrector.state[a + AXIS.OFFSET_Q8] = int(offset)

    def _axes(self) -> list[int]:
        c = self._learning
        return [axis_at(c, i) for i in range(3)]


def rows(frames: Frames, first: int, end: int) -> Frames:
    """Some of the samples."""
    part = slice(int(first), int(end))
    return Frames(frames.t_us[part], frames.frames[part], frames.dt_us[part], frames.extra[part])


def at_once(runs: Sequence[Callable[..., np.ndarray]], *arguments: Frames) -> list[np.ndarray]:
    """What every one of them returns; compiled kernels run beside each other."""
    with ThreadPoolExecutor() as pool:
        return [task.result() for task in [pool.submit(run, *arguments) for run in runs]]
