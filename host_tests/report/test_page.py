"""What stands on the page: the numbers of report.json, and strangers' names as text only."""

import json
import re
from html.parser import HTMLParser

import pytest
from zerorate_tools.loop.read.turns import GIVEN
from zerorate_tools.numbers import figure
from zerorate_tools.report.sentences import corrects_at_rest, frozen, headline, why_both

from host_tests.report.devices import HOSTILE


class Reader(HTMLParser):
    """Elements, the numbers said in <data>, and the text of each <script>."""

    def __init__(self, text):
        super().__init__()
        self.elements, self.numbers, self.scripts, self.h1 = [], [], [], ""
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.elements.append(tag)
        if tag == "data":
            self.numbers.append(float(dict(attributes)["value"]))

    def handle_data(self, data):
        if self.elements and self.elements[-1] == "script" and self.cdata_elem:
            self.scripts.append(data)
        if self.elements and self.elements[-1] == "h1" and not self.h1:
            self.h1 = data


def numbers_in(value):
    """Every number anywhere in plain values."""
    if isinstance(value, dict):
        value = list(value.values())
    if isinstance(value, list):
        return {number for part in value for number in numbers_in(part)}
    return {float(value)} if isinstance(value, int | float) else set()


@pytest.fixture
def read(closed):
    return Reader(closed.page.read_text(encoding="utf-8"))


def test_every_number_shown_is_one_of_the_report(closed, read):
    assert len(read.numbers) > 20
    assert set(read.numbers) <= numbers_in(closed.result)


def test_before_after_and_floor_of_every_axis_are_shown_with_their_intervals(closed, read):
    r = closed.result
    keys = ("before_mdps", "after_mdps", "floor_mdps", "ci95_mdps")
    assert numbers_in([r[key] for key in keys]) <= set(read.numbers)
    assert numbers_in(r["smallest_detectable_mdps"]) <= set(read.numbers)


def test_the_first_line_is_the_answer(closed, read):
    assert read.h1 == headline(closed.result) + "."
    board, _, compared = read.h1.partition(". ")
    assert figure(closed.result["online"]["in_all"]["after_mdps"]) in board
    shown = "before_mdps" if "Nothing was found" in compared else "after_mdps"
    assert figure(closed.result["in_all"][shown]) in compared
    assert why_both(closed.result) in closed.page.read_text()


def test_it_is_one_file_of_less_than_six_megabytes(closed):
    text = closed.page.read_text(encoding="utf-8")
    assert closed.page.stat().st_size < 6_000_000
    own = re.sub(r"<script>.*?</script>", "", text, count=1, flags=re.DOTALL)
    assert re.findall(r"<(?:link|script|img|iframe)[^>]+(?:src|href)=.(?!data:,)", own) == []


class TestAnswers:
    def test_an_effect(self, outcome):
        said = headline(outcome("an effect").result)
        assert re.fullmatch(
            r"On the board, which goes on learning, [\d.]+ mdps are left, [\d.]+ without the "
            r"effects. Frozen, on the session held out, the error fell from [\d.]+ to [\d.]+ mdps "
            r"\(floor [\d.]+\)",
            said,
        )

    def test_nothing(self, outcome):
        assert frozen(outcome("nothing").result).startswith("Nothing was found at rest")

    def test_nothing_beside_a_reference_is_not_said_of_rests_alone(self, outcome):
        result = outcome("nothing").result
        beside = {**result, "truth": {**result["truth"], "in_motion": GIVEN}}
        assert frozen(beside).startswith("Nothing was found in the bias, beside the reference, ")

    def test_where_something_is_left_the_firmware_does_not_correct_all(self, outcome):
        said = outcome("unexplained").page.read_text()
        assert "nothing to load: what is left, nothing that was recorded explains" in said

    def test_unexplained(self, outcome):
        said = headline(outcome("unexplained").result)
        assert "mdps are left that nothing recorded explains" in said

    def test_one_recording(self, outcome):
        closed = outcome("one recording")
        assert frozen(closed.result).startswith("Frozen, on the stretches held out, ")
        assert "nothing is confirmed before a second power-on" in closed.page.read_text()
        assert "begins the recording knowing nothing" in closed.page.read_text()
        for name, once in (("one recording", False), ("an effect", True)):
            said = outcome(name).page.read_text()
            assert ("looked at once, at the end" in said) == once
            assert ("the stretches chose among models" in said) == (not once)

    def test_little_is_left_only_where_the_learning_firmware_leaves_less(self, outcome):
        result = outcome("an effect").result
        for left, said in ((0.0, True), (1e9, False)):
            online = {**result["online"], "in_all": {"after_mdps": left}}
            assert ("so little is left" in why_both({**result, "online": online})) == said

    def test_no_temperature(self, outcome):
        text = outcome("no temperature").page.read_text()
        assert "These recordings have no temperature" in text
        assert "plot-residual-temperature" not in text

    def test_an_effect_that_did_not_help_comes_with_a_warning(self, outcome):
        closed = outcome("no temperature")
        whole, some = closed.result["in_all"], any(map(corrects_at_rest, closed.result["effects"]))
        warned = '<p class="warning">' in closed.page.read_text()
        assert warned == (some and whole["after_mdps"] >= whole["before_mdps"])


class TestHostileNames:
    @pytest.fixture
    def text(self, outcome):
        return outcome("hostile names").page.read_text(encoding="utf-8")

    def test_the_channel_was_found_and_is_named(self, outcome):
        steps = outcome("hostile names").result["effects"]
        assert [HOSTILE] in [step["sources"] for step in steps]

    def test_names_make_no_element(self, text):
        read = Reader(text)
        assert read.elements.count("script") == 3
        assert "img" not in read.elements

    def test_the_data_within_the_page_is_whole(self, text):
        plots = json.loads(re.search(r'id="plots">(.*?)</script>', text, re.DOTALL)[1])
        labels = {panel["x_label"] for plot in plots for panel in plot["panels"]}
        assert "\u2068delayed &lt;script&gt;\u2069" in labels

    def test_no_template_of_a_name_is_worked_out(self, text):
        assert "{{7*7}}" in text
