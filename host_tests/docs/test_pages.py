"""Every page: its commands parse, its output is what they print, its links lead somewhere."""

import re
import shlex

import pytest
from zerorate_tools.cli import parser

from host_tests.docs.outputs import DEMO, commands, refreshed, same_but_for_rounding
from host_tests.docs.pages import blocks, pages
from host_tests.docs.tables import commands_under, with_tables

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
            assert parser().parse_args(shlex.split(command)[1:]).run, command
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
            f"`python -m host_tests.docs {page.name}` writes it anew:\n{fresh}"
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


def test_a_page_that_installs_zerorate_says_what_holds_until_it_is_published(repository):
    told = "(README.md#install)"
    for page in (repository / "docs").glob("*.md"):
        asked = re.search(r"pip install '?zerorate", read(page)) and page.name != "README.md"
        assert not asked or told in read(page), page.name


@pytest.mark.parametrize(
    ("one", "other", "same"),
    [
        ("x 26.311 mdps", "x 26.4 mdps", True),
        ("x 26.311 mdps", "x 36.4 mdps", False),
        ("found: lag", "found: rate", False),
        ("1,234 samples", "1,234 samples, 3 lost", False),
        ("offset -0.31", "offset +0.31", False),
        ("a  b\n", "a b\n", True),
    ],
)
def test_output_is_the_same_but_for_rounding(one, other, same):
    assert same_but_for_rounding(one, other) is same
