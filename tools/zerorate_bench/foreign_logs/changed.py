"""Logs that change on the way, hold two devices, or have holes."""

from functools import partial

import numpy as np
import pandas as pd

from .clocks import NIGHT
from .world import FORCES, RATES, STANDARD_GRAVITY, Logs, World, csv, emptied, plain, table

log = Logs()
# fmt: off
_SIX = [*RATES, *FORCES]
_SECOND = "%Y-%m-%d %H:%M:%S"


def _in_turn(world: World, of: tuple[int, float, float, int]) -> pd.DataFrame:
    """Rows of several devices, each with its own bias and mounting, without a word of whose."""
    devices, late_s, apart_s, block = of
    rng, one = np.random.default_rng(3), []
    for number in range(devices):
        other = World(world.samples, world.hz, world.seed + 10 * number)
        part = plain(world, "t_s", world.t_s + number * late_s + (number > 0) * apart_s)
        part[RATES] = other.dps + number * rng.uniform(-1, 1, 3)
        part[FORCES] = np.roll(other.g, number, axis=1)
        part["temp_c"] += number
        one.append(part.assign(block=world.count // block, device=number, row=world.count))
    both = pd.concat(one).sort_values(["block", "device", "row"])
    return both[plain(world).columns]


# what, how many, how much later each is (s), the second's clock (s), rows of each in turn
_DEVICES: tuple[tuple[str, tuple[int, float, float, int]], ...] = (
    ("two devices in turn, without a word of whose: at the same times", (2, 0.0, 0.0, 1)),
    ("two devices in turn: half a period apart", (2, 0.005, 0.0, 1)),
    ("two devices in turn: each has its own clock, so times go back and forth", (2, 0.0, 0.237, 1)),
    ("two devices in turn: one was switched on an hour before", (2, 0.0, 3600.0, 1)),
    ("three devices in turn", (3, 0.002, 0.0, 1)),
    ("two devices: ten rows of one, ten of the other, at the same times", (2, 0.0, 0.0, 10)),
)
for what, of in _DEVICES:
    log.csv(what, partial(_in_turn, of=of), least=2.0)

log.csv("dates of whole seconds: a hundred rows share each",
    lambda w: plain(w, "datetime", w.dates("%Y-%m-%dT%H:%M:%SZ", start=NIGHT)))
log.csv("times of the day of whole seconds, begun within one, over midnight",
    lambda w: plain(w, "time", w.dates("%H:%M:%S", start="2026-05-01T23:59:50.630")))
log.csv("dates of whole seconds, and a pause of five",
    lambda w: plain(w, "datetime", w.dates(_SECOND, start=NIGHT))[(w.t_s < 5) | (w.t_s >= 10)],
    least=0.8)
log.csv("dates of whole seconds, some of whose rows are lost",
    lambda w: plain(w, "datetime", w.dates(_SECOND, start=NIGHT))[
        np.random.default_rng(4).random(w.samples) > 0.3])
log.csv("two samples in every tick of 20 ms",
    lambda w: plain(w, "t_ms", 20 * np.floor(w.t_s / 0.02 + 1e-9).astype(int)))


def _with_hole(world: World, names: list[str], last: int | None = 1500) -> pd.DataFrame:
    """No number in some columns from row 800 on."""
    return emptied(plain(world), slice(800, last), names)


_EVERY = [*_SIX, "temp_c"]
log.csv("no rates for seven seconds", lambda w: _with_hole(w, RATES), least=0.7, most=0.77)
log.csv("nothing but times for seven seconds",
    lambda w: _with_hole(w, _EVERY), least=0.7, most=0.77)
log.csv("no acceleration for seven seconds", lambda w: _with_hole(w, FORCES), least=0.7, most=0.84)
log.csv("no temperature for seven seconds",
    lambda w: _with_hole(w, ["temp_c"]), least=0.7, most=0.84)
log.csv("no temperature after eight seconds",
    lambda w: _with_hole(w, ["temp_c"], None), least=0.25, most=0.34)
log.text("the last column is missing half way through",
    lambda w: csv(plain(w)[:1500]) + csv(plain(w)[1500:].drop(columns="temp_c"), header=False),
    "in.csv", least=0.48, most=0.55)


def _other_unit(world: World, names: list[str], times: float) -> pd.DataFrame:
    """Another unit from a row at rest on."""
    frame = plain(world)
    frame.loc[1350:, names] *= times
    return frame


log.csv("deg/s become mdps on the way, at rest", lambda w: _other_unit(w, RATES, 1000), least=0.43)
log.csv("deg/s become rad/s on the way, at rest",
    lambda w: _other_unit(w, RATES, np.radians(1)), least=0.43)
log.csv("g become m/s2 on the way, at rest",
    lambda w: _other_unit(w, FORCES, STANDARD_GRAVITY), least=0.43)
log.csv("units in a comment above the names",
    lambda w: table("t,g{xyz},a{xyz}", w.t_s, w.rad, w.mps2),
    "# s, rad/s, rad/s, rad/s, m/s2, m/s2, m/s2\n")
log.csv("units in a comment beneath the names",
    lambda w: table("t,g{xyz},a{xyz}", w.t_s, w.rad, w.mps2),
    "t,gx,gy,gz,ax,ay,az\n# s,rad/s,rad/s,rad/s,m/s^2,m/s^2,m/s^2\n", header=False)
log.csv("CRLF and the mark of UTF-8", plain, "\ufeff", lineterminator="\r\n")
log.csv("decimal commas within quotes, commas between",
    lambda w: plain(w).map(lambda value: f"{value:.6f}".replace(".", ",")))
log.csv("times with a decimal comma within quotes",
    lambda w: plain(w, "time_s", [f"{t:.3f}".replace(".", ",") for t in w.t_s]))
log.csv("times of the day with a comma before the milliseconds, within quotes",
    lambda w: plain(w, "time", w.dates("%H:%M:%S,%f", 3, NIGHT)))


def _on_lines(world: World, hz: float) -> pd.DataFrame:
    """The log on an even grid, as pandas' resample and interpolate make it."""
    at = np.arange(0.0, world.t_s[-1], 1.0 / hz)
    return pd.DataFrame({n: np.interp(at, world.t_s, of) for n, of in plain(world).items()})


log.csv("resampled from 100 to 400 Hz, on lines between the samples", lambda w: _on_lines(w, 400.0))
log.csv("resampled from 100 to 333 Hz, on lines between the samples", lambda w: _on_lines(w, 333.0))
log.csv("seven seconds filled with a line",
    lambda w: _with_hole(w, _EVERY).interpolate(), least=0.7, most=0.77)
log.csv("OpenCamera Sensors: three rates and nanoseconds, no names",
    lambda w: table("g{xyz},t", w.rad, (1e14 + w.t_s * 1e9).astype(np.int64)), name="VID_1gyro.csv",
    header=False)
log.csv("a fibre gyroscope's deg/h",
    lambda w: table("time [s],w{xyz} [deg/hr]", w.t_s, 3600 * w.dps))
