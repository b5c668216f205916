"""What cannot be true of a recording is refused; what hardly can is said. Each with a cure."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from ...errors import BadRecording
from ...numbers import counted, duration
from ...recordings import Scales, turning
from ...recordings.recording import ACCEL, COLUMNS, GYRO, TEMP, TIME, Columns
from ..columns import guesses
from ..columns.mapping import map_words
from ..columns.plan import Plan
from ..tables.table import Table
from .gather import FELT, HELD, Gathered

_GRAVITY_WITHIN = 0.2
#: A sensor's scale may be off by so much, and a speed that was gained adds little over so long.
_LEAST_G, _MOST_G, _GRAVITY_FROM_US = 0.8, 1.25, 2e6
#: The middle half of forces that do not change is within so much of each other.
_STEADY_G = 0.1
_RANGES_LSB = (16384, 8192, 4096, 2048, 1024)
#: Whoever records faster has no such sensor.
_FASTEST_HZ = 40_000.0
#: Nothing with mass warms or cools faster than that.
_FASTEST_DEGC_S, _LEAST_DEGC = 1.0, 3.0
#: White noise that no such sensor is below, and none above, dps per square root of Hz.
_QUIETEST, _LOUDEST = 2e-4, 0.1
#: Rows that are rarer may each be a single reading, with all noise up to there, Hz.
_SINGLE_HZ = 10.0
#: Of one sample to the next, where nothing shakes.
_UNSHAKEN_G = 0.02
#: At rest the rates spread by their noise, moved by a multiple of it.
_STILL = 3.0
#: A damaged line was a sample, and took its time; so many are lines of another kind.
_LOST = 0.05
#: Noise of one step leaves all three at zero in a twentieth of the rows, if there is no bias.
_HIDDEN = 0.2
#: So much of a column goes on by one a row if it counts them.
_COUNTS = 0.5
#: A tenth of what a channel does may be lost by rounding.
_MOST_ROUNDED = 0.1
#: (3, n) rates in dps, (3, n) force and (n,) seconds; NaN in rows of the other.
_Turns = tuple[np.ndarray, np.ndarray, np.ndarray]


def doubts(found: Gathered, plan: Plan, table: Table, scales: Scales, path: Path) -> list[str]:
    """Sentences, of which each names what to do; a rate that nothing confirms is a note of `found`.
    Raises BadRecording for what cannot be true."""
    _refuse_gravity(found.looked_at, plan, scales, path)
    _refuse_pace(found, plan, path)
    _refuse_coarse_channels(found.looked_at, plan, path)
    turns = _turns(found.looked_at, plan, scales)
    of_units = None if plan.by_format else turns
    times = turning.dps_of_one(*of_units) if of_units else None
    if times is None:
        out = _of_rates(found, plan, path)
        out = out or (_of_standing(of_units, plan, path) if of_units else [])
        out += _of_axes(turns, plan) if turns else []
    else:
        out = _of_turning(times, found.counted, plan, scales, path)
    out += _of_hidden_bias(found.looked_at) + _of_temperature(found.looked_at, plan)
    lost = sum(found.dropped.values()) - found.dropped[HELD]
    if found.counted and lost > _LOST * found.rows:
        out.append(
            f"{lost} of {found.rows} rows are dropped, and --hz counts them as time: "
            "take out of the file what are no samples"
        )
    if found.counted:
        out += _of_counters(table, plan, found.interval_us)
        if times is None:
            hz = 1e6 / found.interval_us
            found.notes.append(
                f"{hz:.4g} samples a second, as --hz says: nothing in the log confirms it"
            )
    return [f"doubtful: {words}" for words in out]


def _of_counters(table: Table, plan: Plan, interval_us: float) -> list[str]:
    """A column that counts the rows and, among the first ones, jumps: --hz does not count what was
    lost there."""
    aside = [name for name in table.names if name and name not in plan.columns]
    if not aside:
        return []
    with table.looked_at() as chunks:
        first = next(iter(chunks(aside)))
    for name, values in first.columns.items():
        ahead = np.diff(values - first.place)
        lost = int(ahead[ahead > 0].sum())
        if lost and np.sum(ahead == 0) > _COUNTS * len(ahead):
            do = map_words(TIME, name, f"x{interval_us:.9g}")
            return [f"{name!r} skips {counted(lost, 'sample')}: give {do} and not --hz"]
    return []


def of_time(temp_degc: np.ndarray, span_us: float, counted: bool) -> list[str]:
    """Whether so much warming or cooling fits into the time that passed.

    temp_degc: readings over the whole recording. counted: the time comes from --hz.
    """
    if len(temp_degc) < 8:
        return []
    least, most = np.quantile(temp_degc, [0.02, 0.98])
    changed, span_s = float(most - least), span_us * 1e-6
    if changed < _LEAST_DEGC or changed < _FASTEST_DEGC_S * span_s:
        return []
    do = "give the true --hz" if counted else "give --hz, rows a second, instead of the time column"
    return [
        f"doubtful: {changed:.3g} degC within {duration(span_s)} cannot be: the time stamps are "
        f"wrong; {do}"
    ]


def _refuse_gravity(seen: dict[str, np.ndarray], plan: Plan, scales: Scales, path: Path) -> None:
    """Who ends not much faster than he began was pushed by 1 g on the average, however he moved:
    the usual length of the force is no less, and where it never changes no more. A limb that swings
    is pushed along itself by some g, too, but by no other unit's."""
    if "ax" not in seen or np.ptp(seen["t_us"]) < _GRAVITY_FROM_US:
        return
    lsb = scales.accel_lsb_per_g or 1.0
    pushes = np.array([seen[name] for name in ACCEL]) / (lsb if "accel" in plan.raw else 1.0)
    pushes = pushes[:, np.isfinite(pushes).all(axis=0)]
    force = np.linalg.norm(pushes, axis=0)
    usual = float(np.median(force)) if len(force) else 1.0
    low, high = np.quantile(force, [0.25, 0.75]) if len(force) else (1.0, 1.0)
    off = usual < _LEAST_G or usual > _MOST_G and high - low < _STEADY_G * usual
    if not off and "accel" not in plan.raw:
        # what shakes it averages out
        eighths = np.array_split(pushes, 8, axis=1) if pushes.shape[1] >= 8 else []
        usual = float(np.median([*map(np.linalg.norm, (p.mean(axis=1) for p in eighths))] or 1.0))
        off = usual > _MOST_G and bool(_meant(usual, plan, lsb))
    if not off:
        return
    problem = f"the usual acceleration is {usual:.3g} g, and gravity alone is 1 g"
    do = f"{_meant(usual, plan, lsb)}map other columns, or leave it out by"
    raise BadRecording(path, problem, do=f"{do} --map ax=none")


