"""A reader of a foreign binary in a process of its own, with limits of memory and time.

Whatever a damaged file makes its parser do, it ends there: what comes back is rows, or one line.
"""

import json
import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pyarrow as pa

from ...bounds import ALONE, MEMORY_MB, how_it_ended, limit_myself, python_child
from ...errors import BadRecording, MissingLibrary
from ..samples.spool import PLACE
from ..tables.table import Chunk, Table
from . import arrays, flight_logs, json_file, ros_bag

_WORDS_BYTES = 65_536
_ABOUT, _READ = b"about", b"read"
_TOLD = ("names", "mapping", "sensor", "notes", "words", "said_hz")
#: Reader -> its function, and what it reads.
_READERS: dict[str, tuple[Callable[..., Table], str]] = {
    "ulog": (flight_logs.ulog, "ULog"),
    "dataflash": (flight_logs.dataflash, "DataFlash log"),
    "blackbox": (flight_logs.blackbox, "blackbox log"),
    "ros_bag": (ros_bag.read, "ROS bag"),
    "mcap_file": (ros_bag.mcap, "MCAP file"),
    "matlab": (arrays.matlab, ".mat file"),
    "hdf5": (arrays.hdf5, "HDF5 file"),
    "numpy_file": (arrays.numpy_file, "NumPy file"),
    "columnar": (arrays.columnar, "Parquet or Feather file"),
    "json_file": (json_file.read, "JSON"),
}
#: Of several sensors or flights in a log these take the one that is asked for.
_OF_SEVERAL = ("ulog", "dataflash", "blackbox")
_RUN = "from zerorate_tools.importers.logs.apart import main; main()"


@contextmanager
def table_apart(
    reader: str, path: Path, instance: int, advance: Callable[[float], None]
) -> Iterator[Table]:
    """The table that a reader makes of a file.

    reader: a name of `_READERS`; instance: which of several sensors; advance: takes bytes as they
    are read. Raises BadRecording, MissingLibrary.
    """
    child = subprocess.Popen(
        python_child(_RUN, reader, str(path), str(instance), str(os.getpid())),
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        env=os.environ | ALONE,
    )
    try:
        yield _Rows(child, path, advance).table
    finally:
        child.kill()
        child.wait()
        for pipe in (child.stdout, child.stderr):
            assert pipe is not None
            pipe.close()


class _Rows:
    """The stream of a child's rows; the first chunk can be had twice."""

    def __init__(
        self, child: subprocess.Popen[bytes], path: Path, advance: Callable[[float], None]
    ) -> None:
        self._child, self._path, self._advance = child, path, advance
        self._first: Chunk | None = None
        self._read = 0.0
        try:
            self._stream = pa.ipc.open_stream(child.stdout)
        except (pa.ArrowInvalid, OSError) as error:
            raise self._ended() from error
        about = json.loads(self._stream.schema.metadata[_ABOUT])
        about["calendar"] = frozenset(about["calendar"])
        self.table = Table(chunks=self._chunks, **about)
        self._rows = self._incoming()

    def _chunks(self, names: list[str]) -> Iterator[Chunk]:
        if self._first is None:
            self._first = next(self._rows, None)
        if self._first is not None:
            yield Chunk(self._first.place, {name: self._first.columns[name] for name in names})
        for chunk in self._rows:
            yield Chunk(chunk.place, {name: chunk.columns[name] for name in names})

    def _incoming(self) -> Iterator[Chunk]:
        while True:
            try:
                batch, extra = self._stream.read_next_batch_with_custom_metadata()
            except StopIteration:
                break
            except (pa.ArrowInvalid, OSError) as error:
                raise self._ended() from error
            columns = {n: batch.column(n).to_numpy() for n in batch.schema.names}
            read = float((extra or {}).get(_READ, self._read))
            self._advance(read - self._read)
            self._read = read
            place = columns.pop(PLACE).astype(int)
            yield Chunk(place, columns)
        words = self._words()
        if "problem" in words or self._child.wait():
            raise self._error(words)
        self.table.dropped.update(words["dropped"])
        self.table.notes += words["notes"]

    def _words(self) -> dict[str, Any]:
        assert self._child.stderr is not None
        try:
            return json.loads(self._child.stderr.read(_WORDS_BYTES))
        except ValueError:
            return {}

    def _ended(self) -> Exception:
        return self._error(self._words())

    def _error(self, words: dict[str, Any]) -> Exception:
        if "library" in words:
            return MissingLibrary(words["library"])
        problem, do = words.get("problem"), words.get("do", "copy the file again")
        if problem is None:
            problem, do = how_it_ended(self._child.wait())
        return BadRecording(self._path, problem, do=do)


def main() -> None:
    """In the child: the rows to standard output, then a line of words to standard error."""
    reader, path, instance, parent = sys.argv[1], Path(sys.argv[2]), *map(int, sys.argv[3:5])
    out, err = os.dup(1), os.dup(2)
    silent = os.open(os.devnull, os.O_WRONLY)
    os.dup2(silent, 1)
    os.dup2(silent, 2)
    limit_myself(_size(path))
    words = written(reader, path, instance, out)
    # a parent that is gone reads nothing
    if os.getppid() == parent or os.name == "nt":
        os.write(err, json.dumps(words).encode()[:_WORDS_BYTES])
    os._exit(1 if "problem" in words or "library" in words else 0)


def written(reader: str, path: Path, instance: int, out: int) -> dict[str, Any]:
    """Write the rows to a file descriptor, and return the words of what came of it."""
    read, kind = _READERS[reader]
    try:
        table = read(path, instance) if reader in _OF_SEVERAL else read(path)
        _write(table, out)
    except MemoryError:
        problem = f"needs more than {MEMORY_MB} MB to be read"
        return {"problem": problem, "do": "cut it into parts, or copy it again: it may be damaged"}
    except BadRecording as error:
        return {"problem": error.problem, "do": error.do}
    except ModuleNotFoundError as error:
        return {"library": (error.name or "").partition(".")[0]}
    except Exception as error:  # parsers raise whatever they stumble over
        text = str(error)
        what = " ".join((text if " " in text else f"{type(error).__name__} {text}").split())[:120]
        return {"problem": f"no {kind}, or damaged ({what})", "do": "copy the file again"}
    return {"dropped": table.dropped, "notes": table.notes}


def _write(table: Table, out: int) -> None:
    about = {key: getattr(table, key) for key in _TOLD}
    about["calendar"] = sorted(table.calendar)
    schema = pa.schema([(name, pa.float64()) for name in (PLACE, *table.names)])
    schema = schema.with_metadata({_ABOUT: json.dumps(about)})
    table.notes = []
    with os.fdopen(out, "wb") as pipe, pa.ipc.new_stream(pipe, schema) as writer:
        for chunk in table.chunks(table.names):
            columns = [chunk.place.astype(float), *(chunk.columns[n] for n in table.names)]
            arrays = [pa.array(values, pa.float64()) for values in columns]
            batch = pa.RecordBatch.from_arrays(arrays, schema=schema)
            writer.write_batch(batch, custom_metadata={_READ: str(table.read_bytes)})


def _size(path: Path) -> int:
    return sum(file.stat().st_size for file in (path, *path.rglob("*")) if file.is_file())
