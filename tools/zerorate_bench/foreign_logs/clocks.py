"""Tables whose times, rows or ends are odd."""

import gzip

import numpy as np
import pandas as pd

from .world import RATES, Logs, World, csv, emptied, plain, table

log = Logs()
# fmt: off
NIGHT = "2026-05-01T23:59:50"
_TURNED = ["t_s", "ax_g", "ay_g", "az_g", "gz_dps", "gy_dps", "gx_dps", "temp_c"]

log.csv("dates of ISO 8601 with a zone",
    lambda w: plain(w, "datetime", w.dates("%Y-%m-%dT%H:%M:%S.%f+02:00", start=NIGHT)))
log.csv("times of the day over midnight, comma before the milliseconds",
    lambda w: plain(w, "time", w.dates("%H:%M:%S,%f", 3, NIGHT)), sep=";")
log.csv("milliseconds since 1970", lambda w: plain(w, "timestamp", w.whole(1e3, 1_777_000_000_000)))
log.csv("nanoseconds, no unit named",
    lambda w: plain(w, "timestamp", w.whole(1e9, 4_000_000_000)), words="--time-unit ns")
log.csv("a time whose unit nothing tells", lambda w: plain(w, "t", w.whole(1e3)))
log.csv("micros() that runs over after 71 minutes",
    lambda w: plain(w, "micros", w.whole(1e6, 2**32 - 10**7) % 2**32))
log.csv("micros() after 20 minutes, as many as seconds since 1970",
    lambda w: plain(w, "timestamp", w.whole(1e6, 1_300_000_000)))
log.csv("ticks of 1/32768 s",
    lambda w: plain(w, "ticks", w.whole(2**15)), words=f"--map t_us=ticks:x{1e6 / 2**15}")
log.csv("seconds and nanoseconds in two columns",
    lambda w: table("header.stamp.sec,header.stamp.nanosec,g{xyz}_dps,a{xyz}_g,temp_c",
        *np.divmod(w.whole(1e9, 1_777_000_000 * 10**9), 10**9), w.dps, w.g, w.degc))
log.csv("no time at all", lambda w: plain(w).drop(columns="t_s"), words="--hz 100")
log.csv("a pause of five seconds", lambda w: plain(w)[(w.t_s < 5) | (w.t_s > 10)], least=0.8)
log.csv("time begins anew: the logger was switched off and on",
    lambda w: pd.concat([plain(w), plain(w)]))
log.csv("rows out of order", lambda w: plain(w).iloc[np.r_[:100, 119:99:-1, 120 : w.samples]])
log.csv("every row written twice", lambda w: plain(w).loc[w.count.repeat(2)])
log.csv("rows shuffled throughout", lambda w: plain(w).sample(frac=1, random_state=1))
log.csv("milliseconds with commas between thousands",
    lambda w: plain(w, "time_ms", [f"{1000 * t:,.2f}" for t in w.t_s]))
log.text("the same line of names again among the rows",
    lambda w: csv(plain(w)[:1500]) + csv(plain(w)[1500:]), "in.csv")
log.text("another line of names among the rows: the same columns in another order",
    lambda w: csv(plain(w)[:1500]) + csv(plain(w)[1500:][_TURNED]), "in.csv", least=0.4)
log.text("a second table beneath the first",
    lambda w: (csv(plain(w)[:2950]) + "\n"
        + csv(table("t_s,m{xyz}", w.t_s[:500], np.ones((500, 3))))), "in.csv")
log.text("cut off within the last number", lambda w: _cut(csv(plain(w)), 2), "in.csv")
log.text("cut off within a row", lambda w: _cut(csv(plain(w))[:-20]), "in.csv")
log.file("zeros at the end, as a card without power leaves them",
    "in.csv", lambda path, w: path.write_bytes(csv(plain(w)).encode() + bytes(4096)))


def _cut(content: str, more: int = 0) -> str:
    """What ends so many letters from the last comma on: 25.6 degC is 2."""
    return content[: content.rfind(",") + more]


def _odd_cells(world: World) -> pd.DataFrame:
    frame = plain(world).astype(object)
    for at, word in zip(range(50, 1000, 50), ["", "nan", "ERR", "inf", "--", "-nan(ind)"] * 9):
        frame.loc[at, "gy_dps"] = word
    return frame


log.csv("empty cells and words among the numbers", _odd_cells, least=0.9)
log.file("UTF-16, tabs, CRLF",
    "in.txt", lambda path,
    w: path.write_bytes(csv(plain(w), sep="\t", lineterminator="\r\n").encode("utf-16")))
log.file("packed by gzip",
    "in.csv.gz", lambda path, w: path.write_bytes(gzip.compress(csv(plain(w)).encode())))
log.files("one table in a zip", "in.zip", lambda w: {"log.csv": csv(plain(w))})
log.csv("decimal commas and semicolons, as Excel writes them", plain, sep=";", decimal=",")
log.csv("sorted by the clock of another sensor: rates in every tenth row",
    lambda w: emptied(plain(w), w.count % 10 != 0, RATES), least=0.09)
