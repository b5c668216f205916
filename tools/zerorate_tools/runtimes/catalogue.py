"""Interpreters by name: which there are, where each one is, how to get it."""

import os
from collections.abc import Callable
from pathlib import Path

from zerorate_tools.errors import MissingRuntime
from zerorate_tools.runtimes.node import fetch_wasm, find_wasm
from zerorate_tools.runtimes.runtime import CPython, Runtime, UnixPort
from zerorate_tools.runtimes.unix_port import fetch_unix_port, find_unix_port

#: The four on which the firmware must give the same state to the last bit. `find` also knows
#: x64, what a user's `apt install micropython` gives.
NAMES = ("cpython", "wasm", "x86", "armhf")

_FIND: dict[str, Callable[[], Runtime]] = {
    "cpython": CPython,
    "wasm": find_wasm,
    "x86": lambda: find_unix_port("x86"),
    "armhf": lambda: find_unix_port("armhf"),
    "x64": lambda: find_unix_port("x64"),
}
_FETCH: dict[str, Callable[[], None]] = {
    "cpython": lambda: None,
    "wasm": fetch_wasm,
    "x86": lambda: fetch_unix_port("x86"),
    "armhf": lambda: fetch_unix_port("armhf"),
    "x64": lambda: fetch_unix_port("x64"),
}


def find(name: str | Path) -> Runtime:
    """The interpreter of this name, or the MicroPython executable at this path.

    Raises MissingRuntime, whose text says how to get it.
    """
    if name in _FIND:
        try:
            return _FIND[str(name)]()
        except MissingRuntime as missing:
            raise MissingRuntime(f"{missing}; {how_to_get(str(name))}") from missing
    path = Path(name).expanduser()
    if not path.is_file() or not os.access(path, os.X_OK):
        known = ", ".join(_FIND)
        raise MissingRuntime(f"{name} is neither a MicroPython executable nor one of {known}")
    return UnixPort(str(name), path.absolute())


def fetch(name: str) -> Runtime:
    """Fetch an interpreter into the cache unless it is there, and find it. MissingRuntime."""
    if name not in _FETCH:
        raise MissingRuntime(f"{name} cannot be fetched; these can: {', '.join(_FETCH)}")
    _FETCH[name]()
    return find(name)


def available() -> list[str]:
    """Those of NAMES that this machine can run now."""
    return [name for name in NAMES if _is_there(name)]


def how_to_get(name: str) -> str:
    """The sentence that tells a person how to get an interpreter."""
    return f"`zerorate runtimes get {name}` fetches it"


def _is_there(name: str) -> bool:
    try:
        find(name)
    except MissingRuntime:
        return False
    return True
