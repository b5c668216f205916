"""Simulated recordings on disk, the truth in a file of its own."""

import json
from collections.abc import Callable
from os import PathLike
from pathlib import Path

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq

from ..recordings import check_output, write_recording
from ..recordings.atomic import all_written_together, check_apart, written_beside
from ..recordings.recording import ATTITUDE
from .description import load_description
from .device import Truth, simulate, simulate_sessions
from .schema import Description, Table


def simulate_to_files(
    description: str | PathLike[str] | Table | Description,
    out: str | PathLike[str],
    *,
    truth: str | PathLike[str] | None = None,
    session: int | None = None,
    seed: int | None = None,
    done: Callable[[float], None] = lambda sessions: None,
) -> list[Path]:
    """Write the recording of each session, or of one; return the files' names.

    Several sessions become out-1.parquet, out-2.parquet, ...; the truth is only written where
    `truth` names a Parquet file for it, numbered likewise. All files take their places together
    at the end, or none does. done(1) is called after each session.
    Raises BadDescription, InFile.
    """
    described = load_description(description)
    check_output(out)
    check_apart([out, truth], [])
    many = session is None and len(described.sessions) > 1
    if session is None:
        made = simulate_sessions(described, seed=seed)
    else:
        made = iter([simulate(described, session=session, seed=seed)])
    files = []
    places = [Path(path) for path in (out, truth) if path is not None]
    folders = list(dict.fromkeys(path.parent for path in places))
    with all_written_together(folders) as drafts:
        draft_of = dict(zip(folders, drafts))
        for number, (recording, behind) in enumerate(made, start=1):
            names = [_numbered(path, number) if many else path for path in places]
            files.append(names[0])
            write_recording(recording, draft_of[names[0].parent] / names[0].name)
            if truth is not None:
                write_truth(behind, draft_of[names[1].parent] / names[1].name)
            done(1)
    return files


def _numbered(path: Path, number: int) -> Path:
    stem, dot, suffixes = path.name.partition(".")
    return path.with_name(f"{stem}-{number}{dot}{suffixes}")


def write_truth(truth: Truth, path: str | PathLike[str]) -> None:
    """Write a truth as Parquet: t_us, bias_g?_lsb, still, qw..qz, rate_g?_dps, temp_degc."""
    columns = {"t_us": truth.t_us, "still": truth.still, "temp_degc": truth.temp_degc}
    for i, axis in enumerate("xyz"):
        columns[f"bias_g{axis}_lsb"] = truth.bias_lsb[:, i]
        columns[f"rate_g{axis}_dps"] = truth.rate_dps[:, i]
    columns |= {name: truth.attitude[:, i] for i, name in enumerate(ATTITUDE)}
    effects = json.dumps([list(per_unit) for per_unit in truth.effects_dps]).encode()
    table = pa.table(columns).replace_schema_metadata({b"zerorate-truth": effects})
    with written_beside(path) as temporary:
        pq.write_table(table, temporary)


def read_truth(path: str | PathLike[str]) -> Truth:
    table = pq.read_table(path)

    def stacked(*names: str) -> np.ndarray:
        return np.stack([table[name].to_numpy() for name in names], axis=1)

    effects = json.loads(table.schema.metadata[b"zerorate-truth"])
    return Truth(
        **{name: table[name].to_numpy() for name in ("t_us", "still", "temp_degc")},
        bias_lsb=stacked(*(f"bias_g{axis}_lsb" for axis in "xyz")),
        rate_dps=stacked(*(f"rate_g{axis}_dps" for axis in "xyz")),
        attitude=stacked(*ATTITUDE),
        effects_dps=[np.array(per_unit) for per_unit in effects],
    )
