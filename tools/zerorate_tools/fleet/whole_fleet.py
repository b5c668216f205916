"""`zerorate fleet`: many devices' recordings in, one table, a report and a prior out."""

from __future__ import annotations

import json
import os
import uuid
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pyarrow as pa
import pyarrow.parquet as pq

from ..errors import BadRecording, ZerorateError
from ..recordings.atomic import written_beside, written_together
from ..recordings.drafts import clear_left_over
from ..recordings.guarded import read_in_safety
from ..recordings.scales import scales_from_text
from ..replay.engines import compiled
from .cluster import cluster, in_batches, run_all, size_of
from .devices import Device, absolute, is_url
from .fleet_in_words import Fleet, table_of
from .job import JOBS, Job, one_line, run_batch
from .part import Part, curve_effects, part_of, step_effects
from .population import Curve
from .prior import Runner, benefit, prior_json, write_prior

if TYPE_CHECKING:
    from distributed import Client

#: Devices that the report names as those furthest off.
_MOST_WORST = 10


def fleet(
    devices: Sequence[Device],
    out: str | PathLike[str],
    *,
    job: str = "replay",
    scheduler: str | None = None,
    workers: int | None = None,
    devices_per_task: int | None = None,
    options: dict[str, Any] | None = None,
    model: str | PathLike[str] | None = None,
    keep: bool = False,
    minutes: float | None = 5.0,
    advance: Callable[[float], None] = lambda n: None,
) -> Fleet:
    """Run devices (see `devices_of`) through replay or close, and estimate their part.

    Writes fleet.parquet (a row for each device and effect), fleet.json, fleet.html and, from
    five devices on, prior/model.bin for a new device, tried on devices left out over its first
    `minutes`, or as many as were recorded (None: not tried), into the folder `out`. Recordings that
    fail are named in the report. Results are kept as they come: a second run over the same folder
    does only what is left. options: keywords of zerorate.Corrector; keep: each device's own files
    too; advance: called with devices done.
    Raises ZerorateError.
    """
    if job not in JOBS:
        raise ZerorateError(f"{job}: no such job; choose of {', '.join(JOBS)}")
    if is_url(str(out)):
        raise ZerorateError(f"{out}: results are written to a folder of this machine; name one")
    folder = Path(out)
    own = os.path.join(os.path.realpath(folder), "devices") if keep else None
    work = Job(job, options or {}, str(Path(model).resolve()) if model else None, own)
    devices = [Device(one.name, tuple(map(absolute, one.recordings))) for one in devices]
    wanted = {device.name: work.fingerprint(device) for device in devices}
    with cluster(scheduler, workers) as client:
        parts = Parts(folder)  # made now, so that a cluster that cannot be had leaves nothing
        done = parts.whole()
        left = [device for device in devices if wanted[device.name] not in done]
        fleet = Fleet(resumed=len(devices) - len(left))
        advance(fleet.resumed)
        if left:
            compiled()  # here first, so that what there is to say of it is said once
        batches = in_batches(left, size_of(client), devices_per_task)
        fleet.tasks = len(batches)
        for batch, result in run_all(client, partial(run_batch, work), batches):
            parts.add(_noted(result, batch, wanted))
            advance(len(batch))
        fleet.report = _conclude(parts.results(wanted), work, folder, minutes, client)
    return fleet


def _noted(result: Any, batch: Iterable[Device], wanted: dict[str, str]) -> list[dict[str, Any]]:
    """The results of a batch; those of one whose worker died say that it did."""
    if not isinstance(result, BaseException):
        return result
    why = one_line(result)
    if type(result).__name__ == "KilledWorker":
        why = "the worker died on it, again and again; out of memory?"
    nothing: dict[str, Any] = {"sensor": None, "sessions": [], "curve": None, "steps": []}
    return [
        {
            "device": device.name,
            "fingerprint": wanted[device.name],
            **nothing,
            "failures": [{"file": path, "reason": why} for path in device.recordings],
        }
        for device in batch
    ]


