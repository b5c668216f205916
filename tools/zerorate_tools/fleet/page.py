"""fleet.html: the fleet's report as one file that needs nothing else."""

from functools import lru_cache
from importlib.metadata import version
from importlib.resources import files
from pathlib import Path
from typing import Any

from ..numbers import chance, figure
from ..recordings.atomic import written_beside
from ..report import sentences as report_words
from ..report.colours import ROLES
from ..report.page import height, legend
from ..report.plotly_form import plain
from ..report.safe_json import script_json
from .fleet_in_words import WAYS, scenario_in_words
from .part import Part
from .plots import plots_of

_REPORT = "zerorate_tools.report"


def write_page(report: dict[str, Any], part: Part | None, path: Path) -> None:
    """Write the page of a fleet's report (what fleet.json holds). Raises OSError."""
    from plotly.offline import get_plotlyjs

    plots = plots_of(report, part)
    text = (
        _environment()
        .get_template("fleet.html.j2")
        .render(
            r=report,
            headline=headline(report),
            plots={plot.key: plot for plot in plots},
            made=f"zerorate {version('zerorate')}",
            roles=ROLES,
            data=script_json([plain(plot) for plot in plots]),
            plotly_js=get_plotlyjs(),
            style=_of_report("page.css"),
            script=_of_report("page.js"),
        )
    )
    with written_beside(path) as temporary:
        temporary.write_text(text, encoding="utf-8")


def headline(report: dict[str, Any]) -> str:
    """The answer in one line, plain text."""
    tried = (report["prior"] or {}).get("benefit") or {"scenarios": {}}
    found = tried["scenarios"].get("at-rest-for-10-s")
    if not found:
        return f"{report['devices']} devices, {report['sessions']} power-ons"
    before, after = (figure(found[way]["median_mdps"]) for way in ("without", "prior"))
    return (
        f"A device that starts from {report['devices_of_the_part']} others is off by {after} "
        f"instead of {before} mdps in its first {tried['minutes']:g} minutes"
    )


@lru_cache(maxsize=1)
def _environment():
    from jinja2 import ChoiceLoader, Environment, PackageLoader, StrictUndefined

    environment = Environment(
        loader=ChoiceLoader([PackageLoader(__package__, ""), PackageLoader(_REPORT, "")]),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters.update(
        figure=figure, chance=chance, sentence=report_words.sentence, capital=report_words.capital
    )
    shared = {"height": height, "legend": legend, "axes": "xyz", "zip": zip}
    environment.globals.update(**shared, ways=WAYS, scenario=scenario_in_words)
    return environment


def _of_report(name: str) -> str:
    return files(_REPORT).joinpath(name).read_text(encoding="utf-8")
