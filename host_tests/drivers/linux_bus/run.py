"""The driver, the recorder and the corrector on a real Linux kernel's I2C bus, emulated."""

import json
import shlex
import sys
from pathlib import Path

from zerorate_tools.errors import ZerorateError

from . import machine

_GUEST = Path(__file__).with_name("guest.py")
_ROOT = Path(__file__).resolve().parents[3]
_TIME_LIMIT_S = 900


def run_guest(rate_hz: float = 25, seconds: float = 20) -> dict:
    """What guest.py found: samples read, lost and out of order, rate, bias learned.

    Raises MissingRuntime when the machine has not been fetched, ZerorateError with the end of the
    console's text when the guest came to no result.
    """
    folders = ("tools", "drivers", "firmware", "host_tests/fakes")
    path = ":".join(str(_ROOT / folder) for folder in folders)
    settings = f"PYTHONPATH={shlex.quote(path)} PYTHONDONTWRITEBYTECODE=1"
    python = f"{shlex.quote(sys.executable)} {shlex.quote(str(_GUEST))}"
    console = machine.boot(f"{settings} {python} {rate_hz} {seconds} 2>&1 | cat\n", _TIME_LIMIT_S)
    found = [line for line in console.splitlines() if line.startswith("RESULT ")]
    if not found:
        last = " | ".join(line for line in console.splitlines()[-6:] if line)
        raise ZerorateError(f"the emulated Linux machine came to no result: {last}")
    return json.loads(found[-1][len("RESULT ") :])
