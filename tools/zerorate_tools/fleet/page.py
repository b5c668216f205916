"""fleet.html: the fleet's report as one file that needs nothing else."""

from pathlib import Path
from typing import Any

from ..numbers import figure
from ..recordings.atomic import written_beside
from ..report.page import rendered
from .fleet_in_words import WAYS, scenario_in_words
from .part import Part
from .plots import plots_of


def write_page(report: dict[str, Any], part: Part | None, path: Path) -> None:
    """Write the page of a fleet's report (what fleet.json holds). Raises OSError."""
    said = {"headline": headline(report), "ways": WAYS, "scenario": scenario_in_words}
    text = rendered("fleet.html.j2", plots_of(report, part), __package__, r=report, **said)
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
