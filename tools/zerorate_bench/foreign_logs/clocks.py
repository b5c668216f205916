"""Tables whose times, rows or ends are odd."""

import gzip
from pathlib import Path

import numpy as np
import pandas as pd

from .phones import zipped
from .world import World, log, table, text

_NAMES = "gx_dps,gy_dps,gz_dps,ax_g,ay_g,az_g,temp_c"
_START = pd.Timestamp("2026-05-01T23:59:50")


def _with_time(name: str, at, world: World) -> pd.DataFrame:
    return table(f"{name},{_NAMES}", at, world.dps, world.g, world.degc)


def _plain(world: World) -> pd.DataFrame:
    return _with_time("t_s", world.t_s, world)


def _stamps(world: World):
    return _START + pd.to_timedelta(world.t_s, unit="s")


@log("dates of ISO 8601 with a zone")
def iso_dates(folder: Path, world: World) -> Path:
    said = _stamps(world).strftime("%Y-%m-%dT%H:%M:%S.%f+02:00")
    return text(folder / "in.csv", _with_time("datetime", said, world))


@log("times of the day over midnight, comma before the milliseconds")
def over_midnight(folder: Path, world: World) -> Path:
    said = _stamps(world).strftime("%H:%M:%S,%f").str[:-3]
    return text(folder / "in.csv", _with_time("time", said, world), sep=";")


@log("milliseconds since 1970")
def epoch_ms(folder: Path, world: World) -> Path:
    at_ms = np.rint(world.t_s * 1e3).astype(np.int64) + 1_777_000_000_000
    return text(folder / "in.csv", _with_time("timestamp", at_ms, world))


@log("nanoseconds, no unit named", "--time-unit ns")
def plain_ns(folder: Path, world: World) -> Path:
    at_ns = np.rint(world.t_s * 1e9).astype(np.int64) + 4_000_000_000
    return text(folder / "in.csv", _with_time("timestamp", at_ns, world))


@log("a time whose unit nothing tells")
def unknown_time(folder: Path, world: World) -> Path:
    at_ms = np.rint(world.t_s * 1e3).astype(np.int64)
    return text(folder / "in.csv", _with_time("t", at_ms, world))


@log("micros() that runs over after 71 minutes")
def micros_over(folder: Path, world: World) -> Path:
    at_us = (np.rint(world.t_s * 1e6).astype(np.int64) + 2**32 - 10_000_000) % 2**32
    return text(folder / "in.csv", _with_time("micros", at_us, world))


@log("seconds and nanoseconds in two columns")
def two_columns_of_time(folder: Path, world: World) -> Path:
    at_ns = np.rint(world.t_s * 1e9).astype(np.int64) + 1_777_000_000 * 10**9
    names = f"header.stamp.sec,header.stamp.nanosec,{_NAMES}"
    frame = table(names, at_ns // 10**9, at_ns % 10**9, world.dps, world.g, world.degc)
    return text(folder / "in.csv", frame)


@log("no time at all", "--hz 100")
def no_time(folder: Path, world: World) -> Path:
    return text(folder / "in.csv", _plain(world).drop(columns="t_s"))


@log("a pause of five seconds", least=0.8)
def paused(folder: Path, world: World) -> Path:
    at = world.t_s
    return text(folder / "in.csv", _plain(world)[(at < 5) | (at > 10)])


@log("time begins anew: the logger was switched off and on")
def restarted(folder: Path, world: World) -> Path:
    frame = _plain(world)
    return text(folder / "in.csv", pd.concat([frame, frame]))


@log("rows out of order")
def out_of_order(folder: Path, world: World) -> Path:
    frame = _plain(world)
    order = np.arange(len(frame))
    order[100:120] = order[100:120][::-1]
    return text(folder / "in.csv", frame.iloc[order])


@log("every row written twice")
def written_twice(folder: Path, world: World) -> Path:
    return text(folder / "in.csv", _plain(world).loc[np.repeat(np.arange(world.samples), 2)])


@log("rows shuffled throughout")
def shuffled(folder: Path, world: World) -> Path:
    return text(folder / "in.csv", _plain(world).sample(frac=1, random_state=1))


@log("milliseconds with commas between thousands")
def thousands(folder: Path, world: World) -> Path:
    said = [f"{1000 * t:,.2f}" for t in world.t_s]
    return text(folder / "in.csv", _with_time("time_ms", said, world))


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
