"""Tables whose times, rows or ends are odd."""

import gzip
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from .phones import zipped
from .world import World, Writer, log, table, text

_NAMES = "gx_dps,gy_dps,gz_dps,ax_g,ay_g,az_g,temp_c"
_START = pd.Timestamp("2026-05-01T23:59:50")


def _with_time(name: str, at, world: World) -> pd.DataFrame:
    return table(f"{name},{_NAMES}", at, world.dps, world.g, world.degc)


def _plain(world: World) -> pd.DataFrame:
    return _with_time("t_s", world.t_s, world)


def _dates(t_s: np.ndarray, form: str, digits: int = 6) -> pd.Index:
    """Dates as strftime writes them; digits: so many of a second's fraction, which ends them."""
    said = (_START + pd.to_timedelta(t_s, unit="s")).strftime(form)
    return said.str[: len(said[0]) + digits - 6]


def _whole(t_s: np.ndarray, times: float) -> np.ndarray:
    return np.rint(t_s * times).astype(np.int64)


def _timed(name: str, said: Callable[[np.ndarray], Any], **how: Any) -> Writer:
    """The world's columns beside its time as `said` writes it."""

    def write(folder: Path, world: World) -> Path:
        return text(folder / "in.csv", _with_time(name, said(world.t_s), world), **how)

    return write


log("dates of ISO 8601 with a zone")(
    _timed("datetime", lambda t_s: _dates(t_s, "%Y-%m-%dT%H:%M:%S.%f+02:00"))
)
log("times of the day over midnight, comma before the milliseconds")(
    _timed("time", lambda t_s: _dates(t_s, "%H:%M:%S,%f", 3), sep=";")
)
log("milliseconds since 1970")(_timed("timestamp", lambda t_s: _whole(t_s, 1e3) + 1_777 * 10**9))
log("nanoseconds, no unit named", "--time-unit ns")(
    _timed("timestamp", lambda t_s: _whole(t_s, 1e9) + 4 * 10**9)
)
log("a time whose unit nothing tells")(_timed("t", lambda t_s: _whole(t_s, 1e3)))
log("micros() that runs over after 71 minutes")(
    _timed("micros", lambda t_s: (_whole(t_s, 1e6) + 2**32 - 10**7) % 2**32)
)


@log("seconds and nanoseconds in two columns")
def two_columns_of_time(folder: Path, world: World) -> Path:
    at_ns = np.rint(world.t_s * 1e9).astype(np.int64) + 1_777_000_000 * 10**9
    names = f"header.stamp.sec,header.stamp.nanosec,{_NAMES}"
    frame = table(names, at_ns // 10**9, at_ns % 10**9, world.dps, world.g, world.degc)
    return text(folder / "in.csv", frame)


def _rows(chosen: Callable[[pd.DataFrame], pd.DataFrame]) -> Writer:
    """Some of the rows, or some of them again."""

    def write(folder: Path, world: World) -> Path:
        return text(folder / "in.csv", chosen(_plain(world)))

    return write


log("no time at all", "--hz 100")(_rows(lambda rows: rows.drop(columns="t_s")))
log("a pause of five seconds", least=0.8)(
    _rows(lambda rows: rows[(rows["t_s"] < 5) | (rows["t_s"] > 10)])
)
log("time begins anew: the logger was switched off and on")(
    _rows(lambda rows: pd.concat([rows, rows]))
)


@log("rows out of order")
def out_of_order(folder: Path, world: World) -> Path:
    frame = _plain(world)
    order = np.arange(len(frame))
    order[100:120] = order[100:120][::-1]
    return text(folder / "in.csv", frame.iloc[order])


log("every row written twice")(_rows(lambda rows: rows.loc[rows.index.repeat(2)]))
log("rows shuffled throughout")(_rows(lambda rows: rows.sample(frac=1, random_state=1)))
log("milliseconds with commas between thousands")(
    _timed("time_ms", lambda t_s: [f"{1000 * t:,.2f}" for t in t_s])
)


@log("the same line of names again among the rows")
def names_again(folder: Path, world: World) -> Path:
    frame = _plain(world)
    first = text(folder / "in.csv", frame[:1500]).read_text()
    return text(folder / "in.csv", frame[1500:], first)


@log("another line of names among the rows: the same columns in another order", least=0.4)
def other_names_again(folder: Path, world: World) -> Path:
    frame = _plain(world)
    order = [
        "t_s",
        *(f"{a}_g" for a in ("ax", "ay", "az")),
        *(f"g{a}_dps" for a in "zyx"),
        "temp_c",
    ]
    first = text(folder / "in.csv", frame[:1500]).read_text()
    return text(folder / "in.csv", frame[1500:][order], first)


@log("a second table beneath the first")
def second_table(folder: Path, world: World) -> Path:
    first = text(folder / "in.csv", _plain(world)[:2950]).read_text()
    magnetic = table("t_s,mx,my,mz", world.t_s[:500], np.ones((500, 3)))
    return text(folder / "in.csv", magnetic, first + "\n")


@log("cut off within the last number")
def cut_in_a_number(folder: Path, world: World) -> Path:
    path = text(folder / "in.csv", _plain(world))
    content = path.read_text()
    path.write_text(content[: content.rfind(",") + 2])  # 25.6 degC is 2
    return path


@log("cut off within a row")
def cut_in_a_row(folder: Path, world: World) -> Path:
    path = text(folder / "in.csv", _plain(world))
    content = path.read_bytes()
    path.write_bytes(content[: content.rfind(b",", 0, -20)])
    return path


@log("zeros at the end, as a card without power leaves them")
def zeros_at_the_end(folder: Path, world: World) -> Path:
    path = text(folder / "in.csv", _plain(world))
    path.write_bytes(path.read_bytes() + bytes(4096))
    return path


@log("empty cells and words among the numbers", least=0.9)
def odd_cells(folder: Path, world: World) -> Path:
    frame = _plain(world).astype(object)
    for at, word in zip(range(50, 1000, 50), ["", "nan", "ERR", "inf", "--", "-nan(ind)"] * 9):
        frame.loc[at, "gy_dps"] = word
    return text(folder / "in.csv", frame)


@log("UTF-16, tabs, CRLF")
def utf16(folder: Path, world: World) -> Path:
    path = text(folder / "in.txt", _plain(world), sep="\t", lineterminator="\r\n")
    path.write_bytes(path.read_bytes().decode().encode("utf-16"))
    return path


@log("packed by gzip")
def packed(folder: Path, world: World) -> Path:
    path = text(folder / "in.csv", _plain(world))
    (folder / "in.csv.gz").write_bytes(gzip.compress(path.read_bytes()))
    return folder / "in.csv.gz"


@log("one table in a zip")
def one_in_a_zip(folder: Path, world: World) -> Path:
    return zipped(folder / "in.zip", [text(folder / "log.csv", _plain(world))], folder)


@log("decimal commas and semicolons, as Excel writes them")
def decimal_commas(folder: Path, world: World) -> Path:
    return text(folder / "in.csv", _plain(world), sep=";", decimal=",")


@log("sorted by the clock of another sensor: rates in every tenth row", least=0.09)
def seldom_rates(folder: Path, world: World) -> Path:
    frame = _plain(world)
    frame.loc[np.arange(len(frame)) % 10 != 0, ["gx_dps", "gy_dps", "gz_dps"]] = np.nan
    return text(folder / "in.csv", frame)
