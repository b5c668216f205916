"""Counting the instructions that a script costs on the x86 interpreter, by valgrind's callgrind.

Debian 13's valgrind is used: 3.19 of Debian 12 stops at an opcode in that C library's loader.
"""

import os
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from zerorate_tools.errors import MissingRuntime, ZerorateError
from zerorate_tools.runtimes.cache import runtime_folder
from zerorate_tools.runtimes.debian import host_architecture
from zerorate_tools.runtimes.runtime import Runtime
from zerorate_tools.runtimes.unix_port import fetch_folder

_FOLDER = "valgrind-debian13"
_LOG = ".callgrind.log"
_COLLECTED = re.compile(r"Collected : (\d+)")


def fetch_callgrind() -> None:
    """Fetch valgrind into the cache unless it is there. Raises MissingRuntime."""
    if host_architecture() != "amd64":
        raise MissingRuntime("instructions are counted on x86-64 machines only")
    fetch_folder(_FOLDER, "amd64", ["valgrind"])


def instructions(
    runtime: Runtime, script: Path | str, args: Sequence[object] = (), **run: Any
) -> int:
    """Instructions of a whole run, start-up included: compare two lengths, never totals.

    runtime: the x86 interpreter; run: Runtime.run's modules, files_in, heap, stdin and timeout.
    Raises MissingRuntime without valgrind, ZerorateError when the script fails.
    """
    result = runtime.run(
        script, args, prefix=callgrind_command(), files_out=[_LOG], check=True, **run
    )
    counted = _COLLECTED.search(result.files[_LOG].decode())
    if counted is None:
        raise ZerorateError(f"callgrind counted nothing on {runtime.name}")
    return int(counted.group(1))


def instructions_per_item(
    runtime: Runtime, script: Path | str, short: int, long: int, **run: Any
) -> float:
    """Instructions of one item: the script's one argument is how many items it is to do."""
    cost = [instructions(runtime, script, [count], **run) for count in (short, long)]
    return (cost[1] - cost[0]) / (long - short)


def callgrind_command() -> list[str]:
    """The words before a command that has its instructions counted. Raises MissingRuntime."""
    folder = runtime_folder(_FOLDER)
    if not folder.is_dir():
        raise MissingRuntime(
            "valgrind is not fetched yet; `zerorate runtimes get valgrind` fetches it"
        )
    library = f"VALGRIND_LIB={folder / 'usr/libexec/valgrind'}"
    options = ["--tool=callgrind", f"--log-file={_LOG}", f"--callgrind-out-file={os.devnull}"]
    return ["env", library, str(folder / "usr/bin/valgrind.bin"), *options]
