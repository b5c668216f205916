"""`replay`: a recording through the firmware, on any interpreter, in bounded memory."""

from __future__ import annotations

from array import array
from collections.abc import Callable, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, field
from inspect import signature
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pyarrow as pa
from zerorate import Corrector
from zerorate.settings import DEFAULTS

from zerorate_tools import layout
from zerorate_tools.layout import AXIS, GRAVITY, MOTION, SETTINGS, STATE, Array, axis_at

from ..errors import BadModel, InFile, ZerorateError
from ..recordings import Recording, open_recording
from ..recordings.atomic import all_written_beside, check_apart
from ..recordings.reading import OpenRecording
from .bias_table import SOURCES, VERDICTS, ReplayWriter, table
from .engines import Outcome, engine, others_of
from .samples import frames_in_batches, sensor_of

if TYPE_CHECKING:
    import pandas


#: Options that leave out the sources which learn in motion.
AT_REST_ALONE: dict[str, object] = {"motion": False, "gravity": False}
_END = 2**30
_LAST_PIECE = 12  # of the work that a window leaves: four an axis


@dataclass
class Replay:
    """What a replay did.

    state: the final state's bytes (int32, little-endian); verdicts, sources: samples of each kind;
    explanation: the firmware's own words at the end; table: a row a sample, as design.md has it,
    unless it went to a file.
    """

    samples: int = 0
    state: bytes = b""
    verdicts: dict[str, int] = field(default_factory=dict)
    sources: dict[str, int] = field(default_factory=dict)
    explanation: str = ""
    table: pa.Table | None = None

    def to_frame(self) -> pandas.DataFrame:
        """The table, a row a sample: t_us, source, verdict; bias_g?, quality_g? and more in LSB.

        Raises ValueError if it went to a file.
        """
        if self.table is None:
            raise ValueError("the table went to a file: pandas.read_parquet reads it")
        return self.table.to_pandas()

    def count(self, outcome: Outcome) -> None:
        """Add a batch to the counts."""
        self.samples += len(outcome.t_us)
        _count(self.verdicts, VERDICTS, outcome.verdict)
        _count(self.sources, SOURCES, outcome.least_source)


def replay(
    log: str | PathLike[str] | Recording,
    out: str | PathLike[str] | None = None,
    *,
    runtime: str = "native",
    state: str | PathLike[str] | None = None,
    from_state: str | PathLike[str] | None = None,
    resume: bool = False,
    model: str | PathLike[str] | None = None,
    options: dict[str, object] | None = None,
    advance: Callable[[float], None] = lambda n: None,
) -> Replay:
    """Run the firmware over `log` and return what it did.

    log: a recording or its path; out: the Parquet to write, None for a table in memory;
    runtime: native, cpython, wasm, x86, armhf or the path of a MicroPython; state: file for the
    final state's bytes; from_state: file to start from, as a new power-on, or, with resume, as if
    the two recordings were one; model: effect model (model.bin or model.json);
    options: keywords of zerorate.Corrector; advance: called with the
    number of samples done. Raises ZerorateError (BadRecording, MissingRuntime, ...).
    """
    if out is not None and Path(out).suffix != ".parquet":
        raise InFile(out, "a replay is written as Parquet", do="end the name in .parquet")
    check_apart([out, state], [None if isinstance(log, Recording) else log, model])
    check_apart([out], [from_state])
    recording = log if isinstance(log, Recording) else open_recording(log, keep_gaps=True)
    corrector = corrector_for(recording, options or {})
    channels = load_model(corrector, Path(model), recording) if model is not None else ()
    if from_state is not None:
        load_state(corrector, Path(from_state), resume)
    batches = frames_in_batches(recording, channels=channels)
    runner = engine(runtime)
    outcomes = runner.run(corrector, batches)
    done = Replay()
    wanted = [path for path in (out, state) if path is not None]
    with ExitStack() as files:
        drafts = dict(zip(wanted, files.enter_context(all_written_beside(wanted))))
        sink = _sink(done, None if out is None else drafts[out], files)
        for outcome in outcomes:
            done.count(outcome)
            sink(outcome)
            advance(len(outcome.t_us))
        done.state = state_bytes(corrector)
        if state is not None:
            drafts[state].write_bytes(done.state)
    done.explanation = f"{corrector.explain()}\nThe kernels ran {runner.way}."
    return done


def corrector_for(recording: OpenRecording | Recording, options: dict[str, object]) -> Corrector:
    """The firmware's object for a recording's sensor. Raises ZerorateError for bad options."""
    known = {*signature(Corrector).parameters, *DEFAULTS} - {"sensor", "limits"}
    unknown = next((name for name in options if name not in known), None)
    if unknown is not None:
        raise ZerorateError(f"no such setting: {unknown}; there are {', '.join(sorted(known))}")
    try:
        return Corrector(sensor_of(recording.scales), **options)
    except (TypeError, ValueError) as error:
        raise ZerorateError(f"{recording.name}: {error}") from error


