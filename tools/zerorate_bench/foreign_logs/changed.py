"""Logs that change on the way, hold two devices, or have holes."""

from pathlib import Path

import numpy as np
import pandas as pd

from .clocks import _START, _plain, _stamps, _with_time
from .world import World, log, table, text

_DEVICES = 3
_SIX = ["gx_dps", "gy_dps", "gz_dps", "ax_g", "ay_g", "az_g"]


def _in_turn(world: World, devices: int, late_s: float, apart_s: float = 0.0) -> pd.DataFrame:
    """Rows of several devices, each with its own bias and mounting, without a word of whose."""
    rng = np.random.default_rng(3)
    frame = _plain(world)
    one = []
    for number in range(devices):
        other = World(world.samples, world.hz, world.seed + 10 * number)
        mounted = np.roll(other.g, number, axis=1)
        at = world.t_s + number * late_s + (number > 0) * apart_s
        rates = other.dps + number * rng.uniform(-1, 1, 3)
        part = table("t_s,temp_c,order", at, world.degc + number, np.arange(world.samples))
        part[_SIX] = np.column_stack([rates, mounted])
        one.append(part.assign(device=number))
    both = pd.concat(one).sort_values(["order", "device"])
    return both[frame.columns]


@log("two devices in turn, without a word of whose: at the same times", least=2.0)
def two_at_one_time(folder: Path, world: World) -> Path:
    return text(folder / "in.csv", _in_turn(world, 2, 0.0))


@log("two devices in turn: half a period apart", least=2.0)
def two_evenly(folder: Path, world: World) -> Path:
    return text(folder / "in.csv", _in_turn(world, 2, 0.005))


@log("two devices in turn: each has its own clock, so times go back and forth", least=2.0)
def two_clocks(folder: Path, world: World) -> Path:
    return text(folder / "in.csv", _in_turn(world, 2, 0.0, 0.237))


@log("two devices in turn: one was switched on an hour before", least=2.0)
def two_power_ons(folder: Path, world: World) -> Path:
    return text(folder / "in.csv", _in_turn(world, 2, 0.0, 3600.0))


@log("three devices in turn", least=2.0)
def three_devices(folder: Path, world: World) -> Path:
    return text(folder / "in.csv", _in_turn(world, _DEVICES, 0.002))


