"""`zerorate runtimes get NAME...`, `list` and `node`: the interpreters that run the firmware."""

import argparse
import sys

_GETTABLE = ("wasm", "x86", "armhf", "x64", "rp2040")


def add_parser(subparsers: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = subparsers.add_parser("runtimes", help="fetch and list the MicroPython interpreters")
    actions = parser.add_subparsers(metavar="ACTION", required=True)
    getting = actions.add_parser("get", help="fetch into the cache what is not there yet")
    getting.add_argument("names", nargs="+", choices=_GETTABLE, metavar="NAME")
    getting.set_defaults(run=get)
    listing = actions.add_parser("list", help="say which are there, and how to get the others")
    listing.set_defaults(run=list_all)
    node = actions.add_parser("node", help="say which Node.js and npm wasm would use")
    node.set_defaults(run=print_node)


def get(arguments: argparse.Namespace) -> int:

    from zerorate_tools.errors import MissingRuntime
    from zerorate_tools.runtimes import fetch

    missing = 0
    for name in arguments.names:
        try:
            _fetch_emulator() if name == "rp2040" else fetch(name)
            print(f"{name}: ready")
        except MissingRuntime as error:
            missing += 1
            print(f"zerorate: {name}: {error}", file=sys.stderr)
    return MissingRuntime.exit_code if missing else 0


def _fetch_emulator() -> None:
    from zerorate_tools.errors import MissingRuntime

    try:
        from zerorate_bench.boards.pico import fetch_rp2040
    except ModuleNotFoundError:
        raise MissingRuntime("the emulated Pico is in a checkout only") from None
    fetch_rp2040()


def list_all(arguments: argparse.Namespace) -> None:
    from zerorate_tools.errors import MissingRuntime
    from zerorate_tools.runtimes import NAMES, find

    for name in (*NAMES, "x64"):
        try:
            find(name)
            print(f"{name:8} ready")
        except MissingRuntime as error:
            print(f"{name:8} missing: {error}")


def print_node(arguments: argparse.Namespace) -> None:
    from zerorate_tools.runtimes.node import node_command, npm_command

    print(*node_command())
    print(*npm_command())
