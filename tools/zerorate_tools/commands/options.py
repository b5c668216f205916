"""Options that several commands have: paths, numbers that are refused, and `--json`."""

import argparse
import dataclasses
import json
import math
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

_MOST = 1e9
#: A parser, or a group of one.
Parser = argparse._ActionsContainer


def option(
    parser: Parser, flags: str, metavar: str, help: str, type: Callable[..., Any] = str, **how: Any
) -> None:
    """Add an option, or an argument, that takes a value. flags: `-o --out`; how: as argparse."""

    def read(text: str) -> Any:
        # what argparse would say of a ValueError has the name of a function in it
        try:
            return type(text)
        except ValueError:
            raise argparse.ArgumentTypeError(f"{text} is no {_kind_of(text)}") from None

    parser.add_argument(*flags.split(), metavar=metavar, help=help, type=read, **how)


def _kind_of(text: str) -> str:
    """The kind of number that it is not."""
    try:
        float(text)
    except ValueError:
        return "number"
    return "whole number"


def switch(parser: Parser, flag: str, help: str) -> None:
    """Add an option that takes no value."""
    parser.add_argument(flag, action="store_true", help=help)


def finite(text: str) -> float:
    """A number, and neither nan nor inf."""
    value = float(text)
    if not math.isfinite(value):
        raise argparse.ArgumentTypeError(f"{text} is no finite number")
    return value


def above_zero(text: str) -> float:
    """A number above 0, up to a billion: 30 years of seconds, and no rate or scale has more."""
    value = finite(text)
    if not 0 < value <= _MOST:
        raise argparse.ArgumentTypeError(f"{text} is not above 0, up to {_MOST:.0e}")
    return value


def address_7_bits(text: str) -> int:
    """An address that a chip on an I2C bus may have, as 0x68; the bus keeps the others."""
    if not 0x08 <= (address := int(text, 0)) <= 0x77:
        raise argparse.ArgumentTypeError(f"{text} is no I2C address; they are 0x08 to 0x77")
    return address


def add_json(parser: Parser) -> None:
    """Add --json to a command."""
    switch(parser, "--json", "print one JSON document instead of words")


def print_json(found: object) -> None:
    """Print it; what is no number is null, as JSON has no other word for it."""
    print(json.dumps(_plain(found), indent=1))


def _plain(value: Any) -> Any:
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        return {f.name: _plain(getattr(value, f.name)) for f in dataclasses.fields(value)}
    if isinstance(value, Mapping):
        return {str(key): _plain(one) for key, one in value.items()}
    if hasattr(value, "tolist"):  # of numpy, which `--help` does without
        return _plain(value.tolist())
    if isinstance(value, (list, tuple, set, frozenset)):
        return [_plain(one) for one in value]
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    return str(value) if isinstance(value, Path) else value
