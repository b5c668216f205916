"""The site of docs/: it is built without a warning, opens from disk and finds what one seeks."""

import os
import re
import subprocess
import sys

import pytest
import zerorate_tools

BESIDES = ("FloatCorrector", "fleet", "Corrector", "LearnedStore", "MPU6050", "Fifo", "LinuxI2C")
FAKES = ("FakeMPU6050", "FakeI2C", "FakeClock", "Physical", "SMBus")


@pytest.fixture(scope="module")
def site(repository, tmp_path_factory):
    """The site, built as `make site` builds it: a broken link or a page in no menu is an error."""
    folder = tmp_path_factory.mktemp("site")
    command = [sys.executable, "-m", "mkdocs", "build", "--strict", "--site-dir", str(folder)]
    quiet = {**os.environ, "NO_MKDOCS_2_WARNING": "1"}
    done = subprocess.run(command, cwd=repository, env=quiet, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return folder


def test_the_reference_has_every_public_name(site):
    page = (site / "api.html").read_text(encoding="utf-8")
    named = {name.rpartition(".")[2] for name in re.findall(r'<h3 id="([\w.]+)"', page)}
    assert {*zerorate_tools.__all__, *BESIDES, *FAKES} <= named
    text = re.sub(r"<[^>]+>", "", page)
    assert "ignore_outside: bool" in text and "odr_hz: float = 100.0" in text  # constructors, too


@pytest.mark.parametrize(
    ("sought", "page"), [("LearnedStore", "api.html"), ("hysteresis", "glossary.html")]
)
def test_from_disk_a_search_finds_its_page_and_asks_nobody(site, browser, sought, page):
    asked, complaints = [], []
    tab = browser.new_page(viewport={"width": 1440, "height": 900})
    tab.on("request", lambda request: asked.append(request.url))
    tab.on("console", lambda message: complaints.append(message.text))
    tab.on("pageerror", lambda error: complaints.append(str(error)))
    tab.goto((site / "index.html").as_uri())
    tab.locator("label.md-search__icon").first.wait_for(state="attached")
    tab.keyboard.press("f")
    tab.keyboard.type(sought, delay=20)
    found = tab.locator(".md-search-result__link").first
    found.wait_for()
    found.click()
    tab.wait_for_url(f"**/{page}*")
    tab.close()
    assert complaints == []
    assert [url for url in asked if not url.startswith("file:")] == []


def test_on_a_phone_no_page_scrolls_sideways(site, browser):
    tab = browser.new_page(viewport={"width": 390, "height": 844})
    wide = {}
    for page in site.glob("*.html"):
        tab.goto(page.as_uri())
        wide[page.name] = tab.evaluate("document.documentElement.scrollWidth")
    tab.close()
    assert {name: width for name, width in wide.items() if width > 390} == {}
