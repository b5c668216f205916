"""The driver, the recorder and the corrector on a real Linux kernel's I2C bus, emulated.

python -m host_tests.drivers.linux_bus.run: fetch the machine, run on it, print what it found.
"""

import io
import json
import re
import shlex
import sys
import tempfile
from pathlib import Path

import numpy as np
from zerorate_tools.errors import ZerorateError

from . import machine

_GUEST = Path(__file__).with_name("guest.py")
_ROOT = Path(__file__).resolve().parents[3]
_TIME_LIMIT_S = 900
BIAS_LSB = (44, -21)
#: More than are played until the guest ends: the count of samples in gz must not begin anew.
_ROWS = 8000
_NAMES = ("t_us", "ax", "ay", "az", "temp", "gx", "gy", "gz")


def run_guest(rate_hz: float = 25, seconds: float = 6) -> dict:
    """What came of guest.py: samples read, lost and out of order, rate, bias learned.

    Raises MissingRuntime when the machine has not been fetched, ZerorateError with the end of the
    console's text when the guest came to no result.
    """
    folders = ("tools", "drivers", "firmware", "host_tests/fakes")
    path = ":".join(str(_ROOT / folder) for folder in folders)
    settings = f"PYTHONPATH={shlex.quote(path)} PYTHONDONTWRITEBYTECODE=1"
    python = f"{shlex.quote(sys.executable)} {shlex.quote(str(_GUEST))}"
    with tempfile.TemporaryDirectory(prefix="zerorate-played-") as folder:
        path, played = f"{folder}/played.csv", _played(rate_hz)
        np.savetxt(path, played, fmt="%d", delimiter=",", header=",".join(_NAMES), comments="")
        arguments = f"{rate_hz} {seconds} {path}"
        console = machine.boot(f"{settings} {python} {arguments} 2>&1 | cat\n", _TIME_LIMIT_S)
    found = [line for line in console.splitlines() if line.startswith("RESULT ")]
    if not found:
        last = " | ".join(line for line in console.splitlines()[-6:] if line)
        raise ZerorateError(f"the emulated Linux machine came to no result: {last}")
    result = json.loads(found[-1][len("RESULT ") :])
    return {**result, "record": _compared(played, **result["record"])}


def _played(rate_hz: float) -> np.ndarray:
    """Rows of a device at rest; gz counts them, so that losses show."""
    number, noise = np.arange(_ROWS), np.random.default_rng(1)
    means = (0, 0, 16384, *BIAS_LSB)
    words = np.rint(noise.normal(means, (40, 40, 40, 2, 2), (_ROWS, 5))).astype(int)
    t_us, temp = (number * 1e6 / rate_hz).astype(int), -3000 + number // 500
    return np.column_stack([t_us, words[:, :3], temp, words[:, 3:], number])


def _compared(played: np.ndarray, said: str, text: str) -> dict:
    samples, rate, lost = re.search(
        r"(\d+) samples in .*\(([\d.]+) Hz\), (\d+) lost", said
    ).groups()
    header, _, rows = text.partition("\n")
    found = np.loadtxt(io.StringIO(rows), dtype=int, delimiter=",")
    found = found[:, [header.split(",").index(name) for name in _NAMES]]
    steps = np.diff(found[:, -1])
    return {
        "samples": int(samples),
        "said_lost": int(lost),
        "rate_hz": float(rate),
        "rows": len(found),
        "false_rows": int((found[:, 1:] != played[found[:, -1], 1:]).any(axis=1).sum()),
        "out_of_order": int((steps <= 0).sum()),
        "really_lost": int((steps - 1).sum()),
    }


if __name__ == "__main__":
    machine.fetch()
    print(json.dumps(run_guest(), indent=2))
