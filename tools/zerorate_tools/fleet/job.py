"""What is done with one device: its recordings in, plain values out, whatever is wrong with one."""

import resource
import sys
import tempfile
import time
from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import asdict, dataclass, field
from hashlib import sha256
from json import dumps
from os import PathLike
from pathlib import Path
from typing import Any
from urllib.parse import quote

from ..errors import printable
from ..loop.read.blocks import session_of
from ..loop.read.sessions import Session
from ..loop.read.ticks import read_ticks
from ..loop.report.result import Effect
from ..recordings import open_recording
from .curve import curve_of
from .devices import Device
from .places import here, size_and_change
from .replay_power_on import replay_power_on

JOBS = ("replay", "close")
BLOCK_S = 5.0


@dataclass(frozen=True)
class Job:
    """What to do with every device.

    kind: replay or close; options: keywords of zerorate.Corrector; model: an effect model to load;
    keep: folder for each device's own files (the replay's Parquet, or all that `close` writes).
    """

    kind: str = "replay"
    options: dict[str, Any] = field(default_factory=dict)
    model: str | None = None
    keep: str | None = None

    def fingerprint(self, device: Device) -> str:
        """Changes with the job and with the recordings' names, sizes and times of change."""
        files = [[place, *size_and_change(place)] for place in device.recordings]
        text = dumps([asdict(self), device.recordings, files], sort_keys=True)
        return sha256(text.encode()).hexdigest()[:32]

    def folder(self, device: Device) -> Path | None:
        """Where a device's own files are kept, made if need be."""
        if self.keep is None:
            return None
        path = Path(self.keep) / f"device={quote(device.name, safe='')}"
        path.mkdir(parents=True, exist_ok=True)
        return path


def run_batch(job: Job, devices: Sequence[Device]) -> dict[str, Any]:
    """Run the job on some devices: one task of the cluster.

    Returns `devices` (see `run_device`), the worker's `peak_bytes` so far and the `seconds` and
    `cpu_seconds` taken.
    """
    begun, cpu_begun = time.perf_counter(), time.process_time()
    done = [run_device(job, device) for device in devices]
    unit = 1 if sys.platform == "darwin" else 1024
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit
    return {
        "devices": done,
        "peak_bytes": peak,
        "seconds": time.perf_counter() - begun,
        "cpu_seconds": time.process_time() - cpu_begun,
    }


def run_device(job: Job, device: Device) -> dict[str, Any]:
    """Run the job on one device; never raises for what its recordings hold.

    `failures` names each recording left out and why, `sessions` what was found in each of the
    others, `curve` and `steps` what they show together.
    """
    failures: list[dict[str, str]] = []
    sessions, summaries, good, sensor = [], [], [], None
    with tempfile.TemporaryDirectory(prefix="zerorate-fleet-") as scratch:
        for place in device.recordings:
            try:
                with here(place, scratch) as path:
                    session = still_session(path)
                    state = Path(scratch) / "state.bin"
                    summaries.append(_replayed(job, path, session, state, device) | {"file": place})
                    sensor = sensor or open_recording(path).scales.to_json()
                sessions.append(session)
                good.append(place)
            except Exception as error:  # of a stranger's file; the fleet goes on
                failures.append({"file": printable(place), "reason": one_line(error)})
    curve = curve_of(sessions) if sessions else None
    return {
        "device": device.name,
        "fingerprint": job.fingerprint(device),
        "sensor": sensor,
        "sessions": summaries,
        "curve": None if curve is None else curve.to_json(),
        "steps": _steps(job, device, good, failures) if job.kind == "close" and good else [],
        "failures": failures,
    }


def _replayed(job: Job, path: str, session: Session, state: Path, device: Device) -> dict[str, Any]:
    return replay_power_on(
        *(path, session, state, job.folder(device)), model=job.model, options=dict(job.options)
    )


def still_session(path: str) -> Session:
    """A recording's still blocks. Raises BadRecording."""
    return session_of(read_ticks(path), BLOCK_S)


def one_line(error: BaseException) -> str:
    """An exception in a line; those not raised on purpose with their kind."""
    from ..errors import ZerorateError

    text = " ".join(str(error).split())
    return text if isinstance(error, ZerorateError) else f"{type(error).__name__}: {text}"


def _steps(job, device, good, failures) -> list[Effect]:
    from ..closing import close

    with tempfile.TemporaryDirectory(prefix="zerorate-fleet-") as scratch:
        try:
            with ExitStack() as copies:
                logs: list[str | PathLike[str]] = [
                    copies.enter_context(here(place, scratch)) for place in good
                ]
                return close(logs, job.folder(device) or scratch)["effects"]
        except Exception as error:
            failures.append({"file": device.name, "reason": f"close: {one_line(error)}"})
            return []
