"""What an entry of a description must be; each refusal names it and says what to write."""

import dataclasses
from collections.abc import Mapping
from typing import Any, get_origin

import numpy as np

from ..errors import BadDescription
from .schema import Table


def table(value: Any, where: str, path: str) -> Table:
    """The value, which must be a table."""
    if not isinstance(value, Mapping):
        raise BadDescription(path, f"{where} is no table", do=f"write [{where}]")
    return value


def tables(value: Any, where: str, path: str) -> list[Table]:
    """The value, which must be a list of tables."""
    if not isinstance(value, (list, tuple)):
        raise BadDescription(path, f"{where} is no list of tables", do=f"write [[{where}]]")
    return [table(entry, where, path) for entry in value]


def filled(cls: type, given: Any, where: str, path: str) -> Any:
    """A dataclass of the schema filled from a table, each value of its kind."""
    entries = table(given, where, path)
    fields = {f.name: f for f in dataclasses.fields(cls)}
    known(entries, tuple(fields), where, path)
    for key, value in entries.items():
        check_value(value, fields[key].type, f"{where}.{key}", path)
    return cls(**entries)


def check_value(value: Any, wanted: Any, where: str, path: str) -> None:
    """Raise BadDescription unless the value is of the wanted type (Any: one number or 3)."""
    if wanted is Any:
        axes(value, where, path)
    elif get_origin(wanted) is list:
        tables(value, where, path)
    elif wanted in (float, float | None) and not is_number(value):
        raise BadDescription(path, f"{where} is {value!r}", do="write a number")
    elif wanted in (str, bool) and type(value) is not wanted:
        raise BadDescription(path, f"{where} is {value!r}", do=f"write a {wanted.__name__}")


def known(entries: Table, names: tuple[str, ...], where: str, path: str) -> None:
    """Raise BadDescription at the first entry that is none of `names`."""
    for key in entries:
        if key not in names:
            place = f"{where}.{key}" if where else str(key)
            raise BadDescription(path, f"{place} is unknown", do=f"choose of {', '.join(names)}")


def axes(value: Any, where: str, path: str) -> np.ndarray:
    """(3,) x y z out of one number or three. Raises BadDescription."""
    values = value if isinstance(value, (list, tuple, np.ndarray)) else [value] * 3
    if len(values) != 3 or not all(is_number(v) for v in values):
        raise BadDescription(path, f"{where} is {value!r}", do="write one number or [x, y, z]")
    return np.array([float(v) for v in values])


def is_number(value: Any) -> bool:
    """Whether it is a finite int or float (a bool is none)."""
    is_number = isinstance(value, (int, float, np.number)) and not isinstance(value, bool)
    return is_number and bool(np.isfinite(value))