def _meant(usual_g: float, plan: Plan, lsb: float) -> str:
    """Ready words for a unit or scale in which it would be gravity, where one is known."""
    if "accel" in plan.raw:
        near = [r for r in _RANGES_LSB if abs(usual_g * lsb / r - 1.0) < _GRAVITY_WITHIN]
        return f"give --accel-lsb-per-g {near[0]}; else " if near else ""
    for unit, size in guesses.GRAVITY.items():
        for ratio, meant in ((size, unit), (1 / size, "g")):
            if abs(usual_g / ratio - 1.0) < _GRAVITY_WITHIN:
                words = guesses.unit_words(plan.wanted, "ax", meant)
                return f"did you mean {meant}? Give {words}; else "
    return ""


def _refuse_pace(found: Gathered, plan: Plan, path: Path) -> None:
    hz = 1e6 / found.interval_us
    if hz > _FASTEST_HZ and not found.counted:
        step = found.interval_us * 1e-6 / plan.factors[TIME][0]
        likely = next(iter(guesses.likely_units_of_time(step).items()), None)
        problem = f"{hz:.3g} samples a second are more than such a sensor has"
        do = "give the true --hz"
        if likely:
            words = map_words(TIME, plan.wanted[TIME].column, likely[0])
            do = f"did you mean {likely[0]} ({likely[1]:.4g} Hz)? Give {words}"
        raise BadRecording(path, problem, do=do)


