"""report.html of a closed loop: one file that needs nothing else."""

from __future__ import annotations

import json
import shlex
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import lru_cache
from html import escape
from importlib.metadata import version
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import ZerorateError
from ..loop.read.ticks import AnyPath
from ..loop.verify.analysis import Analysis
from ..model import read_model
from ..numbers import chance, figure, unit_of_page
from ..recordings.atomic import final
from . import residual_plots, sentences
from .effect_plots import effect_plots
from .estimators import held_over_time, inside, moments
from .plot import Panel, Plot, Series
from .sentences import title

# Heights in CSS pixels: of a panel in a stack, alone, beside others and under others, and of what
# is about them (page.js).
_STACKED_PX, _ALONE_PX, _BESIDE_PX, _UNDER_PX, _EDGE_PX = 120, 230, 300, 246, 64
#: Moments at which the firmware's state is looked at, of all recordings together.
_MOST_MOMENTS = 120
_UNSAFE = {ord(c): f"\\u{ord(c):04x}" for c in "<>&\u2028\u2029'"}
#: Role -> colour on light ground, colour on dark ground.
ROLES: dict[str, tuple[str, str]] = {
    "before": ("#8d8d93", "#85858d"),
    "after": ("#0072b2", "#56b4e9"),
    "floor": ("#00795a", "#2fc49b"),
    "heating": ("#c44e00", "#f08a45"),
    "cooling": ("#0072b2", "#56b4e9"),
    "held": ("#8d8d93", "#85858d"),
    "x": ("#0072b2", "#56b4e9"),
    "y": ("#c44e00", "#f08a45"),
    "z": ("#00795a", "#2fc49b"),
    "model": ("#1b1b1f", "#f2f2f4"),
    "context": ("#6c6c74", "#a0a0a8"),
    "event": ("#a8417f", "#e08abf"),
    "long": ("#0072b2", "#56b4e9"),
    "short": ("#d98200", "#e6a532"),
    "any": ("#00795a", "#2fc49b"),
    "now": ("#1b1b1f", "#f2f2f4"),
}
_LOAD = """\
from zerorate.model import EffectModel
from zerorate.effects.model_file import LOADED, REASONS

effects = EffectModel()
reason = effects.load_file("model.bin", corrector.sensor, imu.binding)
if reason == LOADED:
    corrector.use_model(effects)
else:
    print("model.bin is not used:", REASONS[reason])
"""


def page(
    result: Mapping[str, Any], plots: Sequence[Plot], board: Deployment, notes: Sequence[str]
) -> str:
    """The page's text. result: what report.json holds; notes: why a plot is missing."""
    return rendered(
        "page.html.j2",
        plots,
        r=result,
        headline=sentences.headline(result),
        why_both=sentences.why_both(result),
        corrected=any(sentences.corrects_at_rest(effect) for effect in result["effects"]),
        deployed=any(effect["coefficients"] for effect in result["effects"]),
        board=board,
        notes=notes,
        smallest=smallest(result),
        faults=faults(result),
    )


def rendered(
    template: str, plots: Sequence[Plot], package: str = __package__, **values: Any
) -> str:
    """The text of a package's template with plots, style and script in it, and these values."""
    from plotly.offline import get_plotlyjs

    return (
        _environment(package)
        .get_template(template)
        .render(
            plots={p.key: p for p in plots},
            made=f"zerorate {version('zerorate')}",
            roles=ROLES,
            data=script_json([plain(p) for p in plots]),
            plotly_js=get_plotlyjs(),
            style=_own("page.css"),
            script=_own("page.js"),
            **values,
        )
    )


