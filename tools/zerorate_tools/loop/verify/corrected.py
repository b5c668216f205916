"""corrected.parquet: what the firmware's kernels subtract from every sample, before and after."""

import numpy as np
import pyarrow as pa

from ...recordings.parquet_format import TableWriter
from ...replay.samples import Frames

_AXES = ("gx", "gy", "gz")
WAYS = ("before", "after", "online")


class CorrectedWriter(TableWriter):
    """Writes one file for all recordings, piece by piece as the kernels give it."""

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
        self.append(pa.table(columns))


def _repeated(text: str, n: int) -> pa.DictionaryArray:
    return pa.DictionaryArray.from_arrays(np.zeros(n, np.int8), [text])