def _conclude(
    results: Iterable[dict[str, Any]],
    work: Job,
    folder: Path,
    minutes: float | None,
    client: Client,
) -> dict[str, Any]:
    from .plots import write_page

    found = list(results)
    kinds = Counter(_kind(r["sensor"]) for r in found if r["sensor"])
    sensor = kinds.most_common(1)[0][0] if kinds else None
    mine = [r for r in found if r["curve"] and r["sensor"] and _kind(r["sensor"]) == sensor]
    names, curves = [r["device"] for r in mine], [Curve.from_json(r["curve"]) for r in mine]
    part = part_of(names, curves)
    report = _report(found, mine, work, part)
    if part is not None:
        scales = scales_from_text(json.dumps(mine[0]["sensor"]), mine[0]["sessions"][0]["file"])
        first = {r["device"]: r["sessions"][0]["file"] for r in mine}
        run: Runner = partial(run_all, client)
        report["prior"] = {**prior_json(part), "benefit": None}
        if minutes is not None:
            longest = max(r["sessions"][0]["duration_s"] for r in mine) / 60
            minutes = min(minutes, round(longest, 1))
            tried = benefit(names, curves, first, scales, minutes, run)
            report["prior"]["benefit"] = tried
    with written_together(folder) as draft:
        pq.write_table(table_of(found, part), draft / "fleet.parquet", compression="zstd")
        (draft / "fleet.json").write_text(json.dumps(report, indent=1), encoding="utf-8")
        write_page(report, part, draft / "fleet.html")
        if part is not None:
            write_prior(part, scales, draft / "prior")
    return report


def _kind(sensor: dict[str, Any]) -> tuple[Any, ...]:
    names = ("sensor", "gyro_lsb_per_dps", "temp_lsb_per_degc", "temp_offset_degc")
    return tuple(sensor.get(name) for name in names)


def _report(
    found: Sequence[dict[str, Any]],
    mine: Sequence[dict[str, Any]],
    work: Job,
    part: Part | None,
) -> dict[str, Any]:
    names = {r["device"] for r in mine}
    others = [r["device"] for r in found if r["sensor"] and r["device"] not in names]
    sessions = [s for r in found for s in r["sessions"]]
    return {
        "job": work.kind,
        "sensor": mine[0]["sensor"]["sensor"] if mine else None,
        "devices": len(found),
        "devices_of_the_part": len(mine),
        "left_out_of_the_part": others,
        "sessions": len(sessions),
        "samples": sum(s["samples"] for s in sessions),
        "hours": sum(s["duration_s"] for s in sessions) / 3600,
        "reference_degc": part.reference_degc if part else None,
        "effects": curve_effects(part) if part else [],
        "steps": step_effects(mine) if work.kind == "close" else [],
        "prior": None,
        "worst": _worst(found),
        "failures": [{"device": r["device"], **f} for r in found for f in r["failures"]],
    }


def _worst(found: Sequence[dict[str, Any]]) -> list[dict[str, Any]]:
    """The devices on which the firmware was furthest off in some power-on, worst first."""
    rows = [
        {"device": r["device"], "session": s["name"], "error_mdps": s["error_mdps"]}
        for r in found
        for s in r["sessions"]
        if s["error_mdps"]
    ]
    return sorted(rows, key=lambda row: -max(row["error_mdps"]))[:_MOST_WORST]


class Parts:
    """The folder `parts` of a run: Parquet files with a device a row, as results come, so that
    a run cut off goes on where it stopped."""

    def __init__(self, out: Path) -> None:
        self.folder = out / "parts"
        self.folder.mkdir(parents=True, exist_ok=True)
        clear_left_over(self.folder)

    def add(self, results: Iterable[dict[str, Any]]) -> None:
        """Write the results of a batch: whole, or not at all."""
        rows = list(results)
        table = pa.table(
            {
                "device": [row["device"] for row in rows],
                "fingerprint": [row["fingerprint"] for row in rows],
                "whole": [not row["failures"] for row in rows],
                "result": [json.dumps(row) for row in rows],
            }
        )
        with written_beside(self.folder / f"{uuid.uuid4().hex}.parquet") as temporary:
            pq.write_table(table, temporary, compression="zstd")

    def whole(self) -> set[str]:
        """Fingerprints of the devices that were done without a failure."""
        done: set[str] = set()
        for path in self._files():
            table = pq.read_table(path, columns=["fingerprint", "whole"])
            pairs = zip(table["fingerprint"].to_pylist(), table["whole"].to_pylist())
            done.update(fingerprint for fingerprint, whole in pairs if whole)
        return done

    def results(self, fingerprints: dict[str, str]) -> Iterator[dict[str, Any]]:
        """Each device's latest result; fingerprints: device -> the one that counts."""
        latest: dict[str, str] = {}
        for path in self._files():
            table = pq.read_table(path, columns=["device", "fingerprint", "result"])
            for device, fingerprint, result in zip(*(c.to_pylist() for c in table.columns)):
                if fingerprints.get(device) == fingerprint:
                    latest[device] = result
        return (json.loads(latest[device]) for device in fingerprints if device in latest)

    def _files(self) -> list[Path]:
        found = filter(_is_whole, self.folder.glob("[!.]*.parquet"))
        return sorted(found, key=lambda path: path.stat().st_mtime_ns)


def _is_whole(part: Path) -> bool:
    """Whether it can be read; the devices of one that was damaged since are done again."""
    try:
        read_in_safety(part)
    except BadRecording:
        return False
    return True
