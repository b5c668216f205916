"""A session as the firmware meets it: frames, their ticks and blocks, and its turn-on offset."""

from collections.abc import Iterator
from dataclasses import dataclass
from os import PathLike

import numpy as np

from ...recordings import open_recording
from ...replay.samples import Frames, frames_in_batches
from ..motion.scales_and_timing import InMotion, rates_of_turning
from ..read.sessions import Session, block_means
from .firmware import Firmware, rows

#: Blocks after the first still minute in which the firmware may go on making up its mind.
_MORE_BLOCKS = 15


@dataclass(frozen=True)
class PowerOn:
    """A session and its recording. rate_dps: (n, 3) what an ideal bias would be at each block,
    NaN where it is not known; scored: (n,) bool, blocks whose residual counts; channels: extra
    channels that models may follow.
    """

    session: Session
    path: str | PathLike[str]
    lsb: float
    rate_dps: np.ndarray
    scored: np.ndarray
    channels: tuple[str, ...]

    def frames(self) -> Iterator[Frames]:
        """All samples, in batches, without the steps of the bias."""
        opened = open_recording(self.path, keep_gaps=True)
        batches, level = frames_in_batches(opened, channels=self.channels), self.session.level_dps
        return batches if level is None else (self._less(f, level * self.lsb) for f in batches)

    def _less(self, frames: Frames, level: np.ndarray) -> Frames:
        """The samples less the steps, (ticks, 3) LSB, in whole counts whose mean is the step's."""
        counts = level[np.minimum(self.ticks(frames), len(level) - 1)]
        at = np.arange(len(frames))[:, None]
        whole = np.floor((at + 1) * (counts % 1.0)) - np.floor(at * (counts % 1.0))
        frames.frames[:, 4:] -= (np.floor(counts) + whole).astype(np.int32)
        return frames

    def ticks(self, frames: Frames) -> np.ndarray:
        """(n,) index of each sample's tick."""
        s = self.session
        return ((frames.t_us - s.start_us) / (s.tick_s * 1e6)).astype(np.int64)

    def blocks(self, frames: Frames) -> np.ndarray:
        """(n,) index of each sample's block, at most the last one."""
        per = self.session.ticks_per_block
        return np.minimum(self.ticks(frames) // per, self.session.blocks - 1)

    def block_means(self, ticks: np.ndarray) -> np.ndarray:
        """(n, 3) means of (ticks, 3), NaN where there are none, over the ticks that count."""
        counted = self.session.tick_weight
        assert counted is not None, "a session of a recording has it"
        weight = np.where(np.isfinite(ticks[:, 0]), counted, 0.0)
        return block_means(ticks, weight, self.session.blocks)

    def by_blocks(self) -> Iterator[tuple[int, Frames]]:
        """Pieces of samples, each within one block, with that block's index."""
        for frames in self.frames():
            at = self.blocks(frames)
            edges = np.flatnonzero(np.diff(at)) + 1
            for a, b in zip(np.r_[0, edges], np.r_[edges, len(at)]):
                yield int(at[a]), rows(frames, a, b)


def ideal_dps(session: Session, motion: InMotion) -> np.ndarray:
    """(n, 3) what an ideal bias would be: the rate read at rest, or beyond the true one.

    Earth's rate is in what the firmware learns at rest, so only its change since the first still
    minute is an error; what turning adds is the model's to remove.
    """
    rate = session.rate_dps + rates_of_turning(session, motion)
    if session.earth is not None:
        shape = session.blocks, session.ticks_per_block, 3
        by_block = session.earth.rate_dps[: shape[0] * shape[1]].reshape(shape).mean(axis=1)
        rate = rate + by_block[session.first_still].mean(axis=0)
    return rate


class BlockMeans:
    """Gathers a bias sample by sample into block means over the ticks that count."""

    def __init__(self, power_on: PowerOn) -> None:
        self._of = power_on
        ticks = power_on.session.blocks * power_on.session.ticks_per_block
        self._sum, self._count = np.zeros((ticks, 3)), np.zeros(ticks)

    def add(self, frames: Frames, bias_q8: np.ndarray) -> None:
        """Count in a piece of the session."""
        tick, size = self._of.ticks(frames), len(self._count)
        inside = tick < size
        tick = tick[inside]
        self._count += np.bincount(tick, minlength=size)
        for a in range(3):
            self._sum[:, a] += np.bincount(tick, bias_q8[inside, a], size)

    def ticks_dps(self) -> np.ndarray:
        """(ticks, 3), NaN where there is no sample."""
        with np.errstate(invalid="ignore"):
            return self._sum / self._count[:, None] / (256.0 * self._of.lsb)

    def blocks_dps(self) -> np.ndarray:
        """(n, 3), NaN where no tick counts."""
        return self._of.block_means(self.ticks_dps())


@dataclass(frozen=True)
class TurnOn:
    """offset_q8: (3,) from the learned curve; blocks: how many from the start it took to tell."""

    offset_q8: np.ndarray
    blocks: int


def turn_on(firmware: Firmware, power_on: PowerOn) -> TurnOn:
    """The session's turn-on offset as the firmware takes it from the first still minute.

    Where it doubts for some of it, it is given as much again; where it never rests (a moving
    recording with a reference), the offset is the mean of that minute beside the truth.
    """
    learning, frozen = firmware.copy(), firmware.copy()
    learning.power_on()
    frozen.power_on()
    frozen.set_offset((0, 0, 0))
    first, means = power_on.session.first_still, BlockMeans(power_on)
    until = int(first[-1]) + 1
    for block, frames in power_on.by_blocks():
        if not learning.offset_is_known.all():
            until = max(until, min(block + len(first), int(first[-1]) + _MORE_BLOCKS))
        if block >= until:
            break
        learning.run(frames)
        means.add(frames, frozen.run(frames, learn=False))
    left = np.nanmean((power_on.rate_dps - means.blocks_dps())[first], axis=0)
    beside_truth = np.round(np.nan_to_num(left) * 256.0 * power_on.lsb)
    offset = np.where(learning.offset_is_known, learning.target_q8 - frozen.target_q8, beside_truth)
    return TurnOn(offset.astype(np.int64), until)
