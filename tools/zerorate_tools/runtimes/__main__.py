"""`python -m zerorate_tools.runtimes get NAME...`, `... list` and `... node`."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence

from zerorate_tools.errors import MissingRuntime
from zerorate_tools.runtimes.callgrind import fetch_callgrind
from zerorate_tools.runtimes.catalogue import NAMES, fetch, find
from zerorate_tools.runtimes.node import node_command, npm_command

_GETTABLE = ("wasm", "x86", "armhf", "x64", "valgrind")


def main(arguments: Sequence[str] | None = None) -> int:
    parser = argparse.ArgumentParser(prog="python -m zerorate_tools.runtimes")
    commands = parser.add_subparsers(dest="command", required=True)
    getting = commands.add_parser("get", help="fetch interpreters into the cache")
    getting.add_argument("names", nargs="+", choices=_GETTABLE, metavar="NAME")
    commands.add_parser("list", help="say which interpreters are there")
    commands.add_parser("node", help="exit with 0 if Node.js and npm are there, for wasm")
    asked = parser.parse_args(arguments)
    if asked.command == "get":
        return _get(asked.names)
    return _list() if asked.command == "list" else _node()


def _get(names: Sequence[str]) -> int:
    missing = 0
    for name in names:
        try:
            if name == "valgrind":
                fetch_callgrind()
            else:
                fetch(name)
            print(f"{name}: ready")
        except MissingRuntime as error:
            missing += 1
            print(f"{name}: {error}", file=sys.stderr)
    return 2 if missing else 0


def _list() -> int:
    for name in (*NAMES, "x64"):
        try:
            print(f"{name:8} {'viper' if find(name).viper else 'no viper'}")
        except MissingRuntime as error:
            print(f"{name:8} missing: {error}")
    return 0


def _node() -> int:
    try:
        print(*node_command(), *npm_command())
    except MissingRuntime as error:
        print(error, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main())
