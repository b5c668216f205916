"""Who runs the firmware over a recording: machine code, CPython, or a MicroPython."""

from __future__ import annotations

import shutil
import tempfile
from abc import ABC, abstractmethod
from array import array
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property, lru_cache
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from zerorate import Corrector

from zerorate_tools.layout import STATE

from ..errors import MissingRuntime, ZerorateError
from ..kernels.library import library, run_rows, say_once
from ..recordings.checks import GAP
from ..runtimes import Runtime, find
from .samples import Frames

_OTHERS = (
    *("motion.bin", "motion_settings.bin", "gravity.bin", "gravity_settings.bin", "effects.bin"),
)
_OUTPUT = np.dtype([("verdict", "<i4"), ("bias", "<i4", 3), ("source", "<i4", 3), ("q", "<i4", 3)])


@dataclass(frozen=True)
class Outcome:
    """What the firmware made of a batch, each (n, 3) but `verdict` (n,): see guard.py, bias.py.

    bias_q8: what is subtracted from the sample, LSB in Q8; quality_q8: one sigma, LSB in Q8.
    """

    t_us: NDArray[np.int64]
    frames: NDArray[np.int32]
    bias_q8: NDArray[np.int32]
    source: NDArray[np.int8]
    quality_q8: NDArray[np.int32]
    verdict: NDArray[np.int8]

    @cached_property
    def least_source(self) -> NDArray[np.int8]:
        """(n,) the least trusted of the three axes' sources."""
        return np.minimum(np.minimum(self.source[:, 0], self.source[:, 1]), self.source[:, 2])


def others_of(corrector: Corrector) -> tuple[array[int] | None, ...]:
    """The arrays of the sources and the model that are on, None for each that is not."""
    effects = corrector.effects.e if corrector.effects is not None else None
    return (
        *(corrector.motion, corrector.motion_settings),
        *(corrector.gravity, corrector.gravity_settings, effects),
    )


class Engine(ABC):
    """Runs batches of frames from `corrector`'s state on, which it leaves as the firmware did.

    way: how the kernels run, in words.
    """

    way: str

    @abstractmethod
    def run(self, corrector: Corrector, batches: Iterable[Frames]) -> Iterator[Outcome]:
        """Yield an Outcome for each batch; the corrector's state is final when it is exhausted."""


def engine(name: str) -> Engine:
    """The engine of that name: native, cpython, wasm, x86, armhf, or a MicroPython executable.

    Native is CPython's where there is no compiler. Raises MissingRuntime.
    """
    if name == "cpython" or name == "native" and not compiled():
        return CPythonEngine()
    return NativeEngine() if name == "native" else InterpreterEngine(find(name))


class NativeEngine(Engine):
    """The kernels compiled from their C, in this process: where they are `compiled`."""

    way = "as compiled C"

    def run(self, corrector: Corrector, batches: Iterable[Frames]) -> Iterator[Outcome]:
        arrays = _arrays(corrector)
        for batch in batches:
            found = run_rows(arrays, batch.frames, batch.dt_us, batch.extra)
            yield Outcome(batch.t_us, batch.frames, *found)

    @staticmethod
    def run_partly(
        corrector: Corrector, batch: Frames, learn: NDArray[np.bool_], frozen: array[int]
    ) -> Outcome:
        """One batch, by other settings, `frozen`, at the samples where learn, (n,), is not."""
        others, where = np.array(frozen, np.int32), np.ascontiguousarray(learn, np.int8)
        rows = batch.frames, batch.dt_us, batch.extra
        found = run_rows(_arrays(corrector), *rows, others, where)
        return Outcome(batch.t_us, batch.frames, *found)


def _arrays(corrector: Corrector) -> tuple[NDArray[np.int32] | None, ...]:
    others = [None if words is None else _view(words) for words in others_of(corrector)]
    return _view(corrector.state), np.array(corrector.settings, np.int32), *others


@lru_cache(maxsize=1)
def compiled() -> bool:
    """Whether the kernels run compiled in this process; where they do not it is said, once."""
    try:
        library()
    except MissingRuntime as missing:
        say_once(f"{missing}; the replay runs on plain CPython")
        return False
    return True


