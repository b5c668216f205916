"""The firmware through one power-on of a device that remembers those before."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from ..loop.read.sessions import Session
from ..recordings.reading import recording_name
from ..replay import replay

_FIRST_S = 60.0
_GYRO = ("bias_gx", "bias_gy", "bias_gz")


def replay_power_on(
    path: str,
    session: Session,
    state: Path,
    folder: Path | None,
    *,
    model: str | None,
    options: dict[str, Any],
) -> dict[str, Any]:
    """Replay a recording from what `state` holds, if it is there, and leave the state in it.

    folder: keeps the replay's table; model, options: as of `replay`.
    error_mdps: per axis the rms of what the firmware's bias misses of the still blocks, the first
    minute not counted. Raises ZerorateError.
    """
    name = recording_name(Path(path))
    out = (folder or state.parent) / f"{name}.replay.parquet"
    done = replay(
        path,
        out,
        state=state,
        from_state=state if state.exists() else None,
        model=model,
        options=options,
    )
    columns = ["t_us", *_GYRO]
    bias_lsb = block_means(pq.ParquetFile(out).iter_batches(columns=columns), session)
    if folder is None:
        out.unlink()
    per_dps = _lsb_per_dps(path)
    return {
        "name": name,
        "file": path,
        "samples": done.samples,
        "duration_s": session.blocks * session.block_s,
        "still_share": float(session.available.mean()) if session.blocks else 0.0,
        "sources": done.sources,
        "error_mdps": error_mdps(session, bias_lsb / per_dps, from_s=_FIRST_S),
    }


def block_means(batches: Iterable[pa.RecordBatch], session: Session) -> np.ndarray:
    """(blocks, 3) mean over each block of what a replay's table says is subtracted, LSB."""
    size, start_us = session.blocks, session.start_us
    total, count = np.zeros((size, 3)), np.zeros(size)
    for batch in batches:
        t_us = batch.column("t_us").to_numpy()
        block = ((t_us - start_us) // round(session.block_s * 1e6)).astype(np.int64)
        inside = block < size
        count += np.bincount(block[inside], minlength=size)
        for axis, column in enumerate(_GYRO):
            values = batch.column(column).to_numpy()[inside]
            total[:, axis] += np.bincount(block[inside], values, minlength=size)
    return total / np.maximum(count, 1)[:, None]


def error_mdps(
    session: Session, bias_dps: np.ndarray, from_s: float = 0.0, to_s: float = np.inf
) -> list[float] | None:
    """Per axis the rms distance of a bias from the still blocks of a stretch; None without any."""
    begin_s = np.arange(session.blocks) * session.block_s
    within = session.available & (begin_s >= from_s) & (begin_s + session.block_s <= to_s)
    if not within.any():
        return None
    left = session.rate_dps[within] - bias_dps[within]
    return [round(float(v), 4) for v in 1e3 * np.sqrt((left**2).mean(axis=0))]


def _lsb_per_dps(path: str) -> float:
    from ..recordings import open_recording

    return open_recording(path).scales.gyro_lsb_per_dps
