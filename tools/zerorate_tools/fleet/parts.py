"""Results as they come, a file a batch, so that a run cut off goes on where it stopped."""

import json
import uuid
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq

from ..recordings.atomic import clear_left_over, written_beside


class Parts:
    """The folder `parts` of a run: Parquet files with a device a row."""

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
        return sorted(self.folder.glob("[!.]*.parquet"), key=lambda path: path.stat().st_mtime_ns)
