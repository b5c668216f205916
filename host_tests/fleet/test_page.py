"""fleet.html: what fleet.json holds, without a network, whatever the devices are named."""

import copy

import pytest
from zerorate_bench.fleet import in_markdown, on_paper
from zerorate_tools.fleet.plots import headline, write_page

HOSTILE = "<script>document.title='taken'</script>"


@pytest.fixture
def hostile(done, tmp_path):
    """The page of a fleet whose files and devices have names that strangers chose."""
    report = copy.deepcopy(done[0].report)
    report["failures"] = [{"device": HOSTILE, "file": HOSTILE, "reason": HOSTILE}]
    report["worst"][0]["device"] = HOSTILE
    report["effects"][0]["unusual_devices"] = [HOSTILE]
    write_page(report, None, tmp_path / "fleet.html")
    return tmp_path / "fleet.html"


def test_the_page_says_what_the_prior_is_worth(done):
    found = done[0].report["prior"]["benefit"]["scenarios"]["at-rest-for-10-s"]
    assert found["prior"]["median_mdps"] < found["without"]["median_mdps"]
    assert f"{found['prior']['median_mdps']:.1f}" in headline(done[0].report)
    assert headline(done[0].report) in (done[1] / "fleet.html").read_text()


def test_names_of_strangers_are_only_names(hostile):
    text = hostile.read_text()
    assert HOSTILE not in text
    assert text.count("&lt;script&gt;document.title") >= 3


def test_a_fleet_too_small_for_a_part_has_a_page_too(tmp_path):
    report = {"devices": 1, "sessions": 0, "hours": 0.0, "sensor": None, "effects": [], "steps": []}
    report |= {
        "job": "replay",
        "prior": None,
        "worst": [],
        "failures": [],
        "left_out_of_the_part": [],
    }
    write_page(report, None, tmp_path / "fleet.html")
    assert "it takes five devices" in (tmp_path / "fleet.html").read_text()


def test_chromium_draws_every_plot_without_a_word(done, browser):
    said = []
    page = browser.new_page(viewport={"width": 390, "height": 844})
    page.on("console", lambda message: said.append(message.text))
    page.on("pageerror", lambda error: said.append(str(error)))
    page.goto((done[1] / "fleet.html").as_uri())
    page.wait_for_selector("html[data-drawn=all]", state="attached")
    drawn = page.evaluate("document.querySelectorAll('.canvas .main-svg').length")
    wide = page.evaluate("document.documentElement.scrollWidth")
    page.close()
    assert said == []
    assert drawn >= 3 and wide <= 390


def test_a_bench_of_too_few_devices_for_a_prior_says_so():
    million = on_paper({"cpu_s": 1.0, "devices": 6, "out_bytes": 1}, 1.5, 25.0, 1000.0)
    some = {"minutes": 1.5, "odr_hz": 25.0, "bytes_per_recording": 1000.0, "scaling": []}
    assert "it takes 10 devices" in in_markdown({**some, "prior": None, "million": million})