def _refuse_coarse_channels(seen: dict[str, np.ndarray], plan: Plan, path: Path) -> None:
    """A channel is stored in whole numbers."""
    for name, mapped in plan.wanted.items():
        if name in COLUMNS or mapped.unit is not None:
            continue
        values = seen[name][np.isfinite(seen[name])]
        spread = float(np.std(values)) if len(values) else 0.0
        if spread and np.std(values - np.rint(values)) > _MOST_ROUNDED * spread:
            digits = 4 - math.floor(math.log10(float(np.abs(values).max())))
            words = map_words(name, mapped.column, f"x{10.0**digits * plan.factors[name][0]:g}")
            problem = f"{name} loses its digits as a whole number"
            raise BadRecording(path, problem, do=f"keep its digits: {words}")


def _of_rates(found: Gathered, plan: Plan, path: Path) -> list[str]:
    if "gyro" in plan.raw or plan.by_format or found.samples < 200:
        return []
    rates = np.array([found.looked_at[name] for name in GYRO])
    middle = float(np.abs(np.median(rates, axis=1)).max())
    left = np.diff(rates[:, :1000], n=3, axis=1)  # by a turn that is even over four samples
    noise = float(np.median(np.abs(left))) * 1.4826 / math.sqrt(20)
    root_hz = math.sqrt(0.5e6 / found.interval_us)
    factor = plan.factors["gx"][0]
    meant = ""
    low, high = np.quantile(rates, [0.25, 0.75], axis=1)
    if middle > guesses.BIAS_DPS and (high - low).max() < guesses.STEADY * middle:
        said = f"a steady rate of {middle:.3g} dps is no bias of a sound sensor at rest"
        meant = "dps" if factor > 1 else ""
    elif (
        noise > _LOUDEST * max(root_hz, math.sqrt(_SINGLE_HZ / 2))
        and factor > 1
        and np.median(rates[:, :1000].std(axis=1)) < _STILL * noise
        and _unshaken(found.looked_at, plan)
    ):
        said, meant = f"noise of {noise:.2g} dps is more than such a sensor has at rest", "dps"
    elif 0 < noise < _QUIETEST * root_hz and factor <= 1.0 and found.interval_us < 2e5:
        said = f"noise of {noise * 1e3:.2g} mdps is less than such a sensor has"
        meant = "rad/s" if factor == 1.0 else "dps"
    else:
        return []
    if not meant:
        return [said]
    return _of_unit(said, meant, plan, path)


def _of_unit(said: str, meant: str, plan: Plan, path: Path) -> list[str]:
    """The doubt of a unit of rates that the user named; raise BadRecording for any other unit."""
    words = guesses.unit_words(plan.wanted, "gx", meant)
    if "gyro" in plan.typed:
        return [f"{said}: did you mean {meant}? ({words})"]
    do = f"did you mean {meant}? Give {words}; or name the unit as it is, which is believed"
    raise BadRecording(path, said, do=do)


def _turns(seen: Columns, plan: Plan, scales: Scales) -> _Turns | None:
    """None where there is no force."""
    if "ax" not in seen:
        return None
    rates, force = (np.array([seen[name] for name in axes]) for axes in (GYRO, ACCEL))
    rates /= scales.gyro_lsb_per_dps if "gyro" in plan.raw else 1.0
    t_us = seen[TIME]
    if FELT in seen:
        t_us = np.append(t_us, seen[FELT])
        no_rates, no_force = (np.full_like(of, np.nan) for of in (force, rates))
        rates, force = np.hstack([rates, no_rates]), np.hstack([no_force, force])
    return rates, force, t_us * 1e-6


