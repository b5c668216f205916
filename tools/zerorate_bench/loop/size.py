"""How long, and in how much memory, a large device is closed: four sessions of eight hours."""

import json
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from .figures import Figure

SESSIONS, HOURS, HZ = 4, 8, 100.0
MOST_S, MOST_GB = 60.0, 2.0
_DEVICE = {
    "sessions": SESSIONS,
    "sensor": {"odr_hz": HZ},
    "bias": {"b0": [1.2, -0.8, 0.4], "b1": [0.02, -0.015, 0.01], "turn_on_dps": 0.02},
    "noise": {"bias_instability_dps": 0.002, "random_walk_dps": 0.00005},
    "every_session": {
        "start_degc": 22.0,
        "temperature": [{"cycle": 12.0, "period_minutes": 95.0, "hours": HOURS}],
        "vary_time": 0.02,
    },
    "effect": [{"kind": "sensor-lag", "tau_s": 120.0, "rms_dps": 0.01}],
}


def write_device(folder: Path) -> list[Path]:
    """The device's recordings, a session a file."""
    from zerorate_tools.simulate import simulate_to_files

    return simulate_to_files(_DEVICE, folder / "large.parquet")


def measured() -> dict:
    """Seconds by the clock and of the processor, GB at the most, of `zerorate close`."""
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        # in a process of its own, whose memory is not counted
        writes = f"from {__name__} import write_device; from pathlib import Path; "
        writes += f"write_device(Path({scratch!r}))"
        subprocess.run([sys.executable, "-c", writes], check=True)
        logs = sorted(str(p) for p in folder.glob("large-*.parquet"))
        close = ["close", *logs, "--out", str(folder / "out")]
        return _run([sys.executable, "-m", "zerorate_tools.cli", *close], folder / "out")


def _run(command: list[str], out: Path) -> dict:
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    began = time.monotonic()
    done = subprocess.run(command, capture_output=True, check=False)
    seconds = time.monotonic() - began
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode:
        raise RuntimeError(done.stderr.decode(errors="replace")[-2000:])
    report = json.loads((out / "report.json").read_text(encoding="utf-8"))
    return {
        "seconds": seconds,
        "cpu_s": after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime,
        # the largest child so far: writing the recordings may be it, which is then said too high
        "most_gb": after.ru_maxrss / 1e6,
        "found": [effect["effect"] for effect in report["effects"]],
    }


def figures_of(size: dict) -> list[Figure]:
    """Time and memory beside their limits."""
    name = f"{SESSIONS} sessions of {HOURS} h at {HZ:g} Hz: "
    return [
        Figure(name + "seconds by the clock", size["seconds"], MOST_S, True, 1, unit="s"),
        Figure(name + "seconds of processor", size["cpu_s"], None, True, 1, unit="s"),
        Figure(name + "memory", size["most_gb"], MOST_GB, True, 1, unit="GB"),
    ]
