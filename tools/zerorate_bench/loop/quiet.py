"""Quiet real recordings as the noise of devices: block means, cut into sessions."""

import os
from pathlib import Path

import numpy as np

from ..public_data import LONG_RESTS

#: The folder of block means is handed to worker processes by the environment.
FOLDER = "ZERORATE_QUIET_BLOCKS"
_GYRO = ("gx_lsb", "gy_lsb", "gz_lsb")
_DPS_PER_LSB = 0.05


def write_blocks(data: Path, folder: Path) -> list[str]:
    """Write the block means of the long recordings at rest as .npy, and return their names."""
    import pyarrow.parquet as pq

    names = []
    for pattern, hz in LONG_RESTS.items():
        for path in sorted(data.glob(pattern)):
            table = pq.read_table(path, columns=list(_GYRO))
            rate = np.column_stack([c.to_numpy() for c in table.columns]) * _DPS_PER_LSB
            for seconds in (10, 20):
                per = int(seconds * hz)
                n = len(rate) // per
                names.append(f"{path.stem}-{seconds}s.npy")
                np.save(folder / names[-1], rate[: n * per].reshape(n, per, 3).mean(axis=1))
    return names


def cut_into_sessions(name: str, seed: int) -> tuple[list, list]:
    """Four sessions of a quiet recording with simulated channels that mean nothing, and their
    noise. The cuts, their order, the axes' signs and the direction of time are drawn from the seed.
    """
    from zerorate_tools.loop.read.sessions import Session

    from .simulated import BLOCK_S, TICKS, channels

    rng = np.random.default_rng(seed)
    blocks = np.load(Path(os.environ[FOLDER]) / name)
    length = int(rng.uniform(0.18, 0.245) * len(blocks))
    slack = len(blocks) - 4 * length
    starts = np.sort(rng.integers(0, slack + 1, 4)) + length * np.arange(4)
    sign = rng.choice([-1.0, 1.0], 3)
    backwards = rng.random() < 0.5
    out = []
    for i, s in enumerate(starts[rng.permutation(4)]):
        rate = blocks[s : s + length] * sign
        rate = rate[::-1].copy() if backwards else rate.copy()
        sources = channels(rng, length * TICKS, BLOCK_S / TICKS)
        out.append(Session(f"cut-{i + 1}", BLOCK_S, TICKS, rate, np.ones(length), sources))
    return out, [s.rate_dps for s in out]
