"""`--map gx=gyro_x:rad/s` in words and in Python."""

import math
import shlex
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ...recordings.recording import COLUMNS, TEMP, TIME
from .units import TIME_S, units_of

LEFT_OUT = "none"


@dataclass(frozen=True)
class Mapped:
    """One column of the recording: where it comes from, and its unit or factor (None: by name).

    plus: a further column and its unit to be added, as nanoseconds to seconds. negative: whether
    the readings change their sign.
    """

    target: str
    column: str
    unit: str | None = None
    plus: tuple[str, str] | None = None
    negative: bool = False

    @property
    def is_left_out(self) -> bool:
        """Whether it is said that the recording shall not have this column."""
        return self.column == LEFT_OUT and self.unit is None and self.target in COLUMNS

    def taken(
        self, columns: Mapping[str, np.ndarray], factor: float, offset: float = 0.0
    ) -> np.ndarray:
        """Its readings out of a table's columns: times a factor, and an offset more."""
        readings = columns[self.column] * (-factor if self.negative else factor) + offset
        if self.plus:
            column, unit = self.plus
            readings += columns[column] * TIME_S[unit]
        return readings

    @property
    def columns(self) -> tuple[str, ...]:
        """The columns of the table that it needs."""
        return (self.column, *((self.plus[0],) if self.plus else ()))


def map_words(target: str, column: str, unit: str | None = None) -> str:
    """What to type in a shell for it."""
    return f"--map {shlex.quote(f'{target}={column}' + (f':{unit}' if unit else ''))}"


def parsed_mapping(text: str) -> Mapped:
    """`gx=gyro_x:rad/s`, `gx=gyro_x:x0.1` for tenths of dps, `temp=none`, `t_us=sec:s+nanosec:ns`,
    `t_us=ticks:x30.5` for ticks of so many microseconds or, for an extra channel,
    `vdd_mv=volt:x1000`. Raises ValueError."""
    target, equals, rest = text.partition("=")
    if not equals or not target or not rest:
        raise ValueError(f"{text!r} is no mapping: write gx=COLUMN:UNIT")
    column, unit = _parted(rest)
    plus = None
    if target.strip() == TIME and ":" in column and "+" in column:
        column, _, further = column.rpartition("+")
        plus = (further, unit or "s")
        column, unit = _parted(column)
    mapped = Mapped(target.strip(), column, unit, plus)
    _check_unit(mapped)
    return mapped


def _parted(text: str) -> tuple[str, str | None]:
    column, _, unit = text.rpartition(":") if ":" in text else (text, "", "")
    return column, unit.lower() or None


def _check_unit(mapped: Mapped) -> None:
    for unit in (mapped.unit, mapped.plus and mapped.plus[1]):
        if unit is None:
            continue
        sized = mapped.target != TEMP and not mapped.plus and factor_in(unit)
        if mapped.target in COLUMNS and not sized:
            known = units_of(mapped.target)
            if unit not in known:
                raise ValueError(f"unit {unit!r} of {mapped.target} is none of {', '.join(known)}")
        elif not sized:
            raise ValueError(
                f"{mapped.target} is none of {', '.join(COLUMNS)}, and an extra channel takes a "
                f"factor: {mapped.target}={mapped.column}:x100"
            )


def factor_in(unit: str) -> float | None:
    """1000.0 for `x1000`; None for what is no factor."""
    try:
        factor = float(unit.removeprefix("x"))
    except ValueError:
        return None
    return factor if factor and math.isfinite(factor) else None
