"""From an analysis to what the firmware's kernels make of it."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from os import PathLike
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pyarrow as pa
from threadpoolctl import threadpool_limits

from ...model import CannotDeploy, Model, Slot
from ...model.term import Terms, evaluate
from ...recordings import Scales, open_recording
from ...recordings.atomic import written_beside
from ...recordings.parquet_format import TableWriter
from ...recordings.reading import recording_name
from ...replay.samples import Frames
from ..motion.scales_and_timing import slots_of
from ..read.gate import GateReport
from ..read.ticks import has_one_sample
from ..search.selection import Selection
from .analysis import Analysis, deployable, model_of, with_selection
from .by_kernels import PiecesByKernels
from .courses import (
    AFTER,
    BEFORE,
    ONLINE,
    Course,
    Courses,
    PieceRuns,
    SessionRuns,
    Sink,
)
from .firmware import Firmware, Refused
from .judge import Judgement, rms_dps
from .power_on import BlockMeans, PowerOn, ideal_dps
from .prune_by_holdout import without_harmful, without_unshown

_AXES = ("gx", "gy", "gz")
WAYS = ("before", "after", "online")


def run_kernels(
    analysis: Analysis,
    logs: Sequence[str | PathLike[str]],
    model: Model,
    out: str | PathLike[str],
    online: bool,
    advance: Callable[[float], None] = lambda n: None,
) -> Analysis:
    """The analysis judged by the firmware's own kernels; corrected.parquet is written to `out`.

    logs: the recordings; online: write what the learning firmware subtracts, too; advance: called
    for each session. Raises Refused, BadRecording.
    """
    scales = open_recording(logs[0]).scales
    power_ons = power_ons_of(analysis, logs, model, scales)
    holdout = [s.name for s in analysis.holdout]
    course = _course_of(analysis, power_ons, model, scales)
    courses: dict[str, Course] = {}
    with written_beside(out) as temporary:
        writer = CorrectedWriter(temporary)
        for p in power_ons:
            left_out = analysis.few or p.session.name in holdout
            sink = _sink(writer, p, left_out, online)
            courses[p.session.name] = course(p.session.name, online, sink)
            advance(1)
        writer.close()
    rounding, inside = _rounding(analysis, power_ons, scales), _inside(analysis)
    return judged(analysis, Courses(courses, holdout, rounding, inside=inside))


def _inside(analysis: Analysis) -> list[str]:
    """Names of the sessions fitted of which pieces are left out, too: where so few were fitted that
    leaving them out whole tells little."""
    return [s.name for s in analysis.train] if analysis.few and not analysis.single else []


def _course_of(
    analysis: Analysis, power_ons: list[PowerOn], model: Model, scales: Scales
) -> Callable[[str, bool, Sink], Course]:
    """What runs the firmware over a session by name."""
    if analysis.single:
        alone = _by_pieces(analysis, power_ons[0], scales)
        return lambda name, online, sink: alone.course(sink)
    train, holdout = ([s.name for s in some] for some in (analysis.train, analysis.holdout))
    models = models_of(analysis, model, scales)
    some = [p for p in power_ons if p.session.name in _inside(analysis)]
    inside = {p.session.name: _by_pieces(analysis, p, scales) for p in some}
    measurement = SessionRuns(power_ons, train, holdout, models, scales, inside)
    measurement.learn()
    return measurement.course


def _by_pieces(analysis: Analysis, power_on: PowerOn, scales: Scales) -> PieceRuns:
    beside = [s for s in analysis.train if s.name != power_on.session.name]
    pieces = PiecesByKernels(power_on, scales, beside)
    return PieceRuns(pieces, analysis.selection, slots_of(analysis.motion))


@threadpool_limits.wrap(limits=1, user_api="blas")
def run_and_prune(
    analysis: Analysis,
    logs: Sequence[str | PathLike[str]],
    out: str | PathLike[str],
    online: bool = False,
    advance: Callable[[float], None] = lambda n: None,
) -> tuple[Analysis, Model]:
    """(analysis, model) without the effects that raise the kernels' error.

    As `run_kernels`, repeated until no effect raises the error of what was held out, or of pieces
    left out of what was fitted.
    """
    scales = open_recording(logs[0]).scales
    while True:
        analysis = deployable(analysis, scales)
        model = model_of(analysis, scales)
        try:
            measured = run_kernels(analysis, logs, model, out, online, advance)
            assert measured.measured is not None, "it was just measured"
            less = _without_harmful(
                analysis.selection, measured.measured, partial(_measured, analysis, logs, scales)
            )
        except (CannotDeploy, Refused) as problem:  # fitted to a part, an effect may be too large
            if not analysis.selection.found:
                raise
            analysis.gate.notes.append(f"found but left out: {problem}")
            last = len(analysis.selection.found) - 1
            analysis = with_selection(analysis, analysis.selection.without(last))
            continue
        if less is analysis.selection:
            return measured, model
        analysis = with_selection(analysis, less)


def _measured(
    analysis: Analysis, logs: Sequence[str | PathLike[str]], scales: Scales, selection: Selection
) -> Courses:
    """What the kernels make of other effects than those of the analysis."""
    trial = replace(analysis, gate=GateReport())  # what it notes is not of what is deployed
    other = deployable(with_selection(trial, selection), scales)
    with TemporaryDirectory() as scratch:
        out = Path(scratch) / "corrected.parquet"
        measured = run_kernels(other, logs, model_of(other, scales), out, online=False).measured
    assert measured is not None, "it was just measured"
    return measured


def _without_harmful(
    selection: Selection, measured: Courses, again: Callable[[Selection], Courses]
) -> Selection:
    """The selection without what the held-out sessions, or then the pieces, do worse with, or what
    pieces do no better with than by chance.

    again: measures another selection.
    """
    number = len(selection.found)
    for names in (measured.holdout, *([measured.inside] if measured.inside else [])):
        after = [measured.with_first(k, names) for k in range(number + 1)]

        def without(i: int, names: Sequence[str] = names) -> list[np.ndarray]:
            return again(selection.without(i)).with_first(number - 1, names)

        less = without_harmful(selection, after, without)
        pieces = [measured.sessions[name].pieces for name in names]
        if less is selection and all(map(len, pieces)):
            less = without_unshown(selection, after, without, pieces)
        if less is not selection:
            return less
    return selection


def _sink(writer: "CorrectedWriter", p: PowerOn, test: bool, online: bool) -> Sink:
    def write(name: str, frames: Frames, biases: dict[str, np.ndarray]) -> None:
        if not online:
            biases = {way: b for way, b in biases.items() if way != ONLINE}
        writer.write(Path(p.path).name, frames, np.full(len(frames), test), biases)

    return write


def power_ons_of(
    analysis: Analysis, logs: Sequence[str | PathLike[str]], model: Model, scales: Scales
) -> list[PowerOn]:
    """The sessions that were used, in the order of their recordings."""
    paths = {recording_name(Path(log)): log for log in logs}
    held = {s.name: s for s in analysis.holdout}
    return [
        PowerOn(
            s,
            paths[s.name],
            scales.gyro_lsb_per_dps,
            ideal_dps(s, analysis.motion),
            held.get(s.name, s).available,
            model.channels,
        )
        for s in analysis.sessions
    ]


def models_of(analysis: Analysis, model: Model, scales: Scales) -> list[Model | None]:
    """None, the models of the first effects alone, and at last the whole one."""
    found = analysis.selection.found
    some = [model_of(analysis, scales, effects=k) for k in range(1, len(found))]
    whole = [model] if model.slots else []
    if analysis.motion.scales is not None and found:
        some.append(model_of(analysis, scales, effects=len(found)))
    return [None, *some, *whole]


def _rounding(analysis: Analysis, power_ons: list[PowerOn], scales: Scales) -> np.ndarray:
    if not analysis.selection.found:
        return np.zeros(3)
    terms = analysis.selection.terms
    coefficients = analysis.coefficients[len(analysis.selection.straight) :]
    holdout = {p.session.name: p for p in power_ons}[analysis.holdout[0].name]
    at_rest = model_of(analysis, scales, effects=len(analysis.selection.found))
    return rounding_dps(holdout, at_rest, terms, coefficients, scales)


def judged(analysis: Analysis, measured: Courses) -> Analysis:
    """The analysis with the kernels' residuals in the place of the float reference's."""
    before, after = measured.residuals(BEFORE), measured.residuals(AFTER)
    j: Judgement = analysis.judgement
    j = replace(
        j,
        before_dps=rms_dps(before),
        after_dps=rms_dps(after),
        residual_before=before,
        residual_after=after,
    )
    return replace(analysis, judgement=j, measured=measured)


class CorrectedWriter(TableWriter):
    """Writes corrected.parquet, one for all recordings, piece by piece as the kernels give it."""

    def write(
        self, recording: str, frames: Frames, test: np.ndarray, biases: Mapping[str, np.ndarray]
    ) -> None:
        """Append samples of a recording (its file's name).

        test: (n,) bool, of the part held out; biases: (n, 3) LSB in Q8 by way, of which those in
        WAYS are written.
        """
        one = np.zeros(len(test), np.int8)
        columns = {
            "recording": pa.DictionaryArray.from_arrays(one, [recording]),
            "t_us": pa.array(frames.t_us),
            "split": pa.DictionaryArray.from_arrays(test.astype(np.int8), ["train", "test"]),
        }
        for way in WAYS:
            if way in biases:
                lsb = biases[way] / np.float32(256.0)
                columns.update({f"bias_{way}_{g}": lsb[:, a] for a, g in enumerate(_AXES)})
        self.append(pa.table(columns))


def rounding_dps(
    power_on: PowerOn, model: Model, terms: Terms, coefficients: np.ndarray, scales: Scales
) -> np.ndarray:
    """(3,) RMS over a session's blocks of the firmware's effects less the same terms in floats.

    terms, coefficients: what the model was made of, (terms, 3) dps per unit. The firmware holds
    the value of a tick during the next one, and so does the reference, but for what it computes of
    every sample, and where a tick is one sample.
    """
    s = power_on.session
    cold = Firmware(scales, model, power_on.channels)
    means = BlockMeans(power_on)
    for frames in power_on.frames():
        means.add(frames, cold.run(frames, learn=False))
    exact = np.zeros((s.blocks * s.ticks_per_block, 3))
    for term, c in zip(terms, coefficients):
        added = np.outer(evaluate(term, s.source, s.tick_s), c)
        at_once = has_one_sample(scales, s.tick_s) or Slot(term, tuple(c)).is_of_the_sample
        exact += added if at_once else np.vstack([added[:1], added[:-1]])
    error = means.blocks_dps() - power_on.block_means(exact)
    return np.sqrt(np.nanmean(error[s.available] ** 2, axis=0))
