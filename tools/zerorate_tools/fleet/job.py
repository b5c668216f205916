"""What is done with one device: its recordings in, plain values out, whatever is wrong with one."""

from __future__ import annotations

import tempfile
from collections.abc import Iterable, Sequence
from contextlib import ExitStack
from dataclasses import asdict, dataclass, field
from hashlib import sha256
from json import dumps
from os import PathLike
from pathlib import Path
from typing import Any
from urllib.parse import quote

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from ..errors import ZerorateError, printable
from ..loop.read.blocks import session_of
from ..loop.read.sessions import Session
from ..loop.read.ticks import read_ticks
from ..loop.report.result import Effect
from ..recordings import open_recording
from ..recordings.reading import recording_name
from ..replay import replay
from .devices import Device, here, size_and_change
from .population import curve_of

JOBS = ("replay", "close")
BLOCK_S = 5.0
_FIRST_S = 60.0
_GYRO = ("bias_gx", "bias_gy", "bias_gz")


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


def run_batch(job: Job, devices: Sequence[Device]) -> list[dict[str, Any]]:
    """Run the job on some devices: one task of the cluster. See `run_device`."""
    return [run_device(job, device) for device in devices]


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
                    state, scales = Path(scratch) / "state.bin", open_recording(path).scales
                    how = job.folder(device), scales.gyro_lsb_per_dps
                    summaries.append(_replayed(job, path, session, state, *how) | {"file": place})
                    sensor = sensor or scales.to_json()
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


def still_session(path: str) -> Session:
    """A recording's still blocks. Raises BadRecording."""
    return session_of(read_ticks(path), BLOCK_S)


def one_line(error: BaseException) -> str:
    """An exception in a line; those not raised on purpose with their kind."""
    text = " ".join(str(error).split())
    return text if isinstance(error, ZerorateError) else f"{type(error).__name__}: {text}"


def _steps(
    job: Job, device: Device, good: Sequence[str], failures: list[dict[str, str]]
) -> list[Effect]:
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


def _replayed(
    job: Job, path: str, session: Session, state: Path, folder: Path | None, lsb_per_dps: float
) -> dict[str, Any]:
    """Replay a recording from what `state` holds, if it is there, and leave the state in it.

    folder: keeps the replay's table. error_mdps: per axis the rms of what the firmware's bias
    misses of the still blocks, the first minute not counted. Raises ZerorateError.
    """
    name = recording_name(Path(path))
    out = (folder or state.parent) / f"{name}.replay.parquet"
    done = replay(
        path,
        out,
        state=state,
        from_state=state if state.exists() else None,
        model=job.model,
        options=job.options,
    )
    columns = ["t_us", *_GYRO]
    bias_lsb = block_means(pq.ParquetFile(out).iter_batches(columns=columns), session)
    if folder is None:
        out.unlink()
    return {
        "name": name,
        "samples": done.samples,
        "duration_s": session.blocks * session.block_s,
        "error_mdps": error_mdps(session, bias_lsb / lsb_per_dps, from_s=_FIRST_S),
    }


def block_means(batches: Iterable[pa.RecordBatch], session: Session) -> np.ndarray:
    """(blocks, 3) mean over each block of what a replay's table says is subtracted, LSB."""
    size, start_us = session.blocks, session.start_us
    total, count = np.zeros((size, 3)), np.zeros(size)
    for batch in batches:
        t_us = batch.column("t_us").to_numpy()
        block = ((t_us - start_us) // round(session.block_s * 1e6)).astype(np.int64)
        inside = block < size
        count += np.bincount(block[inside], minlength=size)
        for axis, column in enumerate(_GYRO):
            values = batch.column(column).to_numpy()[inside]
            total[:, axis] += np.bincount(block[inside], values, minlength=size)
    return total / np.maximum(count, 1)[:, None]


def error_mdps(
    session: Session, bias_dps: np.ndarray, from_s: float = 0.0, to_s: float = np.inf
) -> list[float] | None:
    """Per axis the rms distance of a bias from the still blocks of a stretch; None without any."""
    begin_s = np.arange(session.blocks) * session.block_s
    within = session.available & (begin_s >= from_s) & (begin_s + session.block_s <= to_s)
    if not within.any():
        return None
    left = session.rate_dps[within] - bias_dps[within]
    return [round(float(v), 4) for v in 1e3 * np.sqrt((left**2).mean(axis=0))]
