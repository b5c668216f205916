"""The report of a closed loop, written into a folder: one page."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from ..errors import ZerorateError
from ..loop.read.ticks import AnyPath
from ..loop.verify.analysis import Analysis
from ..model import read_model
from ..recordings.atomic import final
from . import residual_plots
from .effect_plots import effect_plots
from .estimators import held_over_time, inside, moments
from .page import deployment, page
from .plot import Plot
from .sentences import title

#: Moments at which the firmware's state is looked at, of all recordings together.
_MOST_MOMENTS = 120


def write_report(
    analysis: Analysis, result: Mapping[str, Any], logs: Sequence[AnyPath], folder: AnyPath
) -> Path:
    """Write report.html beside the model in `folder`; its path.

    analysis: of `closing.load`; result: what report.json holds, whose numbers are shown;
    logs: the recordings, replayed to show the estimators. Raises OSError.
    """
    folder = Path(folder)
    plots, notes = plots_of(analysis, result, logs, folder)
    board = deployment(final(folder), read_model(folder / "model.bin").channels)
    path = folder / "report.html"
    path.write_text(page(result, plots, board, notes), encoding="utf-8")
    return path


def plots_of(
    analysis: Analysis, result: Mapping[str, Any], logs: Sequence[AnyPath], folder: AnyPath
) -> tuple[list[Plot], list[str]]:
    """Every plot that these recordings allow, and sentences on those that they do not."""
    parts, notes = residual_plots.held_out(analysis), []
    names = [title(s["effect"], s["sources"]) for s in result["effects"]]
    plots: list[Plot | None] = [
        residual_plots.at_a_glance(result),
        residual_plots.against_time(parts, result["events"]),
        residual_plots.against_temperature(parts),
        residual_plots.deviations(
            parts, residual_plots.fitted_noise(analysis), result["floor_mdps"]
        ),
        *effect_plots(analysis, names),
    ]
    slots = any(effect["coefficients"] for effect in result["effects"])
    model = Path(folder) / "model.bin" if slots else None
    total_s = sum(s.blocks * s.block_s for s in analysis.sessions)
    try:
        seen = moments(logs, model, max(60.0, total_s / _MOST_MOMENTS))
        plots += [held_over_time(seen), inside(seen)]
    except ZerorateError as problem:
        notes.append(f"The estimators are not shown: {problem}.")
    return [p for p in plots if p is not None], notes
