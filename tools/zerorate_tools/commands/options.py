"""How a command is written down: its name, its options, numbers that are refused, and `--json`."""

import argparse
import dataclasses
import json
import math
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, TypeAlias

_MOST = 1e9
Run = Callable[[argparse.Namespace], int | None]
Parsers: TypeAlias = "argparse._SubParsersAction[Any]"
#: What adds arguments to a parser, or to a group of one.
Arguments = Callable[[Any], None]


def argument(*flags: str, **how: Any) -> Arguments:
    """An argument as argparse takes it."""

    def add(parser: argparse._ActionsContainer) -> None:
        parser.add_argument(*flags, **how)

    return add


def group(title: str, *options: Arguments) -> Arguments:
    """Options under a title of their own."""

    def add(parser: argparse._ActionsContainer) -> None:
        below = parser.add_argument_group(title)
        for add_one in options:
            add_one(below)

    return add


def option(words: str, help: str, type: Callable[..., Any] = str, **how: Any) -> Arguments:
    """An option, or an argument, that takes a value. words: `-o --out FILE`; how: as argparse."""

    def read(text: str) -> Any:
        # what argparse would say of a ValueError has the name of a function in it
        try:
            return type(text)
        except ValueError:
            raise argparse.ArgumentTypeError(f"{text} is no {_kind_of(text)}") from None

    *flags, metavar = words.split()
    return argument(*flags, metavar=metavar, help=help, type=read, **how)


def _kind_of(text: str) -> str:
    """The kind of number that it is not."""
    try:
        float(text)
    except ValueError:
        return "number"
    return "whole number"


def switch(flag: str, help: str) -> Arguments:
    """An option that takes no value."""
    return argument(flag, action="store_true", help=help)


JSON = switch("--json", "print one JSON document instead of words")

#: Name, of an action with that of its command before it -> what adds it to the parsers.
_ADDED: dict[str, Callable[[Parsers], None]] = {}


def command(
    name: str, help: str, *options: Arguments, description: str | None = None, **how: Any
) -> Callable[[Run], Run]:
    """Make the function below what runs a command, or an action of one: "model show"."""

    def register(run: Run) -> Run:
        def add(parsers: Parsers) -> None:
            parser = parsers.add_parser(
                name.rpartition(" ")[2], help=help, description=description, **how
            )
            for add_one in options:
                add_one(parser)
            parser.set_defaults(run=run, refuse=parser.error)

        _ADDED[name] = add
        return run

    return register


def with_actions(
    name: str, help: str, description: str | None = None, metavar: str = "ACTION"
) -> None:
    """Make a command of the actions that are registered with its name before theirs."""

    def add(parsers: Parsers) -> None:
        parser = parsers.add_parser(name, help=help, description=description)
        actions = parser.add_subparsers(metavar=metavar, required=True)
        for action in [one for one in _ADDED if one.startswith(f"{name} ")]:
            _ADDED[action](actions)

    _ADDED[name] = add


def add_command(parsers: Parsers, name: str) -> None:
    """Add a command, with all that it can be given, to the parsers."""
    _ADDED[name](parsers)


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


def setting(text: str) -> tuple[str, float]:
    """A setting of the firmware, NAME=NUMBER."""
    name, _, value = text.partition("=")
    try:
        number = float(value)
        return name, int(number) if name in ("bins", "short", "long") else number
    except (ValueError, OverflowError) as error:
        raise argparse.ArgumentTypeError(f"{text}: not of the form NAME=NUMBER") from error


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
