"""The interpreters that run the firmware: how each is had, and one way to run a script on all.

    from zerorate_tools.runtimes import find
    result = find("x86").run(Path("main.py"), modules=[Path("firmware")], files_in={"a.bin": data},
                             files_out=["b.bin"])

`zerorate runtimes get wasm x86 armhf` fetches them, `zerorate runtimes list` shows them.
"""

from zerorate_tools.runtimes.catalogue import NAMES, available, fetch, find, how_to_get
from zerorate_tools.runtimes.runtime import Result, Runtime

__all__ = ["NAMES", "Result", "Runtime", "available", "fetch", "find", "how_to_get"]
