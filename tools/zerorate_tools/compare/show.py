"""What `compare` found: a table for a terminal, and one page with a plot."""

import html
import io
from collections.abc import Sequence
from pathlib import Path

import matplotlib
import numpy as np

from ..recordings.atomic import written_beside
from .judge import FIRST_REST, NOTHING, Compared, Won

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.axes import Axes  # noqa: E402
from matplotlib.ticker import LogFormatter  # noqa: E402

_COLOURS = ("#8d8d93", "#d55e00", "#cc79a7", "#d98200", "#56b4e9", "#0072b2")
_MARKS = "xsv^oD"
_HEAD = ("way", "error, deg/s", "heading lost, deg/min", "against the first rest")
#: A drawing in inches, at 10 points, for a desk and for a phone of 390 CSS pixels.
_WIDE, _NARROW = (9.0, 4.5), (3.7, 4.4)
_NOTE = (
    "The mean rate of a rest is its bias. The error is that of the bias which each way had 3 s "
    "before the rest, as a root mean square over later rests. A rest of over a minute counts as "
    "several. Every rest contains the Earth's rate, up to 0.25 deg/min: a smaller difference is "
    "none."
)
NO_RESTS = (
    "No method was judged: the device never lay still twice. Leave it at rest for some seconds, "
    "move it, and leave it at rest again."
)
_STYLE = """
body { font: 16px/1.5 sans-serif; max-width: 60rem; margin: 1rem auto; padding: 0 1rem }
h1, h2 { font-size: 1.4rem; line-height: 1.25 }
h2 { font-size: 1.1rem }
td, th { padding: .2rem .6rem .2rem 0; text-align: right }
td:first-child, th:first-child { text-align: left }
svg { max-width: 100%; height: auto }
.ours { font-weight: bold }
.narrow { display: none }
@media (max-width: 56rem) {
  table { font-size: .85rem }
  .wide { display: none }
  .narrow { display: block }
}
"""


def rows(compared: Compared) -> list[tuple[str, str, str, str]]:
    """A row a way: its name, deg/s, degrees a minute, and its verdict against the first rest."""
    found = []
    for way in compared.error_dps:
        verdict = "" if way in (NOTHING, FIRST_REST) else compared.verdict(way, FIRST_REST).word
        wrong, heading = compared.rms_dps(way), compared.heading_deg_per_min(way)
        found.append((way, f"{wrong:.4f}", f"{heading:.2f}", verdict))
    return found + [(way, why, "", "") for way, why in compared.left_out.items()]


def table(compared: Compared) -> str:
    lines = [("way", "deg/s", "heading, deg/min", "against the first rest"), *rows(compared)]
    return "\n".join([compared.headline(), "", *_aligned(lines)])


def in_motion(won: Won) -> str:
    """What the matrix would win: the sentence and its rows, in plain text."""
    lines = won.rows()
    return "\n".join([won.sentence(), *([""] if lines else []), *_aligned(lines)])


def _aligned(lines: list[tuple[str, str, str, str]]) -> list[str]:
    widths = [max((len(line[i]) for line in lines if line[2]), default=0) for i in range(3)]
    return [
        f"{way:{widths[0]}}  {wrong:>{widths[1]}}  {lost:>{widths[2]}}  {word}".rstrip()
        for way, wrong, lost, word in lines
    ]


def write_page(
    compared: Compared | None, path: Path, won: Won | None = None, names: Sequence[str] = ()
) -> None:
    """One HTML file with headline, plot and tables, which needs no other; without a method judged
    at a rest, the logs' names and what the motion shows."""
    without = f"<h1>{NO_RESTS}</h1><p>{html.escape(', '.join(names))}</p>"
    at_rests = without if compared is None else _rests_html(compared)
    page = (
        f"<!doctype html><html lang=en><meta charset=utf-8><title>zerorate compare</title>"
        f"<meta name=viewport content='width=device-width'><style>{_STYLE}</style>"
        f"{at_rests}{_motion_html(won)}</html>\n"
    )
    with written_beside(path) as temporary:
        temporary.write_text(page, encoding="utf-8")


def _rests_html(compared: Compared) -> str:
    escaped = [[html.escape(cell) for cell in row] for row in rows(compared)]
    body = "".join(
        f"<tr{' class=ours' if row[0] == compared.ours else ''}>"
        + "".join(f"<td>{cell}</td>" for cell in row)
        + "</tr>"
        for row in escaped
    )
    head = "".join(f"<th>{cell}</th>" for cell in _HEAD)
    names = html.escape(", ".join(compared.names))
    return (
        f"<h1>{html.escape(compared.headline())}</h1><p>{names}</p>"
        f"<div class=wide>{_plot(compared, _WIDE)}</div>"
        f"<div class=narrow>{_plot(compared, _NARROW)}</div>"
        f"<table><tr>{head}</tr>{body}</table><p>{_NOTE}</p>"
    )


def _motion_html(won: Won | None) -> str:
    if won is None:
        return ""
    cells = ["".join(f"<td>{html.escape(cell)}</td>" for cell in row[:3]) for row in won.rows()]
    table = "".join(f"<tr>{row}</tr>" for row in cells)
    return f"<h2>{html.escape(won.sentence())}</h2><table>{table}</table>"


def _plot(compared: Compared, inches: tuple[float, float]) -> str:
    """SVG: the heading that each way would have lost a minute, at each later rest."""
    with plt.rc_context({"svg.fonttype": "none", "font.size": 10, "legend.fontsize": 10}):
        figure, axes = plt.subplots(figsize=inches, layout="constrained")
        _draw(compared, axes)
        figure.legend(loc="outside lower left", ncols=3 if inches == _WIDE else 1, frameon=False)
        text = io.StringIO()
        figure.savefig(text, format="svg")
        plt.close(figure)
    return text.getvalue().partition("<svg")[2].join(["<svg", ""])


def _draw(compared: Compared, axes: Axes) -> None:
    logs = np.array([number for number, _ in compared.rests])
    minutes = np.array([rest.start_s for _, rest in compared.rests]) / 60
    gap = 0.05 * minutes.max() + 0.1
    begins = [0.0]
    for number in range(1, len(compared.names)):
        before = minutes[logs == number - 1]
        begins.append(begins[-1] + gap + (before.max() if len(before) else 0.0))
        axes.axvline(begins[-1] - gap / 2, color="#cccccc", linewidth=1)
    at = minutes + np.array(begins)[logs]
    for way, colour, mark in zip(compared.error_dps, _COLOURS, _MARKS):
        lost = 60 * np.abs(compared.about_vertical_dps(way))
        axes.plot(at, np.maximum(lost, 1e-3), mark, color=colour, markersize=5, label=way)
    axes.set_yscale("log")
    axes.yaxis.set_major_formatter("{x:g}")
    axes.yaxis.set_minor_formatter(LogFormatter(minor_thresholds=(1.5, 0.5)))
    axes.set_xlabel("minutes since power-on" + (", log after log" if logs.any() else ""))
    axes.set_ylabel("heading lost, deg/min")
    axes.grid(True, which="major", alpha=0.3)
