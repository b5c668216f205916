"""Every page: its commands parse, its output is what they print, its links lead somewhere."""

import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest
import zerorate_tools
from zerorate_fakes import FakeClock, FakeI2C, FakeMPU6050
from zerorate_fakes.smbus import SMBus
from zerorate_tools import __version__
from zerorate_tools.cli import parser

from host_tests.docs.outputs import (
    DEMO,
    blocks,
    commands,
    commands_under,
    pages,
    refreshed,
    same_but_for_rounding,
    with_tables,
)

#: Pages whose programs run in tests of their own, on fakes of a board, a bus or ROS.
ELSEWHERE = {
    *("any-imu.md", "linux-service.md", "pico.md", "raspberry-pi.md", "unit-tests.md"),
    "notebook.md",
}
_LINK = re.compile(r"\]\(([^)\s]+)\)")


def read(page):
    return page.read_text(encoding="utf-8")


def zerorate_commands(page):
    """Every `zerorate ...` of a page's shell and console blocks, without what a pipe adds."""
    lines = [line for block in blocks(page, "sh") for line in block.text.splitlines()]
    lines += [line for block in blocks(page, "console") for line in commands(block)]
    return [line.partition(" | ")[0] for line in lines if line.startswith("zerorate ")]


def test_every_command_is_taken_by_the_parser(repository):
    checked = 0
    for page in pages(repository):
        for command in zerorate_commands(page):
            assert parser().parse_args(shlex.split(command, comments=True)[1:]).run, command
            checked += 1
    assert checked > 20


def test_programs_run_and_console_blocks_show_what_their_commands_print(
    repository, find_runtime, tmp_path
):
    find_runtime("wasm")
    shown = [page for page in pages(repository)[1:] if blocks(page, "console", "python")]
    assert shown
    for page in (page for page in shown if page.name not in ELSEWHERE):
        folder = tmp_path / page.stem
        folder.mkdir()
        fresh = refreshed(page, folder, but=DEMO)
        assert same_but_for_rounding(fresh, read(page)), (
            f"`python -m host_tests.docs.outputs {page.name}` writes it anew:\n{fresh}"
        )


def test_tables_are_what_they_are_made_from(repository):
    for page in pages(repository):
        assert with_tables(read(page), repository / "docs") == read(page), "`make docs` writes them"


def test_every_command_has_its_section(repository):
    sections = re.findall(r"^## (\w+)$", read(repository / "docs" / "commands.md"), re.MULTILINE)
    assert set(commands_under()) <= set(sections)


def test_every_link_of_a_page_beside_the_site_leads_to_a_file_and_a_heading(repository):
    for page in (repository / name for name in ("README.md", "CONTRIBUTING.md")):
        for link in _LINK.findall(read(page)):
            path, _, heading = link.partition("#")
            target = (page.parent / path).resolve() if path else page
            assert target.exists(), f"{page.name}: {link}"
            if heading:
                titles = re.findall(r"^#+ (.*)$", read(target), re.MULTILINE)
                anchors = [
                    re.sub(r"[^\w -]", "", t).strip().lower().replace(" ", "-") for t in titles
                ]
                assert heading in anchors, f"{page.name}: {link}"


HERE = Path(__file__).parent


@pytest.fixture
def programs(repository):
    """The README's Python blocks: for a board, for Linux, for a test suite."""
    board, linux, suite = (block.text for block in blocks(repository / "README.md", "python"))
    return {"board": board, "linux": linux, "suite": suite}


def test_the_program_for_a_board_reads_and_corrects(programs, repository, find_runtime):
    folders = ("firmware", "drivers", "host_tests/fakes")
    done = find_runtime("x86").run(
        HERE / "on_board.py",
        ["main.py", 10, 5, 4, -1],
        modules=[repository / folder for folder in folders],
        files_in={"main.py": (programs["board"] + "print(imu.part, sample[2] > 16000)\n").encode()},
        check=True,
    )
    assert done.stdout.split() == ["MPU-6050", "True"]


def test_the_program_for_linux_takes_the_bias_off(programs, monkeypatch):
    smbus2 = pytest.importorskip("smbus2")
    samples = [[0, k % 5, 16384, -3000, 40 + k % 3, -20, 10 + k % 2] for k in range(3000)]
    chip = FakeMPU6050(samples)
    clock = FakeClock(chip)
    seconds = []

    def slept(s):
        seconds.append(s)
        if sum(seconds) > 20:
            raise KeyboardInterrupt
        clock.advance_us(int(s * 1e6))

    monkeypatch.setattr(smbus2, "SMBus", lambda number: SMBus(FakeI2C(chip)))
    monkeypatch.setattr("time.sleep", slept)
    for name in ("ticks_us", "ticks_diff", "ticks_add", "sleep_ms"):
        monkeypatch.setattr(f"zerorate_i2c.clock.{name}", getattr(clock, name))
    names = {}
    with pytest.raises(KeyboardInterrupt):
        exec(compile(programs["linux"], "README.md", "exec"), names)
    assert names["corrector"].bias_lsb(0) == pytest.approx(41, abs=0.5)
    assert list(names["sample"])[4:] == pytest.approx([0, 0, 0], abs=2)


def test_the_program_for_a_test_suite_passes(programs, tmp_path):
    (tmp_path / "test_snippet.py").write_text(programs["suite"])
    (tmp_path / "pytest.ini").write_text("[pytest]\n")
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path)
    assert "1 passed" in done.stdout, done.stdout


def test_the_wheel_that_is_named_is_of_this_version(repository):
    named = 0
    for page in (repository / "README.md", *(repository / "docs").glob("*.md")):
        versions = re.findall(r"zerorate-([\d.]+)-py3-none-any.whl", page.read_text("utf-8"))
        assert set(versions) <= {__version__}, page.name
        named += len(versions)
    assert named


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
    assert "Integer columns of equal length" in text  # and what their docstrings say
    assert "ignore_outside: bool" in text and "odr_hz: float = 100.0" in text  # constructors, too


def test_from_disk_a_search_finds_its_page_and_asks_nobody(site, browser):
    asked, complaints = [], []
    tab = browser.new_page(viewport={"width": 1440, "height": 900})
    tab.on("request", lambda request: asked.append(request.url))
    tab.on("console", lambda message: complaints.append(message.text))
    tab.on("pageerror", lambda error: complaints.append(str(error)))
    tab.goto((site / "index.html").as_uri())
    tab.locator("label.md-search__icon").first.wait_for(state="attached")
    tab.keyboard.press("f")
    tab.keyboard.type("LearnedStore", delay=20)
    found = tab.locator(".md-search-result__link").first
    found.wait_for()
    found.click()
    tab.wait_for_url("**/api.html*")
    tab.close()
    assert complaints == []
    assert [url for url in asked if not url.startswith("file:")] == []


def test_on_a_phone_no_page_scrolls_sideways(site, browser):
    tab = browser.new_page(viewport={"width": 390, "height": 844})
    wide = {}
    for page in site.glob("*.html"):
        tab.goto(page.as_uri(), wait_until="domcontentloaded")
        wide[page.name] = tab.evaluate("document.documentElement.scrollWidth")
    tab.close()
    assert {name: width for name, width in wide.items() if width > 390} == {}