def _view(words: array[int]) -> NDArray[np.int32]:
    return np.frombuffer(words, np.int32)


class CPythonEngine(Engine):
    """The firmware as it stands, in this process."""

    way = "as plain Python"

    def run(self, corrector: Corrector, batches: Iterable[Frames]) -> Iterator[Outcome]:
        for batch in batches:
            rows = np.empty(len(batch), _OUTPUT)
            for i in range(len(batch)):
                frame = array("i", batch.frames[i].tolist())
                for k, value in enumerate(batch.extra[i].tolist()):
                    if value != GAP:
                        corrector.effects.channel(k, value)
                rows[i] = self._one(corrector, frame, int(batch.dt_us[i]))
                batch.frames[i] = frame
            yield _outcome(batch, rows)

    @staticmethod
    def _one(corrector: Corrector, frame: array[int], dt_us: int) -> tuple[Any, ...]:
        verdict = corrector.update(frame, dt_us)
        s = corrector.state
        first = STATE.OUT_Q8, STATE.EFFECT_Q8, STATE.SOURCE, STATE.QUALITY_Q8
        out, effect, source, quality = (s[at : at + 3] for at in first)
        return verdict, [a + b for a, b in zip(out, effect)], source, quality


class InterpreterEngine(Engine):
    """The firmware on a MicroPython of its own; the recording goes in and out through files."""

    def __init__(self, runtime: Runtime) -> None:
        self._runtime = runtime
        self.way = f"in MicroPython: {runtime.name}"

    def run(self, corrector: Corrector, batches: Iterable[Frames]) -> Iterator[Outcome]:
        with tempfile.TemporaryDirectory(prefix="zerorate-replay-") as scratch:
            kept, recording = [], Path(scratch) / "frames.bin"
            with recording.open("wb") as file:
                for batch in batches:
                    kept.append(batch)
                    rows = np.c_[batch.dt_us, batch.frames, batch.extra]
                    file.write(rows.astype("<i4").tobytes())
            result = self._runtime.run(
                Path(__file__).with_name("on_interpreter.py"),
                [kept[0].extra.shape[1] if kept else 0],
                modules=[staged_packages(Path(scratch), ("zerorate",))],
                files_in={
                    "frames.bin": recording,
                    "settings.bin": corrector.settings.tobytes(),
                    "state.bin": corrector.state.tobytes(),
                    **{
                        name: (words or array("i")).tobytes()
                        for name, words in zip(_OTHERS, others_of(corrector))
                    },
                },
                files_out=["state.bin", "out.bin", *_OTHERS],
                check=True,
            )
        yield from self._outcomes(corrector, kept, result.files)

    def _outcomes(
        self, corrector: Corrector, kept: list[Frames], files: dict[str, bytes]
    ) -> Iterator[Outcome]:
        rows = np.frombuffer(files["out.bin"], np.dtype([("o", _OUTPUT), ("x", "<i4", 7)]))
        if len(rows) != sum(map(len, kept)):
            raise ZerorateError(f"{self._runtime.name} lost samples of the replay")
        corrector.state[:] = array("i", files["state.bin"])
        for name, words in zip(_OTHERS, others_of(corrector)):
            if words is not None:
                words[:] = array("i", files[name])
        start = 0
        for batch in kept:
            part = rows[start : start + len(batch)]
            batch.frames[:] = part["x"]
            start += len(batch)
            yield _outcome(batch, part["o"])


def _outcome(batch: Frames, rows: NDArray[Any]) -> Outcome:
    source, verdict = rows["source"].astype(np.int8), rows["verdict"].astype(np.int8)
    return Outcome(batch.t_us, batch.frames, rows["bias"], source, rows["q"], verdict)


def staged_packages(folder: Path, names: tuple[str, ...]) -> Path:
    """Copy installed packages into `folder`/board, which a MicroPython then has on its path."""
    for name in names:
        spec = find_spec(name)
        if spec is None or spec.origin is None:
            raise ZerorateError(f"the package {name} is not installed beside zerorate_tools")
        ignored = shutil.ignore_patterns("__pycache__")
        shutil.copytree(Path(spec.origin).parent, folder / "board" / name, ignore=ignored)
    return folder / "board"
