"""What a sensor saw for ten or thirty seconds: the truth that every log of the corpus holds."""

import re
import zipfile
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

STANDARD_GRAVITY = 9.80665
AFTERNOON = "2026-05-01T14:17:54.120"
#: Nanoseconds since 1970.
EPOCH_NS = 1_700_000_000_000_000_000
BIAS_DPS = (0.8, -0.5, 0.3)
#: Columns of `plain`.
RATES, FORCES = ["gx_dps", "gy_dps", "gz_dps"], ["ax_g", "ay_g", "az_g"]
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

    @property
    def ns(self) -> np.ndarray:
        """Nanoseconds since 1970."""
        return self.whole(1e9, EPOCH_NS)

    def whole(self, a_second: float, start: int = 0) -> np.ndarray:
        """Times in whole parts of a second from `start` on."""
        return np.rint(self.t_s * a_second).astype(np.int64) + start

    def dates(self, form: str, digits: int = 6, start: str = AFTERNOON) -> pd.Index:
        """As strftime writes them; digits: so many of a second's fraction, which ends them."""
        said = (pd.Timestamp(start) + pd.to_timedelta(self.t_s, unit="s")).strftime(form)
        return said.str[: len(said[0]) + digits - 6]

    def each(self, value: Any) -> np.ndarray:
        """The same in every row."""
        return np.tile(value, (self.samples, 1)) if np.ndim(value) else np.full(self.samples, value)

    @property
    def count(self) -> np.ndarray:
        """Numbers of the rows from 0 on."""
        return np.arange(self.samples)


#: Takes a folder and a world, writes a log of it there, and returns the log's path.
Writer = Callable[[Path, World], Path]


@dataclass(frozen=True)
class Log:
    """One log of the corpus. words: what a user knows and types beside the file's name; least and
    most: the share of the samples that a sound import holds, which is none beyond all of them;
    samples: how long the log is."""

    what: str
    write: Writer
    words: str = ""
    least: float = 0.98
    most: float = 1.0
    samples: int = 3000


#: Every log, in the order of the modules that write them.
CORPUS: list[Log] = []


class Logs:
    """Registers the logs of a module; `known`: fields of Log, each method returns the writer."""

    def __init__(self, **known: Any) -> None:
        self._known = known

    def add(self, what: str, write: Writer, **known: Any) -> Writer:
        """Register a writer."""
        CORPUS.append(Log(what, write, **self._known | known))
        return write

    def file(
        self, what: str, name: str, fill: Callable[[Path, World], object], **known: Any
    ) -> Writer:
        """Register a log of one file, which `fill` writes."""

        def write(folder: Path, world: World) -> Path:
            fill(folder / name, world)
            return folder / name

        return self.add(what, write, **known)

    def text(
        self, what: str, content: Callable[[World], str], name: str = "in.txt", **known: Any
    ) -> Writer:
        """Register a log of one file of text."""
        return self.file(what, name, lambda path, w: path.write_text(content(w), "utf-8"), **known)

    def files(
        self, what: str, name: str, texts: Callable[[World], dict[str, str]], **known: Any
    ) -> Writer:
        """Register files of text by their names: in a zip or a folder of a name, or beside the one
        of them that is given."""

        def fill(path: Path, world: World) -> None:
            if path.suffix == ".zip":
                with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
                    for member, content in texts(world).items():
                        archive.writestr(member, content)
                return
            root = path.parent if path.suffix else path
            for member, content in texts(world).items():
                (root / member).parent.mkdir(parents=True, exist_ok=True)
                (root / member).write_text(content, encoding="utf-8")

        return self.file(what, name, fill, **known)

    def csv(
        self, what: str, frame: Callable[[World], pd.DataFrame], before: str = "", **more: Any
    ) -> Writer:
        """Register a table, after lines of other things. more: fields of Log, the file's name, and
        what pandas takes."""
        known = {name: more.pop(name) for name in ("words", "least", "most") if name in more}
        name = more.pop("name", "in.csv")
        return self.text(what, lambda w: before + csv(frame(w), **more), name, **known)


def table(names: Sequence[str] | str, *columns: Any) -> pd.DataFrame:
    """Columns side by side; an (n, 3) one is three. names: a comma parts them, and a letter in
    braces stands for itself: `g{xyz}` is gx, gy and gz."""
    names = names.split(",") if isinstance(names, str) else names
    flat = [np.asarray(c) for c in columns]
    flat = [part for c in flat for part in (c.T if c.ndim == 2 else [c])]
    return pd.DataFrame(dict(enumerate(flat))).set_axis(spelled(names), axis=1)


def spelled(names: Sequence[str]) -> list[str]:
    """Names, each with braces once for each letter in them."""
    parts = [re.fullmatch(r"(.*?)(?:\{(\w+)\}(.*))?", name, re.DOTALL) for name in names]
    return [
        f"{part[1]}{letter}{part[3] or ''}" for part in parts if part for letter in part[2] or [""]
    ]


def plain(world: World, name: str = "t_s", at: Any = None) -> pd.DataFrame:
    """The world's columns beside its time, or a time by another name."""
    names = f"{name},g{{xyz}}_dps,a{{xyz}}_g,temp_c"
    return table(names, world.t_s if at is None else at, world.dps, world.g, world.degc)


def emptied(frame: pd.DataFrame, rows: Any, names: list[str]) -> pd.DataFrame:
    """The same without numbers in some columns of some rows."""
    frame.iloc[rows, [*map(frame.columns.get_loc, names)]] = np.nan
    return frame


def csv(frame: pd.DataFrame, **how: Any) -> str:
    """A frame as a CSV. how: as pandas takes it."""
    return str(
        frame.to_csv(**{"index": False, "float_format": "%.15g", "lineterminator": "\n", **how})
    )