def _of_hidden_bias(seen: Columns) -> list[str]:
    """Rates that are more often zero about all axes at once than noise of a step leaves them."""
    rates = np.array([seen[axis] for axis in GYRO])
    share = float((rates == 0).all(axis=0).mean())
    if share < _HIDDEN:
        return []
    said = f"all three rates are exactly 0 in {100 * share:.0f} % of the rows"
    return [f"{said}, which hides a bias: turn off what zeroes them, or narrow the range"]


def _of_axes(turns: _Turns, plan: Plan) -> list[str]:
    """Rates that turn gravity as it is seen to turn if their axes are taken in another way."""
    axes = turning.axes_of(*turns)
    if axes is None and turning.turns_otherwise(*turns):
        columns = ", ".join(plan.wanted[axis].column for axis in GYRO)
        return [f"gravity turns, but not as {columns} say: are these the rates, at this time?"]
    if axes is None or (axes == np.eye(3)).all():
        return []
    order = turning.axes_words(axes)
    words = [
        map_words(target, ("-" if name.startswith("-") else "") + one.column, one.unit)
        for target, name in zip(GYRO, order.split())
        for one in [plan.wanted[f"g{name[-1]}"]]
    ]
    said = f"gravity turns as if the rates x y z were {order} of the accelerometer's axes"
    return [f"{said}: give {' '.join(words)}, or motion teaches nothing true"]


def _of_turning(
    times: turning.Size, counted: bool, plan: Plan, scales: Scales, path: Path
) -> list[str]:
    if times.least < 1.0 < times.most:
        return []
    said = f"gravity turns {times.dps:.2g} times as fast as the rates"
    time = "--hz" if counted else "the time"
    if "gyro" in plan.raw:
        lsb = scales.gyro_lsb_per_dps / times.dps
        return [f"{said}: did you mean --gyro-lsb-per-dps {lsb:.3g}? Or is {time} wrong"]
    meant = guesses.rate_unit_of(times, plan.factors["gx"][0])
    if meant is None:
        return [f"{said}: is their unit, or {time}, wrong?"]
    return _of_unit(said, meant, plan, path)


def _of_standing(turns: _Turns, plan: Plan, path: Path) -> list[str]:
    """Rates that would turn gravity, which stays where it is."""
    if not turning.turn_too_far(*turns):
        return []
    said = "gravity stays where these rates would turn it"
    if "gyro" in plan.raw:
        return [f"{said}: is --gyro-lsb-per-dps right, and are the axes the accelerometer's?"]
    if plan.factors["gx"][0] > 1:
        return _of_unit(said, "dps", plan, path)
    return [f"{said}: is their unit right, and are the axes the accelerometer's?"]


def _unshaken(seen: dict[str, np.ndarray], plan: Plan) -> bool:
    if "ax" not in seen or "accel" in plan.raw:
        return False
    steps = np.diff([seen[name][:1000] for name in ACCEL], axis=1)
    return bool(np.median(np.abs(steps)) < _UNSHAKEN_G)


def _of_temperature(seen: dict[str, np.ndarray], plan: Plan) -> list[str]:
    if TEMP not in seen or "temp" in plan.raw:
        return []
    temp = seen[TEMP][np.isfinite(seen[TEMP])]
    leave = "or leave it out: --map temp=none"
    if len(temp) and not temp.any():
        return [f"the temperature is 0 throughout, as if nobody measured it: map another, {leave}"]
    if not len(temp) or guesses.DEGC[0] <= np.median(temp) <= guesses.DEGC[1]:
        return []
    unit = guesses.unit_words(plan.wanted, TEMP, "k")
    return [f"the usual temperature is {np.median(temp):.4g} degC: name its unit ({unit}), {leave}"]
