"""A comparison's page; a figure of matplotlib is taken as it is closed."""

import re
from contextlib import contextmanager
from dataclasses import replace
from itertools import pairwise
from unittest import mock

import matplotlib.pyplot as plt
import numpy as np
from zerorate_tools import peers
from zerorate_tools.compare import Won, compare
from zerorate_tools.compare.show import in_motion, write_page
from zerorate_tools.recordings import read_recording, write_recording

_APART = "<svg.*?</svg>|<style>.*?</style>"


def compared_on_a_page(logs, folder):
    """The pages and words of a comparison, with and without acceleration, and of all that moves."""
    bare = read_recording(logs[0], keep_gaps=True)
    columns = {n: of for n, of in bare.columns.items() if n not in ("ax", "ay", "az")}
    write_recording(replace(bare, columns=columns), folder / "bare.parquet")
    won = [
        None,
        Won((2.1, 1.2), heading=(3.4, 0.5), deployed=True),
        Won((2.1, 2.1)),
        Won(refused="of <two>"),
    ]
    with mock.patch.object(peers, "_ROWS", 700), _closed() as figures:
        every = [compare(logs), compare([folder / "bare.parquet"]), None, None]
        found = {}
        for number, (one, of) in enumerate(zip(every, won)):
            write_page(one, folder / "page.html", of, ["a.csv", "<b>.csv"])
            page = (folder / "page.html").read_text(encoding="utf-8")
            found[f"page {number}"] = re.sub(_APART, "", page, flags=re.DOTALL)
            found[f"words {number}"] = in_motion(of) if of else ""
    ways = [(one, way, other) for one in every[:2] for way, other in pairwise(one.error_dps)]
    verdicts = [[*vars(one.verdict(*of)).values()] for one, *of in ways]
    return {**found, "verdicts": verdicts, **_drawings(figures)}


@contextmanager
def _closed():
    """The figures that are closed meanwhile."""
    figures, close = [], plt.close
    with mock.patch.object(plt, "close", figures.append):
        yield figures
    for figure in figures:
        close(figure)


def _drawings(figures):
    """Of each axes of each figure: its words, its limits and its lines."""
    every = [(f"{n} {k}", of) for n, one in enumerate(figures) for k, of in enumerate(one.axes)]
    return {f"drawing {name}": _axes(of) for name, of in every} | {
        f"size {n}": [*one.get_size_inches()] for n, one in enumerate(figures)
    }


def _axes(of):
    legends = [one for one in (of.get_legend(), *of.figure.legends) if one]
    words = [of.get_title("left"), of.get_xlabel(), of.get_ylabel(), of.get_yscale()]
    words += [of.yaxis.label.get_color(), str([one._ncols for one in legends])]
    words += [tick.get_text() for tick in of.get_yticklabels(minor=True)]
    words += [str((line.get_visible(), line.get_alpha())) for line in of.get_xgridlines()[:1]]
    return {"words": words, "limits": [*of.get_xlim(), *of.get_ylim()], "lines": [
        [line.get_label(), line.get_color(), line.get_linestyle(), line.get_marker(),
         line.get_linewidth(), line.get_markersize(), line.get_zorder(),
         *(np.asarray(values, float).tolist() for values in line.get_data())]
        for line in of.lines
    ]}  # fmt: skip
