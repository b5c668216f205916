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
from zerorate.effects.model_file import LOADED, REASONS
from zerorate.model import EffectModel
from zerorate.settings import DEFAULTS
from zerorate.storage.soundness import is_sound

from zerorate_tools import layout

from ..bounds import bytes_of
from ..errors import BadModel, InFile, ZerorateError
from ..model import encoded, read_model
from ..model.files import sensor_for
from ..recordings import Recording, open_recording
from ..recordings.atomic import all_written_beside, check_apart
from ..recordings.csv_format import scales_path
from ..recordings.parquet_format import TableWriter
from ..recordings.reading import OpenRecording
from .engines import Outcome, engine, others_of
from .samples import frames_in_batches

SOURCES = ("none", "any-temperature", "fit", "this-temperature", "in-motion", "gravity")
VERDICTS = (
    *("good", "repeat", "rail", "all-zero", "all-ones", "temperature-jump", "time-stood-still"),
    "time-leapt",
)
_AXES = "xyz"


def table(outcome: Outcome) -> pa.Table:
    """One batch as a table.

    `source` is the least trusted of the three axes' and `quality_lsb` the worst; `quality_g?` are
    each axis' own.
    """
    columns: dict[str, pa.Array] = {"t_us": pa.array(outcome.t_us)}
    for i, axis in enumerate(_AXES):
        columns[f"bias_g{axis}"] = pa.array(outcome.bias_q8[:, i] / 256.0)
    columns["source"] = _named(outcome.least_source, SOURCES)
    quality = [outcome.quality_q8[:, i] / np.float32(256.0) for i in range(3)]
    columns["quality_lsb"] = pa.array(np.maximum(np.maximum(*quality[:2]), quality[2]))
    for axis, values in zip(_AXES, quality):
        columns[f"quality_g{axis}"] = pa.array(values)
    columns["verdict"] = _named(outcome.verdict, VERDICTS)
    return pa.table(columns)


def _named(codes: np.ndarray, names: tuple[str, ...]) -> pa.Array:
    return pa.DictionaryArray.from_arrays(codes.astype(np.int8), list(names))


class ReplayWriter(TableWriter):
    def __init__(self, path: Path) -> None:
        # time never returns, and what was learned stays for long: no dictionary of those
        super().__init__(
            path,
            use_dictionary=["source", "verdict"],
            column_encoding={"t_us": "DELTA_BINARY_PACKED"},
            write_statistics=["t_us"],
        )

    def write(self, outcome: Outcome) -> None:
        self.append(table(outcome))


if TYPE_CHECKING:
    import pandas


#: Options that leave out the sources which learn in motion.
AT_REST_ALONE: dict[str, object] = {"motion": False, "gravity": False}


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
    given = [] if isinstance(log, Recording) else [log, scales_path(Path(log))]
    check_apart([out, state], [*given, model])
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
        return Corrector(sensor_for(recording.scales), **options)
    except (TypeError, ValueError) as error:
        raise ZerorateError(f"{recording.name}: {error}") from error


def load_state(corrector: Corrector, path: Path, resume: bool) -> None:
    """Put a state file into the corrector. Raises InFile."""
    content = bytes_of(path, "name a file that --state wrote")
    wanted = len(state_bytes(corrector))
    if len(content) != wanted:
        problem = f"{len(content)} bytes where a state with these settings has {wanted}"
        raise InFile(path, problem, do="use the settings it was written with")
    words = array("i", np.frombuffer(content, "<i4").tolist())
    for part in _parts(corrector):
        if corrector.effects is None or part is not corrector.effects.e:
            part[:] = words[: len(part)]
        elif not _is_same_model(part, words):
            raise InFile(path, "of another effect model", do="name the model it was written with")
        elif resume:
            part[:] = words[: len(part)]
        words = words[len(part) :]
    if not can_be_a_state(corrector):
        raise InFile(path, "damaged, or no state at all", do="name a file that --state wrote")
    if not resume:
        corrector.power_on()


def _is_same_model(e: array[int], words: array[int]) -> bool:
    """Whether the words that a model left are those of effect model `e`."""
    first = layout.EFFECTS
    counts = (first.SLOT_COUNT, first.INPUT_COUNT, first.TICK_US, first.SLOTS_A_SAMPLE)
    given = {*counts, first.INSTANT_SLOTS, first.PLAY_COUNT, *range(first.TABLES, first.RINGS)}
    for at, block, end, most in (
        (first.INPUTS, layout.INPUT, layout.INPUT.INPUT_SUM, layout.LIMITS.MOST_INPUTS),
        (first.SLOTS, layout.SLOT, layout.SLOT.SLOT_STARTED, layout.LIMITS.MOST_SLOTS),
        (first.PLAYS, layout.PLAY, layout.PLAY.PLAY_STARTED, layout.LIMITS.MOST_PLAYS),
    ):
        given.update(at + i * block.size + k for i in range(most) for k in range(end))
    left = words[: len(e)]
    slots = e[first.SLOT_COUNT] + e[first.PLAY_COUNT]
    own = all(e[i] == left[i] for i in given)
    return own and 0 <= left[first.NEXT_SLOT] < max(1, slots)


def state_bytes(corrector: Corrector) -> bytes:
    """The state of the estimators, then those of the other sources and the model that are on."""
    return np.concatenate(_parts(corrector)).astype("<i4").tobytes()


def _parts(corrector: Corrector) -> list[array[int]]:
    motion, _, gravity, _, effects = others_of(corrector)
    return [part for part in (corrector.state, motion, gravity, effects) if part is not None]


def load_model(
    corrector: Corrector, path: Path, recording: OpenRecording | Recording
) -> tuple[str, ...]:
    """Give the corrector an effect model; returns the extra channels it follows.

    Raises BadModel where it is refused, or follows a channel that the recording lacks.
    """
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
    """Whether the words of every source are such as can be: the kernels go where they say, unasked.

    In the layout's ranges, each code one that there is, each node one of the ring.
    """
    state, motion, gravity = corrector.state, corrector.motion, corrector.gravity
    return (
        is_sound(state, corrector.settings)
        and _words_hold(state, layout.STATE)
        and (gravity is None or _words_hold(gravity, layout.GRAVITY))
        and (motion is None or _words_hold(motion, layout.MOTION) and _nodes_hold(corrector))
    )


def _words_hold(words: Sequence[int], array: layout.Array) -> bool:
    for word in (word for word in array.words if not word.while_text):
        kind, _, name = word.unit.partition(" ")
        codes = set(getattr(layout, name).numbers.values()) if kind == "code" else None
        end = len(words) if isinstance(word.count, str) else word.index + word.count
        for value in words[word.index : end]:
            if not word.least <= value <= word.most or codes and value not in codes:
                return False
    return True


def _nodes_hold(corrector: Corrector) -> bool:
    words, nodes = corrector.motion, corrector.motion_settings[layout.MOTION_SETTINGS.NODES]
    at = [word.index for word in layout.MOTION.words if word.unit == "node"]
    return all(0 <= words[i] < nodes for i in at) and words[layout.MOTION.FILLED] <= nodes
