"""corrected.parquet: at every sample what the frozen model takes for the bias, before and after."""

from __future__ import annotations

from os import PathLike

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from ..recordings import open_recording
from ..recordings.atomic import written_beside
from ..recordings.recording import TIME
from .analysis import Analysis
from .basis import evaluate
from .line import deployed
from .sessions import Session

_AXES = ("gx", "gy", "gz")


def tick_bias(analysis: Analysis, session: Session, after: bool) -> np.ndarray:
    """(ticks, 3) dps: offset, straight line and, after, the effects; each held for the next tick.

    The float reference of what the firmware's kernels do. The offset is that of the first still
    minute of a locked session, of the whole session where it was fitted.
    """
    terms, coefficients = deployed(analysis.selection, after)
    model = np.zeros((session.blocks * session.ticks_per_block, 3))
    for term, c in zip(terms, coefficients):
        model += np.outer(evaluate(term, session.source, session.tick_s), c)
    model += _offset(analysis, session, model)
    return np.vstack([model[:1], model[:-1]])


def _offset(analysis, session, model):
    block = np.column_stack([session.block_mean(model[:, a]) for a in range(3)])
    left = np.where(session.available[:, None], session.rate_dps - block, np.nan)
    locked = [s.name for s in analysis.locked]
    if analysis.single or session.name not in locked:
        return np.nanmean(left, axis=0)
    first = np.flatnonzero(session.available)[: max(1, round(60.0 / session.block_s))]
    return left[first].mean(axis=0)


def split_of(analysis: Analysis, session: Session) -> np.ndarray:
    """(blocks,) bool: blocks of the locked part."""
    for s in analysis.locked:
        if s.name == session.name:
            return s.available if analysis.single else np.ones(s.blocks, bool)
    return np.zeros(session.blocks, bool)


def write_corrected(analysis: Analysis, paths: list, out: str | PathLike[str]) -> None:
    """Stream every recording that was used into one Parquet file."""
    by_name = {s.name: s for s in analysis.sessions}
    with written_beside(out) as temporary:
        writer = None
        for path in paths:
            opened = open_recording(path, keep_gaps=True)
            session = by_name.get(opened.name)
            if session is None:
                continue
            for table in _tables(analysis, session, opened):
                writer = writer or pq.ParquetWriter(temporary, table.schema, compression="zstd")
                writer.write_table(table)
        if writer:
            writer.close()


def _tables(analysis, session, opened):
    lsb = opened.scales.gyro_lsb_per_dps
    before = (tick_bias(analysis, session, False) * lsb).astype(np.float32)
    after = (tick_bias(analysis, session, True) * lsb).astype(np.float32)
    test = np.repeat(split_of(analysis, session), session.ticks_per_block)
    start = None
    for batch in opened.batches(rows=1 << 18):
        start = int(batch[TIME][0]) if start is None else start
        at = ((batch[TIME] - start) / (session.tick_s * 1e6)).astype(np.int64)
        at = np.minimum(at, len(before) - 1)
        yield _table(opened.path.name, batch[TIME], test[at], before[at], after[at])


def _table(name, t_us, test, before, after):
    columns = {
        "recording": pa.array([name] * len(t_us)).dictionary_encode(),
        "t_us": t_us,
        "split": pa.array(np.where(test, "test", "train")).dictionary_encode(),
    }
    columns.update({f"bias_before_{g}": before[:, a] for a, g in enumerate(_AXES)})
    columns.update({f"bias_after_{g}": after[:, a] for a, g in enumerate(_AXES)})
    return pa.table(columns)
