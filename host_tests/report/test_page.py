"""What stands on the page and in its plots: the numbers of report.json, and names as text only."""

import re
import shlex
from copy import deepcopy
from html.parser import HTMLParser
from pathlib import Path
from shutil import copytree

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from zerorate import Corrector, Sensor
from zerorate_tools.cli import parser
from zerorate_tools.layout import AXIS, EFFECTS, ESTIMATOR, SETTINGS, axis_at
from zerorate_tools.loop.search.curve import FORMS, KIND
from zerorate_tools.model import effects
from zerorate_tools.numbers import figure
from zerorate_tools.recordings import open_recording
from zerorate_tools.replay import replay
from zerorate_tools.report import sentences, write_report
from zerorate_tools.report.estimators import moments
from zerorate_tools.report.page import deployment, plots_of
from zerorate_tools.report.plot import thinned
from zerorate_tools.report.residual_plots import HeldOut, against_time, longest
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


def test_an_effect_in_two_slots_is_named_once_in_the_headline(outcome):
    result = deepcopy(outcome("an effect").result)
    result["effects"] *= 2
    assert headline(result) == headline(outcome("an effect").result)


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

    def test_an_axis_that_an_effect_leaves_as_it_is_comes_with_the_reason(self, outcome, tmp_path):
        closed = outcome("an effect")
        result = deepcopy(closed.result)
        result["effects"][0]["said"] = "lag of temp; not corrected on y, where the error would grow"
        folder = copytree(closed.folder, tmp_path / "closed")
        page = write_report(closed.analysis, result, closed.logs, folder)
        assert "<p>Not corrected on y, where the error would grow.</p>" in page.read_text()


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


@pytest.fixture(scope="module")
def plots(outcome):
    closed = outcome("an effect")
    made, notes = plots_of(closed.analysis, closed.result, closed.logs, closed.folder)
    assert notes == []
    return {plot.key: plot for plot in made}


@given(st.integers(0, 4000), st.integers(0, 2**32 - 1))
def test_thinning_keeps_the_extremes_and_the_order(n, seed):
    y = np.random.default_rng(seed).normal(size=n)
    x, kept = thinned(np.arange(n), y, 300)
    assert len(x) <= max(300, 0) and np.all(np.diff(x) > 0)
    assert np.array_equal(kept, y[x])
    if n:
        assert kept.min() == y.min() and kept.max() == y.max()


def test_thinning_keeps_a_gap():
    y = np.ones(5000)
    y[2000:3000] = np.nan
    assert np.isnan(thinned(np.arange(5000), y, 100)[1]).any()


def test_the_error_drawn_has_the_root_mean_square_that_is_said(outcome, plots):
    for a in range(3):
        for name in ("before", "after"):
            drawn = [s for s in plots["residual-time"].series if s.panel == a and s.name == name]
            rms = np.sqrt(np.nanmean(drawn[0].y ** 2))
            said = outcome("an effect").result[f"{name}_mdps"][a]
            assert rms == pytest.approx(said, abs=1e-4)


def test_the_floor_is_the_lowest_point_of_the_noise(outcome, plots):
    for a, floor in enumerate(outcome("an effect").result["floor_mdps"]):
        noise = [s for s in plots["allan"].series if s.panel == a and s.role == "floor"][0]
        assert plots["allan"].panels[a].lines[0].value == floor
        assert noise.y.min() == pytest.approx(floor, rel=0.05)


def test_every_kind_that_can_be_found_has_words():
    for kind in (*(row.kind for row in effects.EFFECTS), *FORMS, KIND):
        assert sentences.words_of(kind)[1]


@pytest.mark.parametrize(
    ("slot", "unit"),
    [
        ({"source": "temp", "power": 1}, "mdps per °C"),
        ({"source": "temp", "power": 2}, "mdps per °C²"),
        ({"source": "temp", "lag_mode": "rate"}, "mdps per (°C per s)"),
        ({"source": "vdd_mv", "second": "temp"}, "mdps per (mV × °C)"),
        ({"source": "load", "power": 2}, "mdps per (unit of load)²"),
        ({"source": "one", "decay_s": 300.0}, "mdps"),
    ],
)
def test_a_coefficient_has_its_unit(slot, unit):
    assert sentences.per_unit(slot) == unit


@pytest.fixture(scope="module")
def log(outcome):
    return outcome("an effect").logs[0]


@pytest.fixture(scope="module")
def seen(log):
    return moments([log], None, 300.0)


def test_the_last_moment_is_the_state_that_a_replay_ends_in(log, seen):
    state = np.frombuffer(replay(log).state, "<i4")
    scales = open_recording(log).scales
    settings = Corrector(
        Sensor(
            *(scales.odr_hz, scales.gyro_lsb_per_dps, scales.accel_lsb_per_g),
            *(scales.temp_lsb_per_degc, scales.temp_offset_degc),
        )
    ).settings
    for axis in range(3):
        first = axis_at(settings, axis) + AXIS.ESTIMATORS + ESTIMATOR.EST_BIAS_Q8
        biases = state[first :: settings[SETTINGS.ESTIMATOR_WORDS]] / 256 / scales.gyro_lsb_per_dps
        biases = biases[: settings[SETTINGS.ESTIMATOR_COUNT]]
        shown = [e.bias_dps for e in seen[-1].axes[axis]]
        assert shown[0] == pytest.approx(biases[0])
        assert set(np.round(shown, 9)) <= set(np.round(biases, 9))


def part(blocks, gap=None, name="a"):
    left = np.ones((blocks, 3))
    if gap is not None:
        left[gap] = np.nan
    minutes = (np.arange(blocks) + 0.5) / 3
    return HeldOut(name, minutes, 20.0, None, np.zeros(blocks, int), left, left / 2, 0)


def test_the_longest_stretch_has_nine_blocks_or_is_none():
    assert longest([part(8), part(19, 10)])[1].shape == (10, 3)
    assert longest([part(9)])[1].shape == (9, 3) and longest([part(8)]) is None


def test_held_out_recordings_are_laid_end_to_end():
    step = {"recording": "b", "t_us": 60_000_000}
    plot = against_time([part(9), part(12, name="b")], [step])
    assert plot.series[-1].x[0] == pytest.approx(9 / 3 + 0.5 / 3)
    assert [line.value for line in plot.panels[0].lines] == [0.0, pytest.approx(9 / 3 + 1.0)]
