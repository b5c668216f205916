"""Logs that change on the way, hold two devices, or have holes."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd

from .clocks import _dates, _plain, _with_time
from .world import STANDARD_GRAVITY, World, Writer, log, table, text

_SIX = ["gx_dps", "gy_dps", "gz_dps", "ax_g", "ay_g", "az_g"]


def _in_turn(devices: int, late_s: float, apart_s: float = 0.0, block: int = 1) -> Writer:
    """Rows of several devices, each with its own bias and mounting, without a word of whose."""

    def write(folder: Path, world: World) -> Path:
        rng = np.random.default_rng(3)
        one = []
        for number in range(devices):
            other = World(world.samples, world.hz, world.seed + 10 * number)
            mounted = np.roll(other.g, number, axis=1)
            at = world.t_s + number * late_s + (number > 0) * apart_s
            rates = other.dps + number * rng.uniform(-1, 1, 3)
            block_of = np.arange(world.samples) // block
            part = table("t_s,temp_c,block", at, world.degc + number, block_of)
            part[_SIX] = np.column_stack([rates, mounted])
            one.append(part.assign(device=number, row=np.arange(world.samples)))
        both = pd.concat(one).sort_values(["block", "device", "row"])
        return text(folder / "in.csv", both[_plain(world).columns])

    return write


log("two devices in turn, without a word of whose: at the same times", least=2.0)(_in_turn(2, 0.0))
log("two devices in turn: half a period apart", least=2.0)(_in_turn(2, 0.005))
log("two devices in turn: each has its own clock, so times go back and forth", least=2.0)(
    _in_turn(2, 0.0, 0.237)
)
log("two devices in turn: one was switched on an hour before", least=2.0)(_in_turn(2, 0.0, 3600.0))
log("three devices in turn", least=2.0)(_in_turn(3, 0.002))
log("two devices: ten rows of one, ten of the other, at the same times", least=2.0)(
    _in_turn(2, 0.0, block=10)
)


@log("dates of whole seconds: a hundred rows share each")
def whole_seconds(folder: Path, world: World) -> Path:
    said = _dates(world.t_s, "%Y-%m-%dT%H:%M:%SZ")
    return text(folder / "in.csv", _with_time("datetime", said, world))


@log("times of the day of whole seconds, begun within one, over midnight")
def whole_seconds_of_day(folder: Path, world: World) -> Path:
    said = _dates(world.t_s + 0.63, "%H:%M:%S")
    return text(folder / "in.csv", _with_time("time", said, world))


def _seconds(kept: Callable[[np.ndarray], np.ndarray]) -> Writer:
    """Dates of whole seconds beside some of the rows."""

    def write(folder: Path, world: World) -> Path:
        said = _dates(world.t_s, "%Y-%m-%d %H:%M:%S")
        return text(folder / "in.csv", _with_time("datetime", said, world)[kept(world.t_s)])

    return write


log("dates of whole seconds, and a pause of five", least=0.8)(
    _seconds(lambda t_s: (t_s < 5) | (t_s >= 10))
)
log("dates of whole seconds, some of whose rows are lost")(
    _seconds(lambda t_s: np.random.default_rng(4).random(len(t_s)) > 0.3)
)


@log("two samples in every tick of 20 ms")
def coarse_ticks(folder: Path, world: World) -> Path:
    said = 20 * np.floor(world.t_s / 0.02 + 1e-9).astype(int)
    return text(folder / "in.csv", _with_time("t_ms", said, world))


def _with_hole(names: list[str], last: int | None = 1500, fill: bool = False) -> Writer:
    """No number in some columns from row 800 on."""

    def write(folder: Path, world: World) -> Path:
        frame = _plain(world)
        frame.iloc[800:last, [*map(frame.columns.get_loc, names)]] = np.nan
        return text(folder / "in.csv", frame.interpolate() if fill else frame)

    return write


log("no rates for seven seconds", least=0.7, most=0.77)(_with_hole(_SIX[:3]))
log("nothing but times for seven seconds", least=0.7, most=0.77)(_with_hole([*_SIX, "temp_c"]))
log("no acceleration for seven seconds", least=0.7, most=0.84)(_with_hole(_SIX[3:]))
log("no temperature for seven seconds", least=0.7, most=0.84)(_with_hole(["temp_c"]))
log("no temperature after eight seconds", least=0.25, most=0.34)(_with_hole(["temp_c"], None))


@log("the last column is missing half way through", least=0.48, most=0.55)
def last_column_gone(folder: Path, world: World) -> Path:
    frame = _plain(world)
    first = text(folder / "in.csv", frame[:1500]).read_text()
    return text(folder / "in.csv", frame[1500:].drop(columns="temp_c"), first, header=False)


def _other_unit(names: list[str], times: float) -> Writer:
    """Another unit from a row at rest on."""

    def write(folder: Path, world: World) -> Path:
        frame = _plain(world)
        frame.loc[1350:, names] *= times
        return text(folder / "in.csv", frame)

    return write


log("deg/s become mdps on the way, at rest", least=0.43)(_other_unit(_SIX[:3], 1000))
log("deg/s become rad/s on the way, at rest", least=0.43)(_other_unit(_SIX[:3], np.radians(1)))
log("g become m/s2 on the way, at rest", least=0.43)(_other_unit(_SIX[3:], STANDARD_GRAVITY))


@log("units in a comment above the names")
def units_above(folder: Path, world: World) -> Path:
    before = "# s, rad/s, rad/s, rad/s, m/s2, m/s2, m/s2\n"
    frame = table("t,gx,gy,gz,ax,ay,az", world.t_s, world.rad, world.mps2)
    return text(folder / "in.csv", frame, before)


@log("units in a comment beneath the names")
def units_beneath(folder: Path, world: World) -> Path:
    head = "t,gx,gy,gz,ax,ay,az\n# s,rad/s,rad/s,rad/s,m/s^2,m/s^2,m/s^2\n"
    frame = table("t,gx,gy,gz,ax,ay,az", world.t_s, world.rad, world.mps2)
    return text(folder / "in.csv", frame, head, header=False)


@log("CRLF and the mark of UTF-8")
def crlf_and_mark(folder: Path, world: World) -> Path:
    path = text(folder / "in.csv", _plain(world), lineterminator="\r\n")
    path.write_bytes(b"\xef\xbb\xbf" + path.read_bytes())
    return path


@log("decimal commas within quotes, commas between")
def quoted_commas(folder: Path, world: World) -> Path:
    frame = _plain(world).map(lambda value: f"{value:.6f}".replace(".", ","))
    return text(folder / "in.csv", frame)


@log("times with a decimal comma within quotes")
def quoted_times(folder: Path, world: World) -> Path:
    said = [f"{t:.3f}".replace(".", ",") for t in world.t_s]
    return text(folder / "in.csv", _with_time("time_s", said, world))


@log("times of the day with a comma before the milliseconds, within quotes")
def quoted_clock(folder: Path, world: World) -> Path:
    said = _dates(world.t_s, "%H:%M:%S,%f", 3)
    return text(folder / "in.csv", _with_time("time", said, world))


def _on_lines(hz: float) -> Writer:
    """The log on an even grid, as pandas' resample and interpolate make it."""

    def write(folder: Path, world: World) -> Path:
        at = np.arange(0.0, world.t_s[-1], 1.0 / hz)
        columns = {n: np.interp(at, world.t_s, values) for n, values in _plain(world).items()}
        return text(folder / "in.csv", pd.DataFrame(columns))

    return write


log("resampled from 100 to 400 Hz, on lines between the samples")(_on_lines(400.0))
log("resampled from 100 to 333 Hz, on lines between the samples")(_on_lines(333.0))
log("seven seconds filled with a line", least=0.7, most=0.77)(
    _with_hole([*_SIX, "temp_c"], fill=True)
)


@log("OpenCamera Sensors: three rates and nanoseconds, no names")
def rates_before_times(folder: Path, world: World) -> Path:
    at_ns = (1e14 + world.t_s * 1e9).astype(np.int64)
    frame = table("gx,gy,gz,t", world.rad, at_ns)
    return text(folder / "VID_1gyro.csv", frame, header=False)


@log("a fibre gyroscope's deg/h")
def per_hour(folder: Path, world: World) -> Path:
    names = ["time [s]", "wx [deg/hr]", "wy [deg/hr]", "wz [deg/hr]"]
    return text(folder / "in.csv", table(names, world.t_s, 3600 * world.dps))
