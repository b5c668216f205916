"""Work in a process of its own, so that its seconds and its peak of memory are its own."""

import json
import os
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from zerorate_tools.errors import ZerorateError

_ONE_THREAD = ("OMP_NUM_THREADS", "ARROW_IO_THREADS", "OPENBLAS_NUM_THREADS")
# getrusage tells the peak of what started the process, too, if that was higher
_SPENT = r"""
import json, re, sys, time
from pathlib import Path
def spent():
    peak = re.search(r"VmHWM:\s+(\d+)", Path("/proc/self/status").read_text())
    return [time.process_time(), 1024 * int(peak[1])]
"""
_CLOSE = """
from zerorate_tools.cli import main
began = time.monotonic()
code = main(sys.argv[1:])
print(json.dumps([code, time.monotonic() - began, *spent()]))
"""


def in_child(code: str, *arguments: object, one_thread: bool = False) -> Any:
    """What Python code prints last, as JSON; None if it prints nothing.

    The code has json, sys, time, Path, and on Linux `spent()`: seconds of processor and peak of
    bytes. Raises ZerorateError with what it said last.
    """
    more = dict.fromkeys(_ONE_THREAD, "1") if one_thread else {}
    command = [sys.executable, "-c", _SPENT + code, *map(str, arguments)]
    done = subprocess.run(command, capture_output=True, text=True, env={**os.environ, **more})
    if done.returncode:
        raise ZerorateError(f"a process that was measured failed: {done.stderr.strip()[-2000:]}")
    return json.loads(done.stdout.splitlines()[-1]) if done.stdout else None


def close_cost(write: str) -> dict[str, Any]:
    """seconds, cpu_s, gb and found of `zerorate close`, of the recordings that some code writes
    into `folder`. Raises ZerorateError."""
    with TemporaryDirectory() as scratch:
        folder, out = Path(scratch, "logs"), Path(scratch, "out")
        folder.mkdir()
        in_child(f"folder = Path(sys.argv[1])\n{write}", folder)
        logs = sorted(folder.glob("*.parquet"))
        code, seconds, cpu_s, peak_bytes = in_child(_CLOSE, "close", *logs, "--out", out)
        if code:
            raise ZerorateError(f"`zerorate close` ended with {code}")
        report = json.loads((out / "report.json").read_text(encoding="utf-8"))
    found = [effect["effect"] for effect in report["effects"]]
    return {"seconds": seconds, "cpu_s": cpu_s, "gb": peak_bytes / 1e9, "found": found}
