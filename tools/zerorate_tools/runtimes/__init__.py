"""The interpreters that run the firmware: how each is had, and one way to run a script on all.

    from zerorate_tools.runtimes import find
    result = find("x86").run(Path("main.py"), modules=[Path("firmware")], files_in={"a.bin": data},
                             files_out=["b.bin"])

`zerorate runtimes get wasm x86 armhf` fetches them, `zerorate runtimes list` shows them.
"""

import os
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from pathlib import Path

from ..errors import MissingRuntime
from .node import fetch_wasm, find_wasm
from .runtime import CPython, Result, Runtime, UnixPort
from .unix_port import ARCHITECTURES, fetch_unix_port, find_unix_port

__all__ = ["NAMES", "Result", "Runtime", "available", "fetch", "find", "how_to_get"]

#: The four on which the firmware must give the same state to the last bit. `find` also knows
#: x64, what a user's `apt install micropython` gives.
NAMES = ("cpython", "wasm", "x86", "armhf")

_FIND: dict[str, Callable[[], Runtime]] = {"cpython": CPython, "wasm": find_wasm}
_FIND |= {name: partial(find_unix_port, name) for name in ARCHITECTURES}
_FETCH: dict[str, Callable[[], None]] = {"cpython": lambda: None, "wasm": fetch_wasm}
_FETCH |= {name: partial(fetch_unix_port, name) for name in ARCHITECTURES}


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
    _FETCH[name]()
    return find(name)


def available() -> list[str]:
    """Those of NAMES that this machine can run now."""
    found = []
    for name in NAMES:
        with suppress(MissingRuntime):
            find(name)
            found.append(name)
    return found


def how_to_get(name: str) -> str:
    """The sentence that tells a person how to get an interpreter."""
    return f"`zerorate runtimes get {name}` fetches it"
