"""The page on paper: Chromium's print-to-pdf, at once and after the page was used."""

import subprocess

import numpy as np
import pytest
from zerorate_tools.closing import motion_in_words
from zerorate_tools.model import build_model, write_model
from zerorate_tools.recordings import Scales
from zerorate_tools.report.motion_page import motion_page

from ..conftest import matrix_slots

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


def test_printed_from_a_phone_in_the_dark_every_plot_is_there_in_light(outcome, show, tmp_path):
    tab = show(outcome("an effect"), phone=True, theme="dark").tab
    before = tab.evaluate("document.getElementById('plot-allan').clientWidth")
    (tmp_path / "paper.pdf").write_bytes(tab.pdf(format="A4"))
    shown = plots_on(tmp_path / "paper.pdf")
    assert [t for t in TITLES if shown.get(t, 0) < _LEAST_COLOURED] == [], shown
    assert tab.evaluate("document.getElementById('plot-allan').clientWidth") == before
    assert tab.evaluate("document.documentElement.dataset.theme") is None
    tab.context.close()


ERROR = np.array([[0.012, 0.001, -0.002], [0.003, -0.009, 0.004], [-0.001, 0.002, 0.006]])
CI = np.full((3, 3), 0.0005)


def result_of(ci=CI, found=True, not_seen=(), lost_after=0.4):
    effect = {"effect": "scale-factor+cross-axis", "confidence": "confirmed"}
    return {
        "effects": [effect] if found else [],
        "unexplained": {"what_is_known": "Nothing.", "measure_next": ["turn it"]},
        "in_motion": {
            **{"before": 1.0, "after": 0.2, "unit": "degrees a minute of tilt", "windows": 12},
            **{"lost_before": 3.1, "lost_after": lost_after},
            "matrix_percent": (100 * ERROR).tolist(),
            "ci95_percent": (100 * ci).tolist(),
            "not_seen": list(not_seen),
        },
    }


@pytest.fixture
def opened(tmp_path, browser):
    """opened(result, share, width, theme) -> a tab with the page."""
    tabs = []

    def open_page(result, share=1.0, width=1200, theme="light"):
        scales = Scales("MPU-6050", 100.0, 131.0, 16384.0, None, None)
        slots = matrix_slots(share * ERROR) if result["effects"] else []
        write_model(build_model(slots, scales), tmp_path)
        (tmp_path / "report.html").write_text(motion_page(result, tmp_path))
        tab = browser.new_page(viewport={"width": width, "height": 844}, color_scheme=theme)
        tabs.append(tab)
        tab.goto((tmp_path / "report.html").as_uri())
        return tab

    yield open_page
    for tab in tabs:
        tab.close()


def dots(tab, role):
    """(x, y) of a role's dots in the three targets, in units of the drawing."""
    found = tab.locator(f".targets svg:not(.turn) circle.{role}")
    return [
        (float(found.nth(i).get_attribute("cx")), float(found.nth(i).get_attribute("cy")))
        for i in range(found.count())
    ]


@pytest.mark.parametrize("share", [1.0, 0.5])
def test_dots_lie_before_where_the_axes_are_off_and_after_where_the_model_leaves_them(
    opened, share
):
    tab = opened(result_of(), share=share)
    before, after = np.array(dots(tab, "before")), np.array(dots(tab, "after"))
    np.testing.assert_allclose(after, (1 - share) * before, atol=0.5)
    wanted = np.array([(ERROR[(j + 1) % 3, j], -ERROR[(j + 2) % 3, j]) for j in range(3)])
    np.testing.assert_allclose(before, wanted * before[0, 0] / wanted[0, 0], atol=0.2)


def test_where_nothing_is_deployed_there_is_no_after(opened):
    tab = opened(result_of(found=False))
    assert dots(tab, "after") == [] and len(dots(tab, "before")) == 3


@pytest.mark.parametrize("width", [390, 1200])
def test_it_is_read_on_a_phone_and_on_a_desk(opened, width):
    ci = CI.copy()
    ci[:, 2] = 0.03  # turns about z were not seen
    tab = opened(result_of(ci, not_seen=["scale of z"]), width=width)
    assert tab.evaluate("document.documentElement.scrollWidth") == width
    labels = tab.locator("svg[role=img]")
    assert all(len(labels.nth(i).get_attribute("aria-label")) > 30 for i in range(labels.count()))
    seen = np.abs(np.array(dots(tab, "before"))).max()
    assert 20 < seen < 100  # an interval that was not seen makes the others no smaller


@pytest.mark.parametrize(("lost_after", "said"), [(0.4, "loses 0.40"), (3.1, "not the heading")])
def test_a_heading_that_no_axis_turns_is_not_said_to_be_lost(opened, lost_after, said):
    result = result_of(lost_after=lost_after)
    assert said in opened(result).text_content("h1")
    assert ("not the heading" in motion_in_words(result)) == (lost_after == 3.1)


def test_it_is_printed_in_light_from_a_dark_screen(opened, tmp_path):
    tab = opened(result_of(), theme="dark")
    (tmp_path / "paper.pdf").write_bytes(tab.pdf(format="A4"))
    paper = pdfium.PdfDocument(tmp_path / "paper.pdf")[0].render(scale=1).to_numpy()[:, :, :3]
    assert np.median(paper) == 255  # white
    assert (paper.max(axis=2) < 60).sum() > 200  # text is black, not the grey of a dark screen
