"""corrected.parquet: what the firmware's kernels subtract from every sample, before and after."""

from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from ...replay.samples import Frames

_AXES = ("gx", "gy", "gz")
WAYS = ("before", "after", "online")


class CorrectedWriter:
    """Writes one file for all recordings, piece by piece as the kernels give it."""

    def __init__(self, path: Path) -> None:
        self._path = path
        self._writer: pq.ParquetWriter | None = None

    def write(self, recording: str, frames: Frames, test: np.ndarray, biases: dict) -> None:
        """Append samples of a recording (its file's name).

        test: (n,) bool, of the part held out; biases: (n, 3) LSB in Q8 by way, of which those in
        WAYS are written.
        """
        columns = {
            "recording": _repeated(recording, len(test)),
            "t_us": pa.array(frames.t_us),
            "split": pa.DictionaryArray.from_arrays(test.astype(np.int8), ["train", "test"]),
        }
        for way in WAYS:
            if way in biases:
                lsb = biases[way] / np.float32(256.0)
                columns.update({f"bias_{way}_{g}": lsb[:, a] for a, g in enumerate(_AXES)})
        table = pa.table(columns)
        if self._writer is None:
            self._writer = pq.ParquetWriter(self._path, table.schema, compression="zstd")
        self._writer.write_table(table)

    def close(self) -> None:
        """Finish the file."""
        if self._writer is not None:
            self._writer.close()


def _repeated(text: str, n: int) -> pa.DictionaryArray:
    return pa.DictionaryArray.from_arrays(np.zeros(n, np.int8), [text])
