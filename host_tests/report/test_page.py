"""What stands on the page: the numbers of report.json, and strangers' names as text only."""

import re
import shlex
from html.parser import HTMLParser
from pathlib import Path

import pytest
from zerorate_tools.cli import parser
from zerorate_tools.layout import EFFECTS
from zerorate_tools.numbers import figure
from zerorate_tools.report.page import deployment
from zerorate_tools.report.sentences import corrects_at_rest, headline, why_both


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


def some(result):
    """Whether anything was found that corrects the bias at rest."""
    return any(map(corrects_at_rest, result["effects"]))


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


def test_the_headline_is_held_out_before_after_and_floor_then_the_board(closed, read):
    r = closed.result
    assert read.h1 == headline(r) + "."
    held_out, _, board = read.h1.rpartition("board")
    keys = ("before_mdps", "after_mdps") if some(r) else ("after_mdps",)
    said = [figure(r["in_all"][key]) for key in (*keys, "floor_mdps")]
    assert re.findall(r"[\d.]*\d", held_out)[-len(said) :] == said
    assert re.findall(r"[\d.]*\d", board) == [figure(r["online"]["in_all"][key]) for key in keys]
    assert why_both(r) in closed.page.read_text()


def test_it_is_one_file_of_less_than_six_megabytes(closed):
    text = closed.page.read_text(encoding="utf-8")
    assert closed.page.stat().st_size < 6_000_000
    own = re.sub(r"<script>.*?</script>", "", text, count=1, flags=re.DOTALL)
    assert re.findall(r"<(?:link|script|img|iframe)[^>]+(?:src|href)=.(?!data:,)", own) == []


class TestAnswers:
    def test_an_effect_that_did_not_help_comes_with_a_warning(self, outcome):
        closed = outcome("no temperature")
        whole = closed.result["in_all"]
        warned = '<p class="warning">' in closed.page.read_text()
        assert warned == (some(closed.result) and whole["after_mdps"] >= whole["before_mdps"])


class TestHostileNames:
    @pytest.fixture
    def text(self, outcome):
        return outcome("hostile names").page.read_text(encoding="utf-8")

    def test_names_make_no_element(self, text):
        read = Reader(text)
        assert read.elements.count("script") == 3
        assert "img" not in read.elements


PROGRAM = """
from zerorate import Corrector, Sensor
corrector = Corrector(Sensor({scales}))
class imu:
    binding = None
{lines}
value = load = 700
{each}
print("slots", corrector.effects.e[{slots}], list(effects.channels))
"""


def program(closed, told):
    s = closed.scales
    scales = (s.odr_hz, s.gyro_lsb_per_dps, s.accel_lsb_per_g, s.temp_lsb_per_degc)
    given = ", ".join(map(repr, (*scales, s.temp_offset_degc)))
    slots = EFFECTS.SLOT_COUNT
    return PROGRAM.format(scales=given, lines=told.program, each=told.each_reading, slots=slots)


@pytest.mark.parametrize("name", ["an effect", "hostile names"])
def test_the_lines_load_the_model_on_a_micropython(
    outcome, name, find_runtime, repository, tmp_path
):
    closed = outcome(name)
    script = tmp_path / "main.py"
    channels = [s for step in closed.result["effects"] for s in step["sources"] if s != "temp"]
    script.write_text(program(closed, deployment(closed.folder, channels)))
    model = (closed.folder / "model.bin").read_bytes()
    done = find_runtime("wasm").run(
        script, modules=[repository / "firmware"], files_in={"model.bin": model}
    )
    assert done.stdout.split("slots")[1].split()[0] > "0", done.stdout + done.stderr


def test_every_command_of_zerorate_is_one(outcome):
    commands = deployment(outcome("an effect").folder, []).commands.splitlines()
    own = [shlex.split(line)[1:] for line in commands if line.startswith("zerorate ")]
    assert len(own) == 2
    for arguments in own:
        assert parser().parse_args(arguments).run


def test_the_model_is_one_that_the_device_would_load(outcome, capsys):
    line = deployment(outcome("an effect").folder, []).commands.splitlines()[0]
    arguments = parser().parse_args(shlex.split(line)[1:])
    arguments.run(arguments)
    assert capsys.readouterr().out


def test_a_channel_is_named_so_that_python_reads_it_back():
    told = deployment(Path("out"), ["vdd_mv", 'a "b"\n<script>'])
    plain, odd = told.each_reading.splitlines()
    assert plain == "effects.channel('vdd_mv', vdd_mv)"
    assert odd == "effects.channel('a \"b\"\\n<script>', value)"


def test_a_folder_with_a_blank_is_quoted():
    told = deployment(Path("my out"), [])
    assert "--model 'my out/model.bin'" in told.commands
