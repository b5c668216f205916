"""What is typed reaches the function behind a command, what that returns is printed, and the code
that the shell gets says how it went."""

import argparse
import errno
import io
import json
import os
import sys
import time
from collections import namedtuple
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from zerorate_tools import cli
from zerorate_tools.commands.options import above_zero, finite, print_json
from zerorate_tools.errors import MissingRuntime, ZerorateError
from zerorate_tools.recordings import Recording, Scales, write_recording

SCALES = Scales("X", 10.0, 131.0)


class Called:
    """Stands in the place of a function: notes how it was called."""

    def __init__(self, result=None):
        self.result, self.calls = result, []

    def __call__(self, *arguments, **named):
        named.pop("advance", None)
        named.pop("done", None)
        self.calls.append((arguments, named))
        if isinstance(self.result, Exception):
            raise self.result
        return self.result

    @property
    def call(self):
        [one] = self.calls
        return one


@pytest.fixture
def stands_in(monkeypatch):
    """stands_in(path of a name, what it returns or raises): the Called in its place."""

    def put(path, result=None):
        called = Called(result)
        monkeypatch.setattr(path, called)
        return called

    return put


@pytest.fixture(autouse=True)
def steps(monkeypatch, tmp_path):
    """[what is said of long work, how much of it there is, what was done]; a folder of its own."""
    monkeypatch.chdir(tmp_path)
    seen = []

    @contextmanager
    def progress(what, total=None):
        done = []
        seen.append((what, total, done))
        yield done.append

    monkeypatch.setattr("zerorate_tools.progress.progress", progress)
    return seen


def refused(*words):
    """Whether the usage is said, and 2 returned."""
    with pytest.raises(SystemExit) as ended:
        cli.main([*words])
    return ended.value.code == 2


def a_log(path="run.parquet", n=4):
    columns = {name: np.arange(n) for name in ("t_us", "gx", "gy", "gz")}
    write_recording(Recording(columns, SCALES, "run"), path)
    return path


# --- numbers ---


@pytest.mark.parametrize("text", ["nan", "inf", "-inf"])
def test_what_is_no_finite_number_is_refused(text):
    for kind in (finite, above_zero):
        with pytest.raises(argparse.ArgumentTypeError):
            kind(text)


@pytest.mark.parametrize(
    ("text", "taken"),
    [
        ("1e-9", True),
        ("1e9", True),
        ("0.5", True),
        ("1", True),
        ("0", False),
        ("-1", False),
        ("1000000001", False),
        ("1e10", False),
    ],
)
def test_a_rate_or_a_time_is_above_zero_and_at_most_a_billion(text, taken):
    assert finite(text) == float(text)
    if taken:
        assert above_zero(text) == float(text)
    else:
        with pytest.raises(argparse.ArgumentTypeError):
            above_zero(text)


# --- JSON ---


@dataclass
class Of:
    path: Path
    numbers: tuple


def test_json_has_plain_values_and_null_where_there_is_no_number(capsys):
    found = {
        1: Of(Path("a/b"), (1, np.float32(0.5), np.arange(2))),
        "none": [float("nan"), float("inf"), np.nan, True, None, "text"],
        "set": {3},
        "frozen": frozenset([4]),
        "kind": {"of": Of},
    }
    del found["kind"]
    print_json(found)
    said = capsys.readouterr().out
    assert json.loads(said) == {
        "1": {"path": "a/b", "numbers": [1, 0.5, [0, 1]]},
        "none": [None, None, None, True, None, "text"],
        "set": [3],
        "frozen": [4],
    }
    assert said.startswith('{\n "1"')
    with pytest.raises(TypeError):
        print_json(Of)


# --- demo ---


def test_without_its_package_bench_says_what_to_install(monkeypatch, capsys):
    from zerorate_tools.commands import demo

    monkeypatch.setattr(demo, "find_spec", lambda name: None)
    assert cli.main(["bench", "accuracy"]) == 2
    assert "the wheel has no benchmarks" in capsys.readouterr().err


def test_with_its_package_bench_has_its_benches():
    assert refused("bench", "none-such")


# --- close ---


