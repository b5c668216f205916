"""Accuracy on real recordings of sensors at rest, where the true rate is zero.

The error is that of the means of 20 s of corrected rate (one reading where they come slower), so
that noise does not hide it; the Earth's rate, 4 mdps, is in it. Blocks in which the sensor was
handled are left out: those marked so, and those with three times the spread of most.
"""

from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from zerorate_tools.demo.broad import rms_mdps
from zerorate_tools.importers import read_foreign
from zerorate_tools.loop.read.still import runs
from zerorate_tools.peers import Given, Peer, given
from zerorate_tools.peers.online import first_seconds
from zerorate_tools.recordings import Recording

from .peers import OURS
from .public_data import recordings, told_of

BLOCK_S = 20.0
_START_READINGS = 8
_HANDLED = 3.0


def nothing(sessions) -> list[NDArray[np.float64]]:
    """No correction."""
    return [np.zeros_like(one.rate_dps) for one in sessions]


COLUMNS: dict[str, Peer] = {"uncorrected": nothing, "mean of the first 10 s": first_seconds, **OURS}


def rest_errors(recording: Recording, peer: Peer) -> dict[str, float]:
    """RMS over axes and blocks of rest, mdps: "all", and "later" without the start."""
    still = recording.columns.get("moving")
    one = given(recording, None if still is None else still == 0)
    residual = one.rate_dps - peer([one])[0]
    start = max(BLOCK_S * one.odr_hz, _START_READINGS)
    blocks = [(first, residual[first:end]) for first, end in _rests(one)]
    later = [block.mean(axis=0) for first, block in blocks if first >= start]
    every = [block.mean(axis=0) for _, block in blocks]
    return {"all": rms_mdps(np.array(every)), "later": rms_mdps(np.array(later))}


def _rests(one: Given) -> Iterator[tuple[int, int]]:
    """First and end of each block at rest; those with far more noise than most are handled ones."""
    size = max(1, round(BLOCK_S * one.odr_hz))
    blocks = []
    for start, end in runs(one.still):
        cuts = np.linspace(start, end, max(1, (end - start) // size) + 1).astype(int)
        blocks += list(zip(cuts[:-1], cuts[1:]))
    spreads = np.array([one.rate_dps[first:end].std(axis=0).max() for first, end in blocks])
    for block, spread in zip(blocks, spreads):
        if spread <= _HANDLED * np.median(spreads):
            yield block


def real(
    folder: Path, advance: Callable[[float], None] = lambda n: None
) -> dict[str, dict[str, dict[str, float]]]:
    """Each recording of the data folder: name -> column -> `rest_errors`."""
    found = {}
    for path in recordings(folder):
        name = f"{path.parent.name}/{path.name.split('.')[0]}"
        recording, _ = read_foreign(path, **told_of(path))
        found[name] = {column: rest_errors(recording, peer) for column, peer in COLUMNS.items()}
        advance(1)
    return found
