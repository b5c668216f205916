"""The page on paper: Chromium's print-to-pdf, at once and after the page was used."""

import subprocess

import numpy as np
import pytest

pdfium = pytest.importorskip("pypdfium2")

#: Points a CSS pixel, pixels a point.
_PT, _SCALE = 0.75, 2
#: Pixels with a colour that make a curve; text and rules are grey.
_LEAST_COLOURED = 150


def plots_on(path):
    """Title of each plot -> how many coloured pixels the 250 CSS pixels below it hold."""
    found = {}
    for page in pdfium.PdfDocument(path):
        for title, top in _titles(page):
            found[title] = max(found.get(title, 0), _coloured(page, top))
    return found


def _titles(page):
    """(title, its lower edge in points): where it has a line of its own."""
    text = page.get_textpage()
    for title in TITLES:
        search = text.search(title, match_case=True)
        while found := search.get_next():
            edges = [text.get_charbox(found[0] + i) for i in range(found[1])]
            low, high = min(edge[1] for edge in edges), max(edge[3] for edge in edges)
            if text.get_text_bounded(bottom=low, top=high).strip() == title:
                yield title, low


def _coloured(page, top_pt):
    picture = page.render(scale=_SCALE).to_numpy()[:, :, :3].astype(int)
    first = round((page.get_height() - top_pt + 40 * _PT) * _SCALE)
    part = picture[first : first + round(250 * _PT * _SCALE)]
    return int((np.ptp(part, axis=2) > 60).sum())


TITLES = (
    "At a glance",
    "Error against time",
    "Error against temperature",
    "Allan deviation",
    "Thermal hysteresis: the curve and its data",
    "Which temperatures the firmware remembers",
    "Inside the estimators",
)


@pytest.fixture
def page(outcome):
    return outcome("an effect").page


def test_printed_before_anything_was_drawn_every_plot_is_there(chromium, page, tmp_path):
    paper = tmp_path / "paper.pdf"
    flags = ["--headless", "--no-sandbox", "--disable-gpu", f"--user-data-dir={tmp_path}/user"]
    command = [chromium, *flags, f"--print-to-pdf={paper}", page.as_uri()]
    subprocess.run(command, check=True, capture_output=True, timeout=300)
    shown = plots_on(paper)
    assert [t for t in TITLES if shown.get(t, 0) < _LEAST_COLOURED] == [], shown


@pytest.mark.parametrize("phone", [False, True])
def test_printed_in_the_dark_every_plot_is_there_in_light(outcome, show, tmp_path, phone):
    tab = show(outcome("an effect"), phone=phone, theme="dark").tab
    before = tab.evaluate("document.getElementById('plot-allan').clientWidth")
    (tmp_path / "paper.pdf").write_bytes(tab.pdf(format="A4"))
    shown = plots_on(tmp_path / "paper.pdf")
    assert [t for t in TITLES if shown.get(t, 0) < _LEAST_COLOURED] == [], shown
    assert tab.evaluate("document.getElementById('plot-allan').clientWidth") == before
    assert tab.evaluate("document.documentElement.dataset.theme") is None
    tab.context.close()
