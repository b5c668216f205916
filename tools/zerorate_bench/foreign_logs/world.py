"""What a sensor saw for half a minute: the truth that every log of the corpus holds."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
import pandas as pd

STANDARD_GRAVITY = 9.80665
BIAS_DPS = (0.8, -0.5, 0.3)
_NOISE_DPS, _NOISE_G = 0.05, 0.004
_FASTEST_DPS = 40.0


@dataclass(frozen=True)
class World:
    """A sensor at rest, turned by hand about its z, and at rest again.

    Rates hold the bias; the force is gravity's; the temperature rises. All begin at t_s = 0.
    """

    samples: int = 3000
    hz: float = 100.0
    seed: int = 7

    @cached_property
    def t_s(self) -> np.ndarray:
        """(n,) seconds."""
        return np.arange(self.samples) / self.hz

    @cached_property
    def dps(self) -> np.ndarray:
        """(n, 3) rates in deg/s."""
        rng = np.random.default_rng(self.seed)
        turn = np.clip(1.0 - np.abs(self.t_s / self.t_s[-1] - 0.6) / 0.1, 0.0, 1.0)
        out = np.array(BIAS_DPS) + _NOISE_DPS * rng.standard_normal((self.samples, 3))
        out[:, 2] += _FASTEST_DPS * turn
        return out

    @cached_property
    def g(self) -> np.ndarray:
        """(n, 3) specific force in g."""
        rng = np.random.default_rng(self.seed + 1)
        level = np.array([0.1, -0.2, 0.0])
        level[2] = np.sqrt(1.0 - level @ level)
        return level + _NOISE_G * rng.standard_normal((self.samples, 3))

    @cached_property
    def degc(self) -> np.ndarray:
        """(n,) temperature of the die."""
        return 25.0 + 0.02 * self.t_s

    @property
    def rad(self) -> np.ndarray:
        return np.radians(self.dps)

    @property
    def mps2(self) -> np.ndarray:
        return self.g * STANDARD_GRAVITY

    def counts(self, gyro: float = 131.0, accel: float = 16384.0) -> tuple[np.ndarray, np.ndarray]:
        """Rates and forces as whole counts of so many a deg/s and a g."""
        return np.rint(self.dps * gyro).astype(int), np.rint(self.g * accel).astype(int)


#: Takes a folder and a world, writes a log of it there, and returns the log's path.
Writer = Callable[[Path, World], Path]


@dataclass(frozen=True)
class Log:
    """One log of the corpus. words: what a user knows and types beside the file's name; least and
    most: the share of the samples that a sound import holds, which is none beyond all of them."""

    what: str
    write: Writer
    words: str = ""
    least: float = 0.98
    most: float = 1.0


#: Every log, in the order of the modules that write them.
CORPUS: list[Log] = []


def log(what: str, words: str = "", least: float = 0.98, most: float = 1.0):
    """Register a writer of a log."""

    def add(write: Writer) -> Writer:
        CORPUS.append(Log(what, write, words, least, most))
        return write

    return add


def table(names: Sequence[str] | str, *columns) -> pd.DataFrame:
    """Columns side by side; an (n, 3) one is three. names: a comma parts them."""
    names = names.split(",") if isinstance(names, str) else names
    flat = [np.asarray(c) for c in columns]
    flat = [part for c in flat for part in (c.T if c.ndim == 2 else [c])]
    return pd.DataFrame(dict(enumerate(flat))).set_axis(names, axis=1)


def text(path: Path, frame: pd.DataFrame, before: str = "", **how) -> Path:
    """A frame as a CSV, after lines of other things."""
    path.parent.mkdir(parents=True, exist_ok=True)
    how = {"index": False, "float_format": "%.15g", "lineterminator": "\n", **how}
    path.write_text(before + frame.to_csv(**how), encoding="utf-8")
    return path