@pytest.mark.parametrize("in_motion", [False, True])
def test_close_is_given_what_was_typed_and_prints_what_it_found(
    stands_in, capsys, steps, in_motion
):
    result = {"verdict": "x", **({"in_motion": 1} if in_motion else {})}
    close = stands_in("zerorate_tools.closing.close", result)
    stands_in("zerorate_tools.closing_in_motion.motion_in_words", "in motion")
    stands_in("zerorate_tools.loop.report.in_words.in_words", "the words")
    stands_in("zerorate_tools.report.sentences.headline", "the headline")
    why = stands_in("zerorate_tools.report.sentences.why_both", "")
    assert cli.main(["close", "a.csv", "b.csv", "--out", "o"]) == 0
    (logs, out, holdout, _), named = close.call
    assert (logs, out, holdout) == ([Path("a.csv"), Path("b.csv")], Path("o"), None)
    assert named == {"online": False} and steps[0][1] == 4
    words = ["in motion"] if in_motion else ["the headline.", "the words"]
    assert capsys.readouterr().out.splitlines() == [*words, "report: o/report.html"]
    why.result = "why"
    close.calls.clear()
    assert cli.main(["close", "a.csv", "--out", "o", "--online", "--holdout", "a.csv"]) == 0
    assert close.call[0][2] == "a.csv" and close.call[1] == {"online": True}
    assert ("why" in capsys.readouterr().out.splitlines()) is not in_motion
    assert cli.main(["close", "a.csv", "--out", "o", "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == {**result, "folder": "o"}


def test_close_needs_a_log_and_a_folder_and_allan_a_log():
    assert refused("close", "a.csv") and refused("close", "--out", "o") and refused("allan")


# --- compare ---


WON = SimpleNamespace(deployed=True, tolist=lambda: "won")
COMPARED = SimpleNamespace(figures=lambda: {"ways": 1})


@pytest.fixture
def comparing(stands_in):
    stands_in("zerorate_tools.compare.show.table", "the table")
    stands_in("zerorate_tools.compare.show.in_motion", "in motion")
    return SimpleNamespace(
        matrix=stands_in("zerorate_tools.compare.matrix_of", None),
        compare=stands_in("zerorate_tools.compare.compare", COMPARED),
        page=stands_in("zerorate_tools.compare.show.write_page"),
    )


def test_compare_prints_the_table_and_what_motion_won_and_writes_a_page(comparing, capsys, steps):
    assert cli.main(["compare", "a.csv", "b.csv"]) == 0
    assert capsys.readouterr().out == "the table\n" and not comparing.page.calls
    what, total, done = steps[0]
    assert total == 6 and done == [1]
    comparing.matrix.result = WON
    assert cli.main(["compare", "a.csv", "--out", "p.html"]) == 0
    assert capsys.readouterr().out == "the table\n\nin motion\n\np.html\n"
    assert comparing.page.call[0] == (COMPARED, Path("p.html"), WON, ["a.csv"])
    assert cli.main(["compare", "a.csv", "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == {"ways": 1, "in_motion": "won", "page": None}


@pytest.mark.parametrize(("won", "code"), [(None, 2), (SimpleNamespace(deployed=False), 0)])
def test_without_rests_what_the_motion_shows_is_said(comparing, capsys, won, code):
    from zerorate_tools.compare import TooFewRests

    comparing.matrix.result, comparing.compare.result = won, TooFewRests("a.csv", "too few")
    assert cli.main(["compare", "a.csv", "--out", "p.html"]) == code
    ended = capsys.readouterr()
    assert ended.out.endswith("in motion\n\np.html\n") == (code == 0)
    assert ("too few" in ended.err) == (code == 2) != bool(comparing.page.calls)


# --- cut ---


def test_cut_takes_rows_from_the_second_on_and_prints_the_parts(stands_in, capsys):
    cut = stands_in("zerorate_tools.importers.cut", ["one", "two"])
    assert cli.main(["cut", "x.csv", "--at-row", "2", "--at-row", "9", "--out", "o"]) == 0
    assert cut.call[0] == (Path("x.csv"), [2, 9], Path("o"))
    assert capsys.readouterr().out == "one\ntwo\n"
    assert refused("cut", "x.csv", "--out", "o") and refused("cut", "x.csv", "--at-row", "2")
    for row in ("1", "0", "-3", "x"):
        assert refused("cut", "x.csv", "--at-row", row, "--out", "o")


# --- demo ---


def shown(same):
    return SimpleNamespace(same_state=same)


@pytest.mark.parametrize(
    ("same", "code"), [((True,) * 3, 0), ((False, True, True), 1), ((True, True, False), 1)]
)
def test_the_demo_tells_its_story_and_ends_with_1_where_interpreters_disagree(
    stands_in, monkeypatch, tmp_path, same, code
):
    find = stands_in("zerorate_tools.runtimes.find")
    device = SimpleNamespace(logs=["l"])
    stands_in("zerorate_tools.demo.make_device", device)
    first, before, after = map(shown, same)
    pipe, told, back = io.TextIOWrapper(io.BytesIO()), [], []
    monkeypatch.setattr("sys.stdout", pipe)

    def begun(name, result, calls):
        def work(*arguments):
            told.append(pipe.buffer.getvalue().decode().split()[-1])
            calls.append(arguments)
            return result

        monkeypatch.setattr(f"zerorate_tools.demo.{name}", work)

    begun("first_power_on", first, [])
    begun("closed", "closed", [])
    begun("back_on_the_chip", (before, after), back)
    stands_in("zerorate_tools.compare.compare", "found")
    page = stands_in("zerorate_tools.compare.show.write_page")
    for name in ("opening", "chapter_one", "chapter_two", "chapter_three", "compared"):
        stands_in(f"zerorate_tools.demo.story.{name}", name)
    ending = stands_in("zerorate_tools.demo.story.ending", "the end")

    def draw(one, two, three, path):
        assert (one, two, three) == (first, before, after)
        path.write_text("a picture")

    monkeypatch.setattr("zerorate_tools.demo.picture.draw_job", draw)
    (tmp_path / "deep").mkdir()
    (tmp_path / "deep" / "report.html").write_text("")
    assert cli.main(["demo", "--out", "deep", "--runtime", "x86"]) == code
    pipe.flush()
    chapters = ["opening", "chapter_one", "chapter_two", "chapter_three", "compared", "the", "end"]
    assert pipe.buffer.getvalue().decode().split() == chapters
    assert told == chapters[:3]  # each is read while the next is made, in a pipe too
    assert find.call[0] == ("x86",)
    assert back == [(device, Path("deep/model.bin"), "x86")]
    assert page.call[0] == ("found", Path("deep/compare.html"))
    assert (tmp_path / "deep" / "demo.png").read_text() == "a picture"
    [report, drawn] = ending.call[0][0]
    assert report[0] == Path("deep/report.html") and drawn[0] == Path("deep/demo.png")


def test_a_picture_makes_the_folders_above_it(tmp_path):
    from zerorate_tools.commands.demo import draw_into

    path = draw_into(tmp_path / "a" / "b", lambda text, out: out.write_text(text), "drawn")
    assert path == tmp_path / "a" / "b" / "demo.png" and path.read_text() == "drawn"
    assert draw_into(tmp_path / "a" / "b", lambda out: out.write_text("again")) == path


def test_the_demo_of_a_real_recording_ends_with_0(stands_in, capsys, steps):
    stands_in("zerorate_tools.runtimes.find")
    stands_in("zerorate_tools.demo.broad.broad_trial", "trial")
    real = stands_in("zerorate_tools.demo.real.real", "figures")
    story = stands_in("zerorate_tools.demo.story.real_trial", "told")
    assert cli.main(["demo", "--real"]) == 0
    assert capsys.readouterr().out == "told\n" and story.call[0] == ("figures", "wasm")
    assert real.call[0][:2] == ("trial", "wasm") and [total for _, total, _ in steps] == [None, 4]


def test_an_interpreter_of_ones_own_is_not_fetched(stands_in, capsys):
    stands_in("zerorate_tools.runtimes.find", MissingRuntime("not there"))
    fetch = stands_in("zerorate_tools.runtimes.fetch")
    assert cli.main(["demo", "--runtime", "./mine"]) == 2 and not fetch.calls
    assert "not there" in capsys.readouterr().err


# --- export ---


def test_export_is_given_the_scales_of_an_mpu6050_or_those_typed(stands_in, capsys):
    export = stands_in("zerorate_tools.kernels.export.export_c", ["one", "two"])
    assert cli.main(["export", "c", "o"]) == 0
    folder, sensor, model = export.call[0]
    of = ("odr_hz", "gyro_lsb_per_dps", "accel_lsb_per_g", "temp_lsb_per_degc")
    assert (folder, model) == (Path("o"), None) and capsys.readouterr().out == "one\ntwo\n"
    assert [getattr(sensor, name) for name in of] == [100, 131, 16384, 340]
    export.calls.clear()
    typed = {"odr-hz": 50, "gyro-lsb-per-dps": 65, "accel-lsb-per-g": 0, "temp-lsb-per-degc": 0}
    words = [w for name, value in typed.items() for w in (f"--{name}", str(value))]
    assert cli.main(["export", "c", "o", *words, "--model", "m.bin"]) == 0
    _, sensor, model = export.call[0]
    assert [sensor.odr_hz, sensor.gyro_lsb_per_dps, model] == [50, 65, Path("m.bin")]
    assert not sensor.accel_lsb_per_g and not sensor.temp_lsb_per_degc
    assert cli.main(["export", "c", "o", "--odr-hz", "-1"]) == 2
    assert refused("export")


# --- fleet ---


@pytest.mark.parametrize(("sessions", "code"), [(3, 0), (1, 0), (0, 1)])
def test_fleet_is_given_what_was_typed_and_ends_with_1_where_nothing_could_be_used(
    stands_in, capsys, steps, sessions, code
):
    devices_of = stands_in("zerorate_tools.fleet.devices_of", ["a", "b"])
    done = SimpleNamespace(resumed=1, report={"sessions": sessions})
    fleet = stands_in("zerorate_tools.fleet.fleet", done)
    stands_in("zerorate_tools.fleet.fleet_in_words.in_words", "in words")
    assert cli.main(["fleet", "x", "y", "--out", "o"]) == code
    assert capsys.readouterr().out == "in words\nwritten: o\n"
    assert devices_of.call == ((["x", "y"], None), {"without": Path("o")})
    plain = dict.fromkeys(("scheduler", "workers", "devices_per_task", "model"))
    plain |= {"job": "replay", "keep": False, "minutes": 5.0}
    assert fleet.call == ((["a", "b"], Path("o")), plain) and steps[0][1] == 2
    fleet.calls.clear()
    words = "--job close --device-from (.) --keep --model m --minutes 2.5 --scheduler tcp://h:1"
    words += " --workers 1 --devices-per-task 3 --json"
    assert cli.main(["fleet", "x", "--out", "o", *words.split()]) == code
    assert devices_of.calls[1][0] == (["x"], "(.)")
    assert fleet.call[1] == {
        **{"job": "close", "scheduler": "tcp://h:1", "workers": 1, "devices_per_task": 3},
        **{"model": Path("m"), "keep": True, "minutes": 2.5},
    }
    expected = {"written": "o", "resumed": 1, "sessions": sessions}
    assert json.loads(capsys.readouterr().out) == expected


def test_fleet_refuses_a_folder_of_a_store_no_worker_and_no_minutes():
    for words in ("--out s3://x/y", "--out o --workers 0", "--out o --minutes 0", "--job replay"):
        assert refused("fleet", "x", *words.split())
    assert refused("fleet", "x", "--out", "o", "--workers", "-1")


# --- flash ---


def test_flash_is_given_what_was_typed(stands_in):
    flash = stands_in("zerorate_tools.boards.flashing.flash")
    assert cli.main(["flash", "P"]) == 0
    plain = {"dry_run": False, "main": None, "model": None, "parts": [], "only": False}
    assert flash.call == (("P",), plain)
    words = "--dry-run --with motion,gravity --only --main m.py --model m.bin"
    assert cli.main(["flash", "P", *words.split()]) == 0
    assert flash.calls[1][1] == {
        **{"dry_run": True, "main": Path("m.py"), "model": Path("m.bin"), "only": True},
        "parts": ["motion", "gravity"],
    }


# --- import ---


class Report:
    def __init__(self):
        self.rows_read = 7

    def lines(self):
        return ["first", "second"]


@pytest.fixture
def importing(stands_in):
    return SimpleNamespace(
        one=stands_in("zerorate_tools.importers.import_recording", Report()),
        several=stands_in(
            "zerorate_tools.importers.import_together", {Path("o/a.parquet"): Report()}
        ),
    )


def test_import_is_given_what_was_typed(importing, capsys, steps):
    Path("a.csv").write_text("12345")
    assert cli.main(["import", "a.csv", "--out", "o.csv"]) == 0
    assert capsys.readouterr().out.splitlines() == ["o.csv", "  first", "  second"]
    (source, out), named = importing.one.call
    assert (source, out) == ([Path("a.csv")], Path("o.csv")) and steps[0][:2] == (
        "importing a.csv",
        5,
    )
    assert (named["mapping"], named["units"], named["instance"]) == ([], {}, 0)
    assert named["options"].hz is None and named["options"].sensor is None
    words = "--hz 1/4 --sensor S --gyro-lsb-per-dps 2 --accel-lsb-per-g 3 --temp-lsb-per-degc 4"
    words += " --temp-offset-degc -5 --time-unit MS --gyro-unit dps --accel-unit G --temp-unit K"
    words += " --instance 2 --map gx=x:dps --json"
    assert cli.main(["import", "a.csv", "--out", "o.csv", *words.split()]) == 0
    named = importing.one.calls[1][1]
    how = named["options"]
    scales = how.gyro_lsb_per_dps, how.accel_lsb_per_g, how.temp_lsb_per_degc, how.temp_offset_degc
    assert (how.hz, how.sensor, scales) == (0.25, "S", (2, 3, 4, -5))
    assert named["units"] == {"time": "ms", "gyro": "dps", "accel": "g", "temp": "k"}
    assert named["instance"] == 2 and len(named["mapping"]) == 1
    assert json.loads(capsys.readouterr().out) == {
        "recordings": [{"file": "o.csv", "rows_read": 7}]
    }


def test_several_recordings_or_a_folder_are_imported_together(importing, capsys, steps):
    assert cli.main(["import", "a.csv", "b.csv", "--out", "o"]) == 0
    assert importing.several.call[0] == ([Path("a.csv"), Path("b.csv")], Path("o"))
    assert steps[0][1] is None  # neither is there
    Path("o").mkdir()
    assert cli.main(["import", "a.csv", "--out", "o"]) == 0
    assert len(importing.several.calls) == 2 and not importing.one.calls
    assert capsys.readouterr().out.splitlines()[0] == "o/a.parquet"


@pytest.mark.parametrize(
    "words",
    [
        "",
        "--out o --hz 0",
        "--out o --hz 1/0",
        "--out o --map gx",
        "--out o --temp-offset-degc nan",
    ],
)
def test_import_refuses_what_cannot_be(words):
    assert refused("import", "a.csv", *words.split())


@pytest.mark.parametrize(("text", "hz"), [("50", 50.0), ("1/15", 1 / 15), ("3/2", 1.5)])
def test_a_rate_may_be_a_fraction(importing, text, hz):
    assert cli.main(["import", "a.csv", "--out", "o.csv", "--hz", text]) == 0
    assert importing.one.call[1]["options"].hz == hz


# --- model ---


def test_a_model_is_shown_in_words_or_as_json(stands_in, capsys):
    read = stands_in("zerorate_tools.model.read_model", "model")
    stands_in("zerorate_tools.model.to_json", "{}\n")
    stands_in("zerorate_tools.model.model_in_words.in_words", "in words")
    assert cli.main(["model", "show", "m.bin"]) == 0 and read.call[0] == (Path("m.bin"),)
    assert cli.main(["model", "show", "m.bin", "--json"]) == 0
    assert capsys.readouterr().out == "in words\n{}\n"
    assert refused("model")


@pytest.mark.parametrize(
    ("found", "code", "said"), [([], 0, "the same to the last bit\n"), (["a", "b"], 1, "a\nb\n")]
)
def test_two_models_that_differ_end_with_1(stands_in, capsys, found, code, said):
    stands_in("zerorate_tools.model.read_model", "model")
    stands_in("zerorate_tools.model.model_in_words.differences", found)
    assert cli.main(["model", "diff", "a", "b"]) == code
    assert capsys.readouterr().out == said


def test_a_model_is_checked_for_the_device_that_was_described(stands_in, capsys):
    check = stands_in("zerorate_tools.model.files.check_model", "model")
    stands_in("zerorate_tools.model.model_in_words.slots_in_words", "two slots")
    assert cli.main(["model", "check", "m.bin"]) == 0
    assert capsys.readouterr().out == "m.bin: good, two slots\n"
    (path,), named = check.call
    device = named["device"]
    assert path == Path("m.bin") and named["scales"] is None
    assert (device.chip_id, device.gyro_range, device.accel_range, device.filter) == (None,) * 4
    words = f"--chip-id 0x68 --gyro-range 1 --accel-range 0 --filter 254 --log {a_log()}"
    assert cli.main(["model", "check", "m.bin", *words.split()]) == 0
    named = check.calls[1][1]
    device = named["device"]
    assert (device.chip_id, device.gyro_range, device.accel_range, device.filter) == (
        0x68,
        1,
        0,
        254,
    )
    assert named["scales"] == SCALES
    for code in ("255", "-1", "0x100", "x"):
        assert refused("model", "check", "m.bin", "--chip-id", code)


# --- record ---


Recorded = namedtuple("Recorded", "samples")


@pytest.mark.parametrize(("samples", "code"), [(5, 0), (1, 0), (0, 1)])
def test_record_is_given_what_was_typed_and_ends_with_1_without_a_sample(
    stands_in, capsys, steps, samples, code
):
    record = stands_in("zerorate_tools.boards.recording.record", Recorded(samples))
    assert cli.main(["record", "/dev/i2c-1", "--out", "o.csv"]) == code
    assert record.call == (("/dev/i2c-1", Path("o.csv")), {"seconds": None})
    assert ("no sample came" in capsys.readouterr().out) == (code == 1)
    Path("s.py").write_text("imu = 1")
    words = "--seconds 9 --address 0x69 --hz 50 --dps 500 --g 4 --dlpf-hz 20 --part P --setup s.py"
    assert cli.main(["record", "0", "--out", "o.csv", *words.split()]) == code
    assert record.calls[1][1] == {
        **{"seconds": 9, "address": 0x69, "odr_hz": 50, "full_scale_dps": 500, "full_scale_g": 4},
        **{"dlpf_hz": 20, "part": "P", "setup": "imu = 1"},
    }
    assert [total for _, total, _ in steps] == [None, 9]


def test_record_says_what_a_killed_one_left(stands_in, capsys):
    stands_in("zerorate_tools.boards.recording.record", Recorded(1))
    stands_in("zerorate_tools.recordings.growing.left_over", ["a.partial.csv", "b.partial.csv"])
    cli.main(["record", "0", "--out", "o.csv"])
    said = capsys.readouterr().err.splitlines()
    assert [line.partition(":")[0] for line in said] == ["a.partial.csv", "b.partial.csv"]
    assert "--recover b.partial.csv" in said[1]


@pytest.mark.parametrize("words", ["", "P --recover x.csv", "P", "--out o.csv"])
def test_record_needs_a_port_and_a_file_or_what_to_recover(words, capsys):
    assert cli.main(["record", *words.split()]) == 2
    assert "name " in capsys.readouterr().err


def test_record_finishes_what_a_killed_one_left(stands_in, capsys):
    target = a_log("whole.csv", 6)
    recover = stands_in("zerorate_tools.recordings.recover", target)
    assert cli.main(["record", "--recover", "x.partial.csv"]) == 0
    assert recover.call[0] == (Path("x.partial.csv"), None)
    assert capsys.readouterr().out == "whole.csv: 6 samples of x.partial.csv\n"


@pytest.mark.parametrize("known", [None, False, True])
@pytest.mark.parametrize("samples", [0, 5])
@pytest.mark.parametrize("port", ["fake:", "0"])
def test_a_guided_recording_says_what_is_not_known_yet_and_what_comes_next(
    stands_in, monkeypatch, capsys, known, samples, port
):
    record = stands_in("zerorate_tools.boards.recording.record", Recorded(samples))
    stands_in("zerorate_tools.guide.unknown", ["x", "y"])
    waits = []

    @contextmanager
    def guide(shown, waits_):
        waits.append(waits_)
        told = None if known is None else SimpleNamespace(all_known=known)
        yield SimpleNamespace(known=told, done=None, heard="heard")

    monkeypatch.setattr("zerorate_tools.guide.Guide", lambda shown, waits: guide(shown, waits))
    code = cli.main(["record", port, "--out", "o.csv", "--guide", "--seconds", "4"])
    said = capsys.readouterr().out
    assert code == (0 if samples else 1) and waits == [port == "fake:"]
    assert ("not known yet: x, y" in said) == (known is False)
    assert ("next: zerorate close o.csv --out closed" in said) == (samples > 0)
    assert record.call == ((port, Path("o.csv")), {"seconds": 4, "heard": "heard"})


# --- replay ---


DONE = SimpleNamespace(
    samples=8, verdicts={"still": 6, "moving": 2}, sources={"none": 8}, explanation="one\ntwo"
)


def test_replay_is_given_what_was_typed_and_prints_shares(stands_in, capsys, steps):
    replay = stands_in("zerorate_tools.replay.replay", DONE)
    assert cli.main(["replay", a_log(), "--out", "o.parquet"]) == 0
    said = capsys.readouterr().out.splitlines()
    assert said[0] == "o.parquet: 8 samples" and said[3:] == ["  one", "  two"]
    assert "still 6 (75.0%), moving 2 (25.0%)" in said[1] and "none 8 (100.0%)" in said[2]
    plain = dict.fromkeys(("state", "from_state", "model")) | {"runtime": "native", "resume": False}
    options = {"document": False, "motion": None, "gravity": None}
    assert replay.call == ((Path("run.parquet"), Path("o.parquet")), {**plain, "options": options})
    assert steps[0][1] == 4
    words = (
        "--runtime x86 --state s --from-state f --resume --model m --motion --no-gravity --every"
    )
    words += " --set step_degc=2 --set bins=8 --set short=2 --set long=4 --json"
    assert cli.main(["replay", "run.parquet", "--out", "o.parquet", *words.split()]) == 0
    named = replay.calls[1][1]
    options = named.pop("options")
    assert named == {
        **{"runtime": "x86", "state": Path("s"), "from_state": Path("f"), "resume": True},
        "model": Path("m"),
    }
    assert options == {
        **{"step_degc": 2.0, "bins": 8, "short": 2, "long": 4, "document": False, "every": True},
        **{"motion": True, "gravity": False},
    }
    assert all(type(options[name]) is int for name in ("bins", "short", "long"))
    assert type(options["step_degc"]) is float
    told = json.loads(capsys.readouterr().out)
    assert told == {
        **{"file": "o.parquet", "samples": 8, "verdicts": DONE.verdicts, "sources": DONE.sources},
        "explanation": "one\ntwo",
    }
    assert cli.main(["replay", "run.parquet", "--out", "o.parquet", "--document", "--rests"]) == 0
    options = replay.calls[2][1]["options"]
    assert options["document"] is True and options["every"] is False


@pytest.mark.parametrize(
    "words",
    [
        *("--resume", "--rests", "--rests --every", "--rests --document --every"),
        *("--set bins", "--set bins=x", "--set bins=inf"),
    ],
)
def test_replay_refuses_words_that_do_not_go_together(words):
    assert refused("replay", a_log(), "--out", "o.parquet", *words.split())


def test_replay_needs_a_file_to_write_and_keeps_the_gaps_of_channels(stands_in):
    stands_in("zerorate_tools.replay.replay", DONE)
    opened = stands_in("zerorate_tools.recordings.open_recording", SimpleNamespace(n_samples=3))
    assert refused("replay", "x.csv")
    assert cli.main(["replay", "x.csv", "--out", "o.parquet"]) == 0
    assert opened.call == ((Path("x.csv"),), {"keep_gaps": True})


# --- run ---


@pytest.fixture
def serving(stands_in, monkeypatch):
    """What the service is made of, and what opens a bus of Linux."""
    service = stands_in("zerorate_tools.service.Service", SimpleNamespace(run=lambda: None))
    stands_in("signal.signal")
    imu = stands_in("zerorate_i2c.mpu6050.MPU6050", "imu")
    bus = SimpleNamespace(close=Called())
    linux = stands_in("zerorate_i2c.linux.LinuxI2C", bus)
    made = {
        name: stands_in(f"zerorate_tools.service.{name}", name)
        for name in ("Datagrams", "Metrics", "UnixSocket", "Lines", "FakeBus")
    }
    return SimpleNamespace(service=service, imu=imu, bus=bus, linux=linux, **made)


def test_run_serves_lines_of_an_mpu6050_at_100_hz_unless_told(serving, capsys):
    assert cli.main(["run", "/dev/i2c-7"]) == 0
    system, sinks, model = serving.service.call[0]
    assert sinks == ["Lines"] and model == b"" and not serving.FakeBus.calls
    assert system.open_imu() == "imu" and serving.linux.call[0] == ("/dev/i2c-7",)
    (bus, address), named = serving.imu.call
    assert (bus, address) == (serving.bus, 0x68)
    plain = {"odr_hz": 100.0, "full_scale_dps": 250, "full_scale_g": 2}
    assert named == {**plain, "dlpf_hz": None, "part": None}
    Path("learned.bin").touch()
    os.utime("learned.bin", (0, time.time() - 500))
    assert system.stored_ago_s() == pytest.approx(500, abs=60)
    system.say("a line")
    assert capsys.readouterr().err == "a line\n"


def test_run_is_given_what_was_typed(serving):
    Path("m.bin").write_bytes(b"model")
    words = "--address 0x69 --hz 50 --dps 500 --g 8 --dlpf-hz 20 --part P --model m.bin"
    words += " --udp h:1 --metrics h:2 --socket s --remote"
    assert cli.main(["run", "fake:", *words.split()]) == 0
    system, sinks, model = serving.service.call[0]
    assert sinks == ["Datagrams", "Metrics", "UnixSocket"] and model == b"model"
    assert serving.Datagrams.call[0] == ("h:1", True) and serving.Metrics.call[0] == ("h:2", True)
    assert serving.FakeBus.call[0] == (0x69, "P") and system.open_imu() == "imu"
    (bus, address), named = serving.imu.call
    assert (bus, address) == ("FakeBus", 0x69) and not serving.linux.calls
    typed = {"odr_hz": 50, "full_scale_dps": 500, "full_scale_g": 8, "dlpf_hz": 20, "part": "P"}
    assert named == typed
    assert cli.main(["run", "fake:", "--udp", "h:1"]) == 0
    assert serving.Datagrams.calls[1][0] == ("h:1", False)


def test_a_model_in_words_is_turned_into_bytes_for_the_service(serving, stands_in):
    read = stands_in("zerorate_tools.model.read_model", "model")
    stands_in("zerorate_tools.model.encoded", b"bytes of it")
    cli.main(["run", "fake:", "--model", "m.json"])
    assert serving.service.call[0][2] == b"bytes of it" and read.call[0] == (Path("m.json"),)


def test_an_open_bus_is_closed_where_no_chip_answers_and_a_wrong_setting_is_one_line(serving):
    cli.main(["run", "/dev/i2c-7"])
    open_imu = serving.service.call[0][0].open_imu
    serving.imu.result = OSError("nothing answers")
    with pytest.raises(OSError, match="nothing answers"):
        open_imu()
    assert len(serving.bus.close.calls) == 1
    serving.imu.result = ValueError("no such rate")
    with pytest.raises(ZerorateError, match="no such rate"):
        open_imu()
    serving.linux.result = OSError(errno.ENOTTY, "no ioctl")
    with pytest.raises(ZerorateError, match="no I2C bus"):
        open_imu()
    for number in (errno.ENOENT, errno.EACCES):
        serving.linux.result = OSError(number, "not there yet")
        with pytest.raises(OSError, match="not there yet"):
            open_imu()


def test_run_needs_the_folder_of_its_state(serving, capsys):
    assert cli.main(["run", "fake:", "--state", "no/learned.bin"]) == 2
    assert not serving.service.calls and capsys.readouterr().err.startswith("zerorate: no: ")


# --- runtimes ---


def test_runtimes_are_fetched_in_turn_and_2_says_that_one_could_not_be(stands_in, capsys):
    fetch = stands_in("zerorate_tools.runtimes.fetch")
    pico = stands_in("zerorate_bench.boards.pico.fetch_rp2040")
    assert cli.main(["runtimes", "get", "wasm", "rp2040", "x64"]) == 0
    assert [call[0] for call in fetch.calls] == [("wasm",), ("x64",)] and len(pico.calls) == 1
    assert capsys.readouterr().out == "wasm: ready\nrp2040: ready\nx64: ready\n"
    fetch.result = MissingRuntime("cannot be had")
    assert cli.main(["runtimes", "get", "wasm", "rp2040", "x64"]) == 2
    ended = capsys.readouterr()
    assert ended.out == "rp2040: ready\n"
    assert ended.err == "zerorate: wasm: cannot be had\nzerorate: x64: cannot be had\n"
    assert refused("runtimes", "get", "vax") and refused("runtimes")


def test_the_emulated_pico_is_in_a_checkout_only(monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "zerorate_bench.boards.pico", None)
    assert cli.main(["runtimes", "get", "rp2040"]) == 2
    assert "in a checkout only" in capsys.readouterr().err


def test_runtimes_are_listed_with_how_to_get_those_missing(monkeypatch, capsys):
    def find(name):
        if name == "x86":
            raise MissingRuntime("zerorate runtimes get x86")

    monkeypatch.setattr("zerorate_tools.runtimes.find", find)
    assert cli.main(["runtimes", "list"]) == 0
    said = dict(line.split(maxsplit=1) for line in capsys.readouterr().out.splitlines())
    assert said["x86"] == "missing: zerorate runtimes get x86"
    assert {said["wasm"], said["armhf"], said["x64"]} == {"ready"}


def test_the_node_that_wasm_would_use_is_said(stands_in, capsys):
    stands_in("zerorate_tools.runtimes.node.node_command", ["node", "-x"])
    stands_in("zerorate_tools.runtimes.node.npm_command", ["npm"])
    assert cli.main(["runtimes", "node"]) == 0
    assert capsys.readouterr().out == "node -x\nnpm\n"


# --- simulate ---


def test_simulate_is_given_what_was_typed_and_lists_what_there_is(stands_in, capsys, steps):
    described = SimpleNamespace(name="car", sessions=[1, 2, 3])
    load = stands_in("zerorate_tools.simulate.load_description", described)
    files = stands_in("zerorate_tools.simulate.simulate_to_files", ["a", "b"])
    stands_in("zerorate_tools.simulate.bundled_names", ["car", "drone"])
    stands_in("zerorate_tools.simulate.reference", "what may be said")
    assert cli.main(["simulate", "car", "--out", "o.csv"]) == 0
    plain = dict.fromkeys(("truth", "session", "seed"))
    assert load.call[0] == ("car",) and files.call == ((described, Path("o.csv")), plain)
    words = "--truth t.parquet --session 2 --seed 0"
    assert cli.main(["simulate", "car", "--out", "o.csv", *words.split()]) == 0
    typed = {"truth": Path("t.parquet"), "session": 2, "seed": 0}
    assert files.calls[1][1] == typed and [total for _, total, _ in steps] == [3, 1]
    assert capsys.readouterr().out == "a\nb\n" * 2
    assert cli.main(["simulate", "--list"]) == cli.main(["simulate", "--entries"]) == 0
    assert capsys.readouterr().out == "car\ndrone\nwhat may be said\n" and len(files.calls) == 2
    for words in ("car", "--out o.csv", "car --out o.csv --seed -1"):
        assert refused("simulate", *words.split())


# --- state ---


def test_a_state_s_words_are_found_by_any_part_of_their_name(stands_in, capsys):
    Word = namedtuple("Word", "name")
    words = [Word("REST_US"), Word("OUT_Q8")]
    of_file = stands_in("zerorate_tools.replay.state_in_words.words_of_file", words)
    in_words = stands_in("zerorate_tools.replay.state_in_words.in_words", "told")
    assert cli.main(["state", "show", "s.bin"]) == 0
    assert of_file.call[0] == (Path("s.bin"), {}) and in_words.call[0] == (words,)
    assert cli.main(["state", "show", "s.bin", "--find", "out", "--set", "bins=8"]) == 0
    assert of_file.calls[1][0] == (Path("s.bin"), {"bins": 8})
    assert in_words.calls[1][0] == (words[1:],) and capsys.readouterr().out == "told\ntold\n"
    assert refused("state")


# --- watch ---


def test_watch_is_given_what_was_typed_and_ends_with_1_where_nothing_came(stands_in, capsys):
    watch = stands_in("zerorate_tools.watch.watching.watch", "live")
    draw = stands_in("zerorate_tools.watch.screen.draw")
    assert cli.main(["watch", "x.csv"]) == 0
    source, options = watch.call[0]
    assert source == "x.csv" and options.settings == {"motion": None, "gravity": None}
    plain = {"seconds": None, "once": False, "every_s": None, "plain": False, "model": None}
    assert {name: getattr(options, name) for name in plain} == plain
    assert (options.setup, options.own) == ("", False) and not draw.calls
    Path("s.py").write_text("imu = 1")
    words = "--for 3 --once --every 2 --plain --model m --no-motion --gravity --setup s.py"
    assert cli.main(["watch", "x.csv", *words.split(), "--plot", "p.png"]) == 0
    options = watch.calls[1][0][1]
    assert (options.seconds, options.once, options.every_s, options.plain) == (3, True, 2, True)
    assert (options.model, options.setup) == (Path("m"), "imu = 1")
    assert options.settings == {"motion": False, "gravity": True}
    assert draw.call[0] == ("live", Path("p.png")) and capsys.readouterr().out == "p.png\n"
    watch.result = None
    assert cli.main(["watch", "x.csv", "--own", "--plot", "p.png"]) == 1
    assert watch.calls[2][0][1].own is True and len(draw.calls) == 1


@pytest.mark.parametrize(
    ("words", "code"),
    [("--own", 0), ("--own --model m", 2), ("--own --setup s", 2), ("--model m", 0)],
)
def test_a_board_s_own_program_is_watched_as_it_is(stands_in, words, code):
    stands_in("zerorate_tools.watch.watching.watch", "live")
    assert cli.main(["watch", "P", *words.split()]) == code
    assert refused("watch", "P", "--for", "0") and refused("watch", "P", "--every", "-1")
