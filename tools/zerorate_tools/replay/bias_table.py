"""The replay's Parquet: per sample the bias, its source and its quality (design.md)."""

from pathlib import Path

import numpy as np
import pyarrow as pa

from ..recordings.parquet_format import TableWriter
from .engines import Outcome

SOURCES = ("none", "any-temperature", "fit", "this-temperature", "in-motion", "gravity")
VERDICTS = (
    *("good", "repeat", "rail", "all-zero", "all-ones", "temperature-jump", "time-stood-still"),
    "time-leapt",
)
_AXES = "xyz"


def table(outcome: Outcome) -> pa.Table:
    """One batch as a table.

    `source` is the least trusted of the three axes' and `quality_lsb` the worst; `quality_g?` are
    each axis' own.
    """
    columns: dict[str, pa.Array] = {"t_us": pa.array(outcome.t_us)}
    for i, axis in enumerate(_AXES):
        columns[f"bias_g{axis}"] = pa.array(outcome.bias_q8[:, i] / 256.0)
    columns["source"] = _named(outcome.least_source, SOURCES)
    quality = [outcome.quality_q8[:, i] / np.float32(256.0) for i in range(3)]
    columns["quality_lsb"] = pa.array(np.maximum(np.maximum(*quality[:2]), quality[2]))
    for axis, values in zip(_AXES, quality):
        columns[f"quality_g{axis}"] = pa.array(values)
    columns["verdict"] = _named(outcome.verdict, VERDICTS)
    return pa.table(columns)


def _named(codes: np.ndarray, names: tuple[str, ...]) -> pa.Array:
    return pa.DictionaryArray.from_arrays(codes.astype(np.int8), list(names))


class ReplayWriter(TableWriter):
    def __init__(self, path: Path) -> None:
        # time never returns, and what was learned stays for long: no dictionary of those
        super().__init__(
            path,
            use_dictionary=["source", "verdict"],
            column_encoding={"t_us": "DELTA_BINARY_PACKED"},
            write_statistics=["t_us"],
        )

    def write(self, outcome: Outcome) -> None:
        self.append(table(outcome))
