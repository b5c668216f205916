"""A recording's columns as the frames that the firmware reads."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..recordings import Recording
from ..recordings.reading import OpenRecording
from ..recordings.recording import Columns

FRAME = ("ax", "ay", "az", "temp", "gx", "gy", "gz")
_MOST_US = 1 << 29
_MOST_LSB = 1 << 21  # far beyond a rail of 16 bits; eight bits of fraction more fit the kernels' 31


@dataclass(frozen=True)
class Frames:
    """Samples as the board sees them.

    t_us: (n,) int64; frames: (n, 7) int32 in the order of FRAME, 0 for an absent channel;
    dt_us: (n,) int32 since the sample before, the nominal period for the very first; extra:
    (n, channels) int32, the extra channels that were asked for.
    """

    t_us: NDArray[np.int64]
    frames: NDArray[np.int32]
    dt_us: NDArray[np.int32]
    extra: NDArray[np.int32]

    def __len__(self) -> int:
        return len(self.t_us)


def frames_in_batches(
    recording: OpenRecording | Recording, rows: int = 65536, channels: Sequence[str] = ()
) -> Iterator[Frames]:
    """Yield a recording as Frames of at most `rows` samples each, with these extra channels."""
    before = None
    for columns in _batches(recording, rows):
        if before is None:
            before = int(columns["t_us"][0] - round(1e6 / recording.scales.odr_hz))
        yield frames_of(columns, before, channels)
        before = int(columns["t_us"][-1])


def frames_of(columns: Mapping[str, Any], before_us: int, channels: Sequence[str] = ()) -> Frames:
    """Columns as Frames, with these extra channels. before_us: when the sample before them came."""
    t_us = np.asarray(columns["t_us"], np.int64)
    steps = np.clip(np.diff(t_us, prepend=before_us), -_MOST_US, _MOST_US)
    frames = np.zeros((len(t_us), len(FRAME)), np.int32)
    for i, name in enumerate(FRAME):
        if name in columns:
            frames[:, i] = np.clip(columns[name], -_MOST_LSB, _MOST_LSB)
    extra = np.zeros((len(t_us), len(channels)), np.int32)
    for i, name in enumerate(channels):
        extra[:, i] = columns[name]
    return Frames(t_us, frames, steps.astype(np.int32), extra)


def _batches(recording: OpenRecording | Recording, rows: int) -> Iterator[Columns]:
    if isinstance(recording, OpenRecording):
        yield from recording.batches(rows)
        return
    for start in range(0, len(recording.columns["t_us"]), rows):
        yield {name: values[start : start + rows] for name, values in recording.columns.items()}
