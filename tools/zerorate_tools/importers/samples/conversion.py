"""From physical units to integers, piece by piece, every loss counted."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from zerorate_i2c.parts import PARTS

from ...errors import BadRecording
from ...recordings import Scales
from ...recordings.checks import GAP
from ...recordings.recording import ACCEL, COLUMNS, GYRO, TEMP, Columns
from ...recordings.scales import EXAMPLE
from ..columns.guesses import gravity_unit
from ..columns.mapping import map_words
from ..columns.names import accel_groups, bare_axes, other_temperatures
from ..columns.plan import Plan, divided_by, named_alike, take_both
from ..columns.units import kind_of
from ..report import Options, Report
from ..tables.delimited import delimited
from ..tables.table import Table
from .between import SAID, Bridged
from .clock import Gaps
from .doubts import of_time
from .gather import Gathered
from .spool import PLACE, TIME

_GYRO_RANGES = (131.0, 65.5, 32.8, 16.4)
_ACCEL_RANGES = (16384.0, 8192.0, 4096.0, 2048.0)
_FINE = (1000.0, 500.0, 200.0)
_TEMP_LSB, _TEMP_OFFSET = 100.0, 0.0
#: Different readings that tell a part's scale, and what their printed digits may take from it.
_DISTINCT, _OFF_GRID = 4, 0.05
_RAIL = 32767
_SCALES_OF = {
    "gyro": ("gyro_lsb_per_dps",),
    "accel": ("accel_lsb_per_g",),
    "temp": ("temp_lsb_per_degc", "temp_offset_degc"),
}
#: 16 bits hold 15 dps, the least range that is made, and gravity.
_WIDEST = {"gyro": 32768 / 15.0, "accel": 32768.0}
#: Rows that come more slowly are means over the time between them: no such sensor is that slow.
MEANS_FROM_US = 1.5e6
_LOOKED_AT = 64


def without_wide_counts(plan: Plan, options: Options) -> Options:
    """Options without the scales of counts that no 16 bits hold; the plan divides by them."""
    for kind, (key, *_) in _SCALES_OF.items():
        lsb, most = getattr(options, key), _WIDEST.get(kind)
        if kind in plan.raw and lsb and most and lsb > most:
            divided_by(plan, kind, lsb)
            options = replace(options, **{key: None})  # type: ignore[arg-type]
    return options


class Common:
    """What several sources of one device have in common: one scale holds the readings of all."""

    def __init__(self, found: list[Gathered]) -> None:
        kinds = ("gyro", "accel")
        self.largest = {k: max((one.largest[k] for one in found), default=0.0) for k in kinds}
        seen = [one.looked_at[TEMP] for one in found if TEMP in one.looked_at]
        self.temps = np.concatenate([np.empty(0), *seen])


def fitting_scales(
    found: Gathered,
    common: Common,
    plan: Plan,
    table: Table,
    options: Options,
    path: Path,
    notes: list[str],
) -> Scales:
    """What is given, else what holds every reading. Raises BadRecording."""
    keys = [key for kind, of in _SCALES_OF.items() if kind in plan.raw for key in of]
    if keys := [key for key in keys if getattr(options, key) is None]:
        words = " ".join(f"--{key.replace('_', '-')} {EXAMPLE[key]}" for key in keys)
        do = f"give {words} (an MPU-6050's at +-250 dps and +-2 g; put your sensor's)"
        raise BadRecording(path, "the scale of raw counts is not known", do=do)
    means = found.interval_us >= MEANS_FROM_US and "gyro" not in plan.raw
    gyro = options.gyro_lsb_per_dps
    if gyro is None:
        ranges = (*(_FINE if means else ()), *_GYRO_RANGES)
        gyro = _fitting("gyro", "dps", ranges, common, notes)
    accel = temp = offset = None
    if "ax" in plan.wanted:
        accel = options.accel_lsb_per_g
        if accel is None:
            accel = _fitting("accel", "g", _ACCEL_RANGES, common, notes)
    if TEMP in plan.wanted:
        temp, offset = options.temp_lsb_per_degc, options.temp_offset_degc
        if temp is None and offset is None:
            temp, offset = _temperature_scale(common, notes)
        temp = _TEMP_LSB if temp is None else temp
        offset = _TEMP_OFFSET if offset is None else offset
    more = dict(options.more)
    if means:
        seconds = float(f"{found.interval_us * 1e-6:.4g}")
        more["row_is_mean_of_s"] = seconds
        notes.append(f"a row every {seconds:g} s: each taken as the mean over that time")
    return Scales(
        sensor=options.sensor or table.sensor or "unknown",
        odr_hz=options.hz or float(f"{1e6 / found.interval_us:.6g}"),
        gyro_lsb_per_dps=gyro,
        accel_lsb_per_g=accel,
        temp_lsb_per_degc=temp,
        temp_offset_degc=offset,
        more=more,
    )


def _fitting(
    kind: str, unit: str, ranges: Sequence[float], common: Common, notes: list[str]
) -> float:
    largest = common.largest[kind]
    lsb = next((lsb for lsb in ranges if largest * lsb < _RAIL - 0.5), ranges[-1])
    ends = round(32768 / lsb, -1 if kind == "gyro" else 0)
    fastest = "fastest rate" if kind == "gyro" else "strongest acceleration"
    notes.append(f"Stored at the +-{ends:g} {unit} scale ({fastest}: {largest:.4g} {unit})")
    return lsb


def _temperature_scale(common: Common, notes: list[str]) -> tuple[float, float]:
    """The scale of the part whose integers the readings are, so that these come back exactly."""
    seen = np.unique(common.temps)
    seen = seen[np.isfinite(seen)]
    for _, part, lsb, offset, *_ in PARTS if len(seen) >= _DISTINCT else ():
        counts = (seen - offset) * lsb
        if (np.abs(counts - np.rint(counts)) < _OFF_GRID).all():
            notes.append(f"temperature in steps of 1/{lsb:g} degC, as a {part} counts")
            return lsb, offset
    return _TEMP_LSB, _TEMP_OFFSET


def integer_batches(
    found: Gathered, plan: Plan, scales: Scales, path: Path, report: Report
) -> Iterator[dict[str, np.ndarray]]:
    """Batches as a recording has them, in its order of columns; completes the report."""
    bridged, gaps = Bridged(found.spool), Gaps(found.interval_us)
    names = [name for name in (*COLUMNS, *plan.wanted) if name in found.spool.names]
    temps: list[np.ndarray] = []
    first = last = None
    for columns in bridged:
        t_us = np.rint(columns[TIME]).astype(np.int64)
        if not len(t_us):
            continue
        first, last = t_us[0] if first is None else first, t_us[-1]
        gaps.add(columns[TIME])
        if TEMP in columns and "temp" not in plan.raw:
            # a view would keep the whole column
            temps.append(columns[TEMP][:: 1 + len(t_us) // _LOOKED_AT].copy())
        yield {
            name: t_us if name == TIME else _integers(name, columns, plan, scales, path, report)
            for name in dict.fromkeys(names)
        }
        report.rows_written += len(t_us)
    if first is None:
        problem, do = "no sample is left", "map the acceleration of this sensor, or none: ax=none"
        raise BadRecording(path, problem, do=do)
    for name, count in bridged.dropped.items():
        if count:
            report.dropped[f"in a gap of the {SAID[name]}; without it: --map {name}=none"] += count
    report.duration_s = float(last - first) * 1e-6
    report.odr_hz = scales.odr_hz
    report.notes += [*gaps.note(), *bridged.notes()]
    if temps:
        report.doubts += of_time(np.concatenate(temps), float(last - first), found.counted)


def _integers(
    name: str, columns: Columns, plan: Plan, scales: Scales, path: Path, report: Report
) -> np.ndarray:
    values = columns[name]
    if name not in COLUMNS:
        return _channel(name, values, columns[PLACE], path)
    raw = kind_of(name) in plan.raw
    if name == TEMP and not raw:
        values = (values - (scales.temp_offset_degc or 0.0)) * (scales.temp_lsb_per_degc or 1.0)
    elif not raw:
        lsb = scales.gyro_lsb_per_dps if name in GYRO else scales.accel_lsb_per_g
        values = values * (lsb or 1.0)
    counts = np.rint(values)
    at_end = int((np.abs(counts) >= _RAIL).sum())
    if at_end:
        report.clipped[name] += at_end
    return np.clip(counts, -_RAIL - 1, _RAIL).astype(np.int32)


def _channel(name: str, values: np.ndarray, place: np.ndarray, path: Path) -> np.ndarray:
    bad = np.abs(values) >= 2**31
    if bad.any():
        at = int(np.argmax(bad))
        do = f"scale it down: --map {name}=COLUMN:x0.001"
        problem = f"{name} is {values[at]:g}, no integer of 32 bits"
        raise BadRecording(path, problem, row=int(place[at]) + 1, do=do)
    return np.where(np.isnan(values), GAP, np.rint(values)).astype(np.int32)


def _has_gravity(path: Path) -> bool:
    """Whether a file's acceleration is as long as gravity: some programs take gravity away."""
    try:
        table = delimited(path)
    except BadRecording:
        return False
    axes, *_ = [*accel_groups(table.names), bare_axes(table.names)]
    first = table.first_rows(list(axes.values())) if axes else {}
    return bool(first) and gravity_unit(list(first.values())) is not None


def absent(plan: Plan, names: list[str], path: Path) -> list[str]:
    """What cannot be learned without the columns that are not there. names: of all columns."""
    out = []
    if ACCEL[0] not in plan.wanted:
        in_gyro = path.is_file() and "gyro" in path.stem.lower()
        found = path.parent.glob("*[Aa]ccel*.csv") if in_gyro else ()
        beside = named_alike(path, filter(_has_gravity, found))
        take = f"; {beside.name} is beside it: {take_both(path, beside)}" if beside else ""
        out.append(f"no acceleration: nothing can be learned against gravity{take}")
    if TEMP not in plan.wanted:
        other = other_temperatures([name for name in names if name not in plan.columns])
        is_near = "it is" if len(other) == 1 else "one of them is"
        words = map_words(TEMP, other[0]) if other else ""
        offer = f"; if {is_near} the sensor's or near it: {words}" if other else ""
        listed = f" by its name, but {', '.join(other)}" if other else ""
        out.append(f"no temperature{listed}: the bias cannot be followed over temperature{offer}")
    return out
