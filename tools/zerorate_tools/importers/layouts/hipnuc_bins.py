"""HiPNUC device-side means per 2 degC bin: a table over temperature, without time."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ...errors import BadRecording
from ..foreign import Foreign
from ..table import first_line
from ..units import ACCEL_G, RATE_DPS

if TYPE_CHECKING:
    import pandas

_BIN = re.compile(r"BIN_DATA:(.*?)(?=BIN_DATA:|$)", re.DOTALL)


def recognises(path: Path) -> bool:
    """By its first line."""
    return path.suffix == ".log" and first_line(path).startswith("BIN_DATA:")


def read(path: Path) -> Foreign:
    """Always raises BadRecording: there is no time to replay."""
    problem = f"a table of {len(read_bins(path))} temperature bins without time: nothing to replay"
    do = "read it with zerorate_tools.importers.read_bins, as the loop's bench does"
    raise BadRecording(path, problem, do=do)


def read_bins(path: Path) -> pandas.DataFrame:
    """One row a bin: bin, temp_degc, n, ax ay az (g), gx gy gz (dps).

    Where the log has them, turning_n samples while turning and their turning_gz (dps; NaN without
    any). Raises BadRecording.
    """
    import pandas

    rows = [
        [float(cell) for cell in match.strip().rstrip(",").split(",")]
        for match in _BIN.findall(Path(path).read_text())
    ]
    if not rows or any(len(row) not in (9, 11) for row in rows):
        raise BadRecording(path, "no BIN_DATA of 9 or 11 values", do="name another file")
    wide = len(rows[0]) == 11
    names = ["bin", "temp_degc", "n", *(["turning_n"] if wide else []), "ax", "ay", "az"]
    frame = pandas.DataFrame(rows, columns=[*names, "gx", "gy", "gz", *(["turning_gz"] * wide)])
    for axis in "xyz":
        frame[f"a{axis}"] *= ACCEL_G["m/s2"]
        frame[f"g{axis}"] *= RATE_DPS["rad/s"]
    if wide:
        frame.loc[frame["turning_n"] == 0, "turning_gz"] = np.nan
    return frame.astype({"bin": int, "n": int})