@lru_cache
def _environment(package: str = __package__) -> Any:
    from jinja2 import ChoiceLoader, Environment, PackageLoader, StrictUndefined

    environment = Environment(
        loader=ChoiceLoader([PackageLoader(place, "") for place in (package, __package__)]),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters.update(
        figure=figure,
        chance=chance,
        unit=unit_of_page,
        sentence=sentences.sentence,
        capital=sentences.capital,
    )
    environment.globals.update(
        kinds=sentences, words=sentences, height=height, legend=legend, zip=zip, axes="xyz"
    )
    return environment


def script_json(value: Any) -> str:
    """JSON without any character that could end a <script>, begin a comment or break a line."""
    text = json.dumps(value, allow_nan=False, separators=(",", ":"), ensure_ascii=False)
    return text.translate(_UNSAFE)


def _own(name: str) -> str:
    return files(__package__).joinpath(name).read_text(encoding="utf-8")


def height(plot: Plot, narrow: bool) -> int:
    """CSS pixels that the plot takes, known before it is drawn, so that nothing moves then."""
    if plot.stacked:
        each = _STACKED_PX if len(plot.panels) > 1 else _ALONE_PX
        return round(_EDGE_PX + each * sum(p.share for p in plot.panels))
    return _EDGE_PX + (_UNDER_PX * len(plot.panels) - 44 if narrow else _BESIDE_PX)


def legend(plot: Plot) -> list[dict[str, str]]:
    """Each name once, with the mark it is drawn by."""
    seen: dict[str, dict[str, str]] = {}
    for s in plot.series:
        look = {"name": s.name, "role": s.role, "mark": s.mark, "symbol": s.symbol, "dash": s.dash}
        seen.setdefault(s.name, look)
    return list(seen.values())


def smallest(result: Mapping[str, Any]) -> list[tuple[str, float]]:
    """(effect in words, mdps), the best shown first."""
    sizes = sorted(result["smallest_detectable_mdps"].items(), key=lambda item: item[1])
    return [(sentences.title(kind), value) for kind, value in sizes]


def faults(result: Mapping[str, Any]) -> list[tuple[str, str]]:
    """(recording, its bad samples in words), of recordings that have any."""
    every = result["gate"]["faults"].items()
    said = {n: ", ".join(f"{c} {fault}" for fault, c in of.items() if c) for n, of in every}
    return [(name, words) for name, words in said.items() if words]


def plain(plot: Plot) -> dict[str, Any]:
    """Everything that the script needs; names are escaped, for Plotly reads them as markup."""
    return {
        "key": plot.key,
        "stacked": plot.stacked,
        "views": list(plot.views),
        "panels": [_panel(p) for p in plot.panels],
        "series": [_series(s) for s in plot.series],
        "frames": [
            [label, {str(at): _values(s) for at, s in new.items()}] for label, new in plot.frames
        ],
    }


def markup(text: str) -> str:
    """Text as Plotly shows it letter by letter: no markup, no formula, no turning of the line."""
    return "\u2068" + escape(text, quote=False).replace("$", "&#36;") + "\u2069"


def _panel(panel: Panel) -> dict[str, Any]:
    own = asdict(panel)
    lines = [{**line, "text": line["text"] and markup(line["text"])} for line in own["lines"]]
    return {
        **own,
        "lines": lines,
        "title": markup(panel.title),
        "x_label": markup(panel.x_label),
        "x_narrow": markup(panel.x_narrow or panel.x_label),
    }


def _series(series: Series) -> dict[str, Any]:
    look = ("panel", "role", "mark", "symbol", "dash", "size")
    return {
        **{name: getattr(series, name) for name in look},
        "name": markup(series.name),
        "views": list(series.views),
        **_values(series),
    }


def _values(series: Series) -> dict[str, Any]:
    out: dict[str, Any] = {"x": _numbers(series.x), "y": _numbers(series.y)}
    if series.width is not None:
        out["width"] = _numbers(series.width)
    if series.words is not None:
        out["words"] = [markup(w) for w in series.words]
    return out


def _numbers(values: Iterable[float]) -> list[float | None]:
    """Five digits, which a screen cannot show; None where a line breaks."""
    return [float(f"{v:.5g}") if np.isfinite(v) else None for v in np.asarray(values, float)]


@dataclass(frozen=True)
class Deployment:
    """Shell commands, lines for the program after `corrector` was made, and for its loop."""

    commands: str
    program: str
    each_reading: str


def deployment(folder: Path, channels: Sequence[str]) -> Deployment:
    """What to type and to write for the model in `folder`, which follows these extra channels."""
    model = shlex.quote(str(folder / "model.bin"))
    commands = f"zerorate model check {model}\nzerorate flash /dev/ttyACM0 --model {model}\n"
    values = [name if name.isidentifier() and name.isascii() else "value" for name in channels]
    lines = [f"effects.channel({name!r}, {value})\n" for name, value in zip(channels, values)]
    return Deployment(commands, _LOAD, "".join(lines))


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