def load_state(corrector: Corrector, path: Path, resume: bool) -> None:
    """Put a state file into the corrector. Raises InFile."""
    try:
        content = path.read_bytes()
    except OSError as error:
        raise InFile(path, str(error.strerror), do="name a file that --state wrote") from error
    wanted = len(state_bytes(corrector))
    if len(content) != wanted:
        problem = f"{len(content)} bytes where a state with these settings has {wanted}"
        raise InFile(path, problem, do="use the settings it was written with")
    words = array("i", np.frombuffer(content, "<i4").tolist())
    for part in _parts(corrector):
        part[:] = words[: len(part)]
        words = words[len(part) :]
    if not can_be_a_state(corrector):
        raise InFile(path, "damaged, or no state at all", do="name a file that --state wrote")
    if not resume:
        corrector.power_on()


def state_bytes(corrector: Corrector) -> bytes:
    """The state of the estimators, then those of the other sources and the model that are on."""
    return np.concatenate(_parts(corrector)).astype("<i4").tobytes()


def _parts(corrector: Corrector) -> list[array]:
    motion, _, gravity, _, effects = others_of(corrector)
    return [part for part in (corrector.state, motion, gravity, effects) if part is not None]


def load_model(corrector: Corrector, path: Path, recording) -> tuple[str, ...]:
    """Give the corrector an effect model; returns the extra channels it follows.

    Raises BadModel where it is refused, or follows a channel that the recording lacks.
    """
    from zerorate.effects.model_file import LOADED, REASONS
    from zerorate.model import EffectModel

    from ..model import encoded, read_model

    effects = EffectModel()
    reason = effects.load(encoded(read_model(path)), corrector.sensor)
    if reason != LOADED:
        raise BadModel(path, f"the firmware refuses it: {REASONS[reason]}")
    names = recording.column_names if isinstance(recording, OpenRecording) else recording.columns
    absent = [name for name in effects.channels if name not in names]
    if absent:
        problem = f"it follows the channel {absent[0]}, which {recording.name} lacks"
        raise BadModel(path, problem, do="record that channel")
    corrector.use_model(effects)
    return tuple(effects.channels)


def _sink(done: Replay, out: Path | None, files: ExitStack) -> Callable[[Outcome], None]:
    if out is not None:
        writer = ReplayWriter(out)
        files.callback(writer.close)
        return writer.write
    parts: list[pa.Table] = []

    def keep(outcome: Outcome) -> None:
        parts.append(table(outcome))

    files.callback(lambda: setattr(done, "table", pa.concat_tables(parts) if parts else None))
    return keep


def _count(counts: dict[str, int], names: tuple[str, ...], codes: np.ndarray) -> None:
    for code, number in enumerate(np.bincount(codes.astype(np.int64), minlength=len(names))):
        if number:
            counts[names[code]] = counts.get(names[code], 0) + int(number)


def can_be_a_state(corrector: Corrector) -> bool:
    """Whether each word fits 31 bits, and those that say which or where say one that there is: the
    kernels go where they say, unasked."""
    state, settings = corrector.state, corrector.settings
    parts = [(state, STATE), (corrector.motion, MOTION), (corrector.gravity, GRAVITY)]
    axes = [axis_at(settings, axis) for axis in range(3)]
    there = [(words, array) for words, array in parts if words is not None]
    return (
        all(-_END <= word < _END for words, _ in there for word in words)
        and 0 <= state[STATE.WORK] <= _LAST_PIECE
        and all(_codes_hold(words, array, 0) for words, array in there)
        and all(_codes_hold(state, AXIS, at) for at in axes)
        and all(_estimators_hold(state, settings, at) for at in axes)
    )


def _codes_hold(words: Sequence[int], array: Array, at: int) -> bool:
    """Whether each code and each shift of an array, or of a block of it at `at`, is one."""
    for word in array.words:
        kind, _, name = word.unit.partition(" ")
        known = range(31) if kind == "bits" else None
        known = getattr(layout, name).numbers.values() if kind == "code" else known
        if known is not None and not word.while_text:
            first = at + word.index
            if any(code not in known for code in words[first : first + word.count]):
                return False
    return True


def _estimators_hold(state: Sequence[int], settings: Sequence[int], at: int) -> bool:
    """Whether the estimator in use and the order of the short-term ones are of this axis."""
    size = settings[SETTINGS.ESTIMATOR_WORDS]
    short = range(at + settings[SETTINGS.FIRST_SHORT], at + settings[SETTINGS.FIRST_LONG], size)
    order = at + AXIS.ORDER
    in_use = range(short.start, at + settings[SETTINGS.ESTIMATORS_END], size)
    return sorted(state[order : order + len(short)]) == list(short) and state[
        at + AXIS.CURRENT
    ] in (0, *in_use)
