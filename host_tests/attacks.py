"""Every attack, and how many succeeded: `make attacks` prints the table of docs/faults.md.

Each row is a command of its own, which also says what fell. ZERORATE_FUZZ is how many damaged
files each reader is given.
"""

import argparse
import os
import re
import shlex
import subprocess
import sys
import time
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[1]
_PYTEST = "pytest -q -p no:cacheprovider"
# what is attacked -> (with what, module of Python and its arguments)
ATTACKS = {
    "bus and store": ("faults, cuts, turned bits", "zerorate_tools.cli bench faults"),
    "store, while it lives": (
        "a turned bit, then a cut",
        f"{_PYTEST} host_tests/firmware -k 'test_store or test_places'",
    ),
    "a state, checksum right": (
        "every word turned",
        "host_tests.turned_words --on x86 --on armhf",
    ),
    "models": ("cuts, turned bits, noise", f"{_PYTEST} host_tests/tools -k test_model"),
    "readers": ("damaged files", f"{_PYTEST} host_tests/hostile -k any"),
    "logs": ("damaged logs of 16 formats", "host_tests.hostile.many_logs"),
    "commands": ("odd files, names, numbers, places", "host_tests.hostile.odd_commands"),
    "memory": (
        "six files that unpack to gigabytes",
        f"{_PYTEST} -s host_tests/hostile/test_bombs.py",
    ),
    "writers": (
        "signals, full disks",
        f"{_PYTEST} host_tests/tools -k 'test_atomic or test_drafts or test_growing'",
    ),
    "writers, killed": (
        "kill -9 at each rename, and at lengths of files",
        "host_tests.tools.killed_writers",
    ),
    "recorders, killed": (
        "SIGTERM, SIGHUP, SIGINT, kill -9, full disks, unpluggings",
        "host_tests.tools.killed_recorders",
    ),
    "reports": (
        "hostile names",
        f"{_PYTEST} host_tests/report/test_page.py host_tests/fleet/test_population.py -k name",
    ),
    "31 bits": ("random sensors and settings", "host_tests.firmware.sweep"),
    "service restarts": ("10,000, in order and by kill", "host_tests.service.restarts"),
    "service": (
        "1,000 readers, failing sinks, buses",
        f"{_PYTEST} host_tests/service -k 'not restarts'",
    ),
    "a board's day": ("resets, unpluggings", "host_tests.boards.day"),
}


def attack(arguments):
    """(how many succeeded, what was said last, lines that tell a peak of memory) of a command."""
    done = subprocess.run(
        [sys.executable, "-m", *shlex.split(arguments)],
        cwd=REPOSITORY,
        capture_output=True,
        text=True,
    )
    lines = [line for line in done.stdout.splitlines() if line.strip()]
    failed = re.search(r"(\d+) failed", done.stdout)
    fell = int(failed[1]) if failed else int(done.returncode != 0)
    said = lines[-1].strip() if lines else done.stderr.strip()[-80:]
    return fell, said, re.findall(r"^.*: at most \d+ MB", done.stdout, re.MULTILINE)


def main():
    """Print the table; 1 if an attack succeeded."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("attacks", nargs="*", choices=[*ATTACKS, []], help="default: all")
    chosen = parser.parse_args().attacks or ATTACKS
    os.environ.setdefault("ZERORATE_FUZZ", "200")
    fallen, sizes = 0, []
    print("| attacked | with | succeeded | last line | s |\n|---|---|---:|---|---:|")
    for name in chosen:
        began = time.monotonic()
        fell, said, peaks = attack(ATTACKS[name][1])
        fallen += fell
        sizes += peaks
        took_s = time.monotonic() - began
        print(f"| {name} | {ATTACKS[name][0]} | {fell} | {said} | {took_s:.0f} |", flush=True)
    print("\n".join(sizes))
    return 1 if fallen else 0


if __name__ == "__main__":
    sys.exit(main())