@log("two devices: ten rows of one, ten of the other, at the same times", least=2.0)
def two_in_blocks(folder: Path, world: World) -> Path:
    frame = _in_turn(world, 2, 0.0)
    number = np.arange(len(frame))
    order = np.lexsort((number // 2, number % 2, number // 20))
    return text(folder / "in.csv", frame.iloc[order])


@log("dates of whole seconds: a hundred rows share each")
def whole_seconds(folder: Path, world: World) -> Path:
    said = _stamps(world).strftime("%Y-%m-%dT%H:%M:%SZ")
    return text(folder / "in.csv", _with_time("datetime", said, world))


@log("times of the day of whole seconds, begun within one, over midnight")
def whole_seconds_of_day(folder: Path, world: World) -> Path:
    said = (_stamps(world) + pd.Timedelta("0.63s")).strftime("%H:%M:%S")
    return text(folder / "in.csv", _with_time("time", said, world))


@log("dates of whole seconds, and a pause of five", least=0.8)
def whole_seconds_paused(folder: Path, world: World) -> Path:
    said = _stamps(world).strftime("%Y-%m-%d %H:%M:%S")
    at = world.t_s
    return text(folder / "in.csv", _with_time("datetime", said, world)[(at < 5) | (at >= 10)])


@log("dates of whole seconds, some of whose rows are lost")
def whole_seconds_lost(folder: Path, world: World) -> Path:
    said = _stamps(world).strftime("%Y-%m-%d %H:%M:%S")
    kept = np.random.default_rng(4).random(world.samples) > 0.3
    return text(folder / "in.csv", _with_time("datetime", said, world)[kept])


@log("two samples in every tick of 20 ms")
def coarse_ticks(folder: Path, world: World) -> Path:
    at_ms = 20 * np.floor(world.t_s / 0.02 + 1e-9).astype(int)
    return text(folder / "in.csv", _with_time("t_ms", at_ms, world))


def _with_hole(folder: Path, world: World, names: list[str], last: int = 1500) -> Path:
    frame = _plain(world)
    frame.loc[800 : last - 1, names] = np.nan
    return text(folder / "in.csv", frame)


@log("no rates for seven seconds", least=0.7, most=0.77)
def hole_of_rates(folder: Path, world: World) -> Path:
    return _with_hole(folder, world, ["gx_dps", "gy_dps", "gz_dps"])


@log("nothing but times for seven seconds", least=0.7, most=0.77)
def hole_of_all(folder: Path, world: World) -> Path:
    return _with_hole(folder, world, [*_SIX, "temp_c"])


@log("no acceleration for seven seconds", least=0.7, most=0.84)
def hole_of_forces(folder: Path, world: World) -> Path:
    return _with_hole(folder, world, ["ax_g", "ay_g", "az_g"])


@log("no temperature for seven seconds", least=0.7, most=0.84)
def hole_of_temperature(folder: Path, world: World) -> Path:
    return _with_hole(folder, world, ["temp_c"])


@log("no temperature after eight seconds", least=0.25, most=0.34)
def no_more_temperature(folder: Path, world: World) -> Path:
    return _with_hole(folder, world, ["temp_c"], world.samples)


@log("the last column is missing half way through", least=0.48, most=0.55)
def last_column_gone(folder: Path, world: World) -> Path:
    frame = _plain(world)
    first = text(folder / "in.csv", frame[:1500]).read_text()
    return text(folder / "in.csv", frame[1500:].drop(columns="temp_c"), first, header=False)


@log("deg/s become mdps on the way, at rest", least=0.43)
def other_unit(folder: Path, world: World) -> Path:
    frame = _plain(world)
    frame.loc[1350:, _SIX[:3]] *= 1000
    return text(folder / "in.csv", frame)


@log("deg/s become rad/s on the way, at rest", least=0.43)
def other_unit_smaller(folder: Path, world: World) -> Path:
    frame = _plain(world)
    frame.loc[1350:, _SIX[:3]] = np.radians(frame.loc[1350:, _SIX[:3]])
    return text(folder / "in.csv", frame)


@log("g become m/s2 on the way, at rest", least=0.43)
def other_unit_of_force(folder: Path, world: World) -> Path:
    frame = _plain(world)
    frame.loc[1350:, _SIX[3:]] *= 9.80665
    return text(folder / "in.csv", frame)


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
    said = (_START + pd.to_timedelta(world.t_s, unit="s")).strftime("%H:%M:%S,%f").str[:-3]
    return text(folder / "in.csv", _with_time("time", said, world))


def _on_lines(folder: Path, world: World, hz: float) -> Path:
    """The log on an even grid, as pandas' resample and interpolate make it."""
    frame = _plain(world)
    at = np.arange(0.0, world.t_s[-1], 1.0 / hz)
    columns = {name: np.interp(at, world.t_s, values) for name, values in frame.items()}
    return text(folder / "in.csv", pd.DataFrame(columns))


@log("resampled from 100 to 400 Hz, on lines between the samples")
def upsampled(folder: Path, world: World) -> Path:
    return _on_lines(folder, world, 400.0)


@log("resampled from 100 to 333 Hz, on lines between the samples")
def resampled(folder: Path, world: World) -> Path:
    return _on_lines(folder, world, 333.0)


@log("seven seconds filled with a line", least=0.7, most=0.77)
def filled(folder: Path, world: World) -> Path:
    path = _with_hole(folder, world, [*_SIX, "temp_c"])
    return text(path, pd.read_csv(path).interpolate())


@log("OpenCamera Sensors: three rates and nanoseconds, no names")
def rates_before_times(folder: Path, world: World) -> Path:
    at_ns = (1e14 + world.t_s * 1e9).astype(np.int64)
    frame = table("gx,gy,gz,t", world.rad, at_ns)
    return text(folder / "VID_1gyro.csv", frame, header=False)


@log("a fibre gyroscope's deg/h")
def per_hour(folder: Path, world: World) -> Path:
    names = ["time [s]", "wx [deg/hr]", "wy [deg/hr]", "wz [deg/hr]"]
    return text(folder / "in.csv", table(names, world.t_s, 3600 * world.dps))
