"""Which column of a foreign table is which of a recording, and in what unit."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..errors import BadRecording
from ..recordings.recording import ACCEL, COLUMNS, GYRO, TEMP, TIME
from .foreign import Foreign
from .units import ACCEL_G, RATE_DPS, RAW, TEMP_DEGC, TIME_S, unit_in_name, units_of

Table = Mapping[str, np.ndarray]

_USUAL = {
    TIME: ("t_us", "t_s", "t_ms", "time", "timestamp", "time_s", "time_ms", "time_us", "t", "now"),
    **{
        f"g{a}": (f"g{a}", f"gyro_{a}", f"gyr_{a}", f"gyro{a}", f"w{a}", f"omega_{a}")
        for a in "xyz"
    },
    **{f"a{a}": (f"a{a}", f"acc_{a}", f"accel_{a}", f"acc{a}", f"accel{a}") for a in "xyz"},
    TEMP: ("temp", "temperature", "gtemp", "temp_c", "die_temp"),
}


@dataclass(frozen=True)
class Mapped:
    """One column of the recording: where it comes from, and its unit or factor (None: by name)."""

    target: str
    column: str
    unit: str | None = None


def parsed_mapping(text: str) -> Mapped:
    """`gx=gyro_x:rad/s` or, for an extra channel, `vdd_mv=volt:x1000`. Raises ValueError."""
    target, equals, rest = text.partition("=")
    if not equals or not target or not rest:
        raise ValueError(f"{text!r} is no mapping: write gx=COLUMN:UNIT")
    column, _, unit = rest.rpartition(":") if ":" in rest else (rest, "", "")
    mapped = Mapped(target.strip(), column, unit.lower() or None)
    _check_unit(mapped)
    return mapped


def _check_unit(mapped: Mapped) -> None:
    if mapped.unit is None:
        return
    if mapped.target in COLUMNS:
        known = units_of(mapped.target)
        if mapped.unit not in known:
            raise ValueError(
                f"unit {mapped.unit!r} of {mapped.target} is none of {', '.join(known)}"
            )
    elif not _factor(mapped.unit):
        raise ValueError(
            f"{mapped.target} is none of {', '.join(COLUMNS)}, and an extra channel takes a "
            f"factor: {mapped.target}={mapped.column}:x100"
        )


def _factor(unit: str) -> float | None:
    try:
        return float(unit.removeprefix("x")) or None
    except ValueError:
        return None


def foreign_from_table(
    table: Table, mapping: Sequence[Mapped], path: Path, units: Mapping[str, str] | None = None
) -> Foreign:
    """Apply a mapping; columns not mapped are found by their usual names.

    units: unit of a kind (time, gyro, accel, temp) where neither mapping nor name says one.
    Raises BadRecording for a column that is not there, or a unit that nobody named.
    """
    wanted = {mapped.target: mapped for mapped in mapping}
    for target, names in _USUAL.items():
        found = None if target in wanted else _usual(table, names)
        if found is not None:
            wanted[target] = Mapped(target, found)
    for mapped in wanted.values():
        if mapped.column not in table:
            do = f"choose of {', '.join(table)}"
            raise BadRecording(path, f"there is no column {mapped.column!r}", do=do)
    missing = [target for target in GYRO if target not in wanted]
    if missing:
        do = f"map it: --map {missing[0]}=COLUMN:dps, COLUMN one of {', '.join(table)}"
        raise BadRecording(path, f"no column for {', '.join(missing)}", do=do)
    return _foreign(table, wanted, path, units or {})


def _foreign(table: Table, wanted: dict[str, Mapped], path: Path, units: Mapping[str, str]):
    raw = ""

    def column(target: str, kind: str, factors: Mapping) -> np.ndarray:
        nonlocal raw
        unit = _unit(wanted[target], kind, units, path)
        if unit == RAW:
            raw += kind[0]
            return table[wanted[target].column]
        factor = factors[unit]
        scale, offset = factor if isinstance(factor, tuple) else (factor, 0.0)
        return table[wanted[target].column] * scale + offset

    gyro = np.stack([column(target, "gyro", RATE_DPS) for target in GYRO], axis=1)
    accel = temp = time_s = None
    if all(target in wanted for target in ACCEL):
        accel = np.stack([column(target, "accel", ACCEL_G) for target in ACCEL], axis=1)
    if TEMP in wanted:
        temp = column(TEMP, "temp", TEMP_DEGC)
    if TIME in wanted:
        time_s = column(TIME, "time", TIME_S)
    extra = {
        target: table[mapped.column] * (_factor(mapped.unit or "1") or 1.0)
        for target, mapped in wanted.items()
        if target not in COLUMNS
    }
    return Foreign(gyro=gyro, time_s=time_s, accel=accel, temp=temp, extra=extra, raw=raw)


def _usual(table: Table, names: Sequence[str]) -> str | None:
    for column in table:
        plain = column.strip().lower().partition("[")[0].strip()
        unitless = plain.rpartition("_")[0]
        if plain in names or unitless in names:
            return column
    return None


def _unit(mapped: Mapped, kind: str, units: Mapping[str, str], path: Path) -> str:
    unit = mapped.unit or unit_in_name(mapped.target, mapped.column) or units.get(kind)
    if unit not in units_of(mapped.target):
        known = ", ".join(units_of(mapped.target))
        do = f"write --map {mapped.target}={mapped.column}:UNIT with one of {known}"
        what = "is not known" if unit is None else f"cannot be {unit!r}"
        raise BadRecording(path, f"the unit of column {mapped.column!r} {what}", do=do)
    return unit
