"""What is typed reaches the function behind a command, and the code that the shell gets says how it
went. What the commands print is tested with what they do, and by the pages of docs."""

import argparse
import errno
import io
import json
import os
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace
from unittest.mock import ANY, Mock, call

import numpy as np
import pytest
from zerorate_tools import cli
from zerorate_tools.commands.options import above_zero, finite, print_json
from zerorate_tools.errors import MissingRuntime, ZerorateError
from zerorate_tools.importers import Options, parsed_mapping
from zerorate_tools.model import Binding
from zerorate_tools.recordings import Recording, Scales, write_recording
from zerorate_tools.watch.screen import WatchOptions

SCALES = Scales("X", 10.0, 131.0)


@pytest.fixture
def stands_in(monkeypatch):
    """stands_in(path of a name, what it returns or raises): the Mock in its place."""

    def put(path, result=None):
        raises = isinstance(result, Exception)
        mock = Mock(**{"side_effect" if raises else "return_value": result})
        monkeypatch.setattr(path, mock)
        return mock

    return put


@pytest.fixture(autouse=True)
def folder(monkeypatch, tmp_path):
    """A folder of its own, with a recording of four samples and a program in it."""
    monkeypatch.chdir(tmp_path)
    write_log("run.parquet", 4)
    Path("s.py").write_text("imu = 1")


def write_log(path, n):
    columns = {name: np.arange(n) for name in ("t_us", "gx", "gy", "gz")}
    write_recording(Recording(columns, SCALES, "run"), path)


def refused(*words):
    """Whether the usage is said, and 2 returned."""
    with pytest.raises(SystemExit) as ended:
        cli.main([*words])
    return ended.value.code == 2


# --- what the function behind a command is given ---


class Asked(Exception):
    """The function behind a command was called; no more is done."""


IMPORT = {"options": Options(), "mapping": [], "units": {}, "instance": 0, "advance": ANY}
UNITS = {"time": "ms", "gyro": "dps", "accel": "g", "temp": "k"}
FLEET = dict.fromkeys(("scheduler", "workers", "devices_per_task", "model"))
FLEET |= {"job": "replay", "keep": False, "minutes": 5.0, "advance": ANY}
FLASH = {"dry_run": False, "main": None, "model": None, "parts": [], "only": False}
REPLAY = dict.fromkeys(("state", "from_state", "model"))
REPLAY |= {"runtime": "native", "resume": False, "advance": ANY}
SOURCES = {"document": False, "motion": None, "gravity": None}
SIMULATE = {"truth": None, "session": None, "seed": None, "done": ANY}
WATCH = {"settings": {"motion": None, "gravity": None}}
RECORD = {"seconds": None, "done": ANY}
LOG, OUT, TO = Path("run.parquet"), Path("o.parquet"), Path("o")
A, B, M = Path("a.csv"), Path("b.csv"), Path("m.bin")
CLOSE, FLEET_OF, IMPORTER = "closing.close", "fleet.devices_of", "importers.import_"
RECORDER, REPLAYED = "boards.recording.record", "replay run.parquet --out o.parquet"
TO_FILES, WATCHED = "simulate.simulate_to_files", "watch.watching.watch"


@pytest.mark.parametrize(("words", "function", "given"), [
    ("close a.csv b.csv --out o", CLOSE, call([A, B], TO, None, ANY, online=False)),
    ("close a.csv --out o --online --holdout a.csv", CLOSE,
     call([A], TO, "a.csv", ANY, online=True)),
    ("compare a.csv b.csv", "compare.matrix_of", call([A, B])),
    ("cut a.csv --at-row 2 --at-row 9 --out o", "importers.cut", call(A, [2, 9], TO)),
    ("fleet x y --out o", FLEET_OF, call(["x", "y"], None, without=TO)),
    ("fleet x --out o --device-from (.)", FLEET_OF, call(["x"], "(.)", without=TO)),
    ("fleet run.parquet --out o", "fleet.fleet", call(ANY, TO, **FLEET)),
    ("fleet run.parquet --out o --job close --keep --model m.bin --minutes 2.5 "
     "--scheduler tcp://h:1 --workers 1 --devices-per-task 3", "fleet.fleet",
     call(ANY, TO, job="close", scheduler="tcp://h:1", workers=1, devices_per_task=3, model=M,
          keep=True, minutes=2.5, advance=ANY)),
    ("flash P", "boards.flashing.flash", call("P", **FLASH)),
    ("flash P --dry-run --with motion,gravity --only --main m.py --model m.bin",
     "boards.flashing.flash", call("P", dry_run=True, main=Path("m.py"), model=M, only=True,
                                   parts=["motion", "gravity"])),
    ("import a.csv --out o.parquet", IMPORTER + "recording", call([A], OUT, **IMPORT)),
    ("import a.csv --out o.parquet --hz 1/4 --sensor S --gyro-lsb-per-dps 2 --accel-lsb-per-g 3 "
     "--temp-lsb-per-degc 4 --temp-offset-degc -5", IMPORTER + "recording",
     call([A], OUT, **IMPORT | {"options": Options("S", 0.25, 2, 3, 4, -5)})),
    ("import a.csv --out o.parquet --time-unit MS --gyro-unit dps --accel-unit G --temp-unit K "
     "--instance 2 --map gx=x:dps", IMPORTER + "recording",
     call([A], OUT, options=Options(), mapping=[parsed_mapping("gx=x:dps")], units=UNITS,
          instance=2, advance=ANY)),
    ("import a.csv b.csv --out o", IMPORTER + "together", call([A, B], TO, **IMPORT)),
    ("import a.csv --out .", IMPORTER + "together", call([A], Path("."), **IMPORT)),
    ("model check m.bin", "model.files.check_model", call(M, device=Binding(), scales=None)),
    ("model check m.bin --chip-id 0x68 --gyro-range 1 --accel-range 0 --filter 254 "
     "--log run.parquet", "model.files.check_model",
     call(M, device=Binding(0x68, 1, 0, 254), scales=SCALES)),
    ("record /dev/i2c-1 --out o.parquet", RECORDER, call("/dev/i2c-1", OUT, **RECORD)),
    ("record 0 --out o.parquet --seconds 9 --address 0x69 --hz 50 --dps 500 --g 4 --dlpf-hz 20 "
     "--part P --setup s.py", RECORDER,
     call("0", OUT, seconds=9, done=ANY, address=0x69, odr_hz=50, full_scale_dps=500,
          full_scale_g=4, dlpf_hz=20, part="P", setup="imu = 1")),
    (REPLAYED, "recordings.open_recording", call(LOG, keep_gaps=True)),
    (REPLAYED, "replay.replay", call(LOG, OUT, options=SOURCES, **REPLAY)),
    (REPLAYED + " --runtime x86 --state s --from-state f --resume --model m.bin", "replay.replay",
     call(LOG, OUT, options=SOURCES, runtime="x86", state=Path("s"), from_state=Path("f"),
          resume=True, model=M, advance=ANY)),
    (REPLAYED + " --motion --no-gravity --every --set step_degc=2 --set bins=8 --set short=2 "
     "--set long=4", "replay.replay",
     call(LOG, OUT, **REPLAY, options=SOURCES | {
         "motion": True, "gravity": False, "every": True, "step_degc": 2.0, "bins": 8, "short": 2,
         "long": 4})),
    (REPLAYED + " --document --rests", "replay.replay",
     call(LOG, OUT, options=SOURCES | {"document": True, "every": False}, **REPLAY)),
    ("simulate car --out o.parquet", "simulate.load_description", call("car")),
    ("simulate car --out o.parquet", TO_FILES, call(ANY, OUT, **SIMULATE)),
    ("simulate car --out o.parquet --truth t --session 2 --seed 3", TO_FILES,
     call(ANY, OUT, truth=Path("t"), session=2, seed=3, done=ANY)),
    ("state show s", "replay.state_in_words.words_of_file", call(Path("s"), {})),
    ("state show s --set bins=8", "replay.state_in_words.words_of_file",
     call(Path("s"), {"bins": 8})),
    ("watch x.csv", WATCHED, call("x.csv", WatchOptions(**WATCH))),
    ("watch x.csv --for 3 --once --every 2 --plain --model m.bin --no-motion --gravity "
     "--setup s.py", WATCHED,
     call("x.csv", WatchOptions(3, True, 2, True, {"motion": False, "gravity": True}, M,
                                "imu = 1"))),
    ("watch P --own", WATCHED, call("P", WatchOptions(**WATCH, own=True))),
])  # fmt: skip
def test_a_function_is_given_what_was_typed(stands_in, words, function, given):
    asked = stands_in(f"zerorate_tools.{function}", Asked())
    with pytest.raises(Asked):
        cli.main(words.split())
    assert asked.call_args == given


@pytest.mark.parametrize(
    ("words", "total"),
    [
        *(("close a.csv b.csv --out o", 4), ("compare a.csv b.csv", 6)),
        *(("fleet run.parquet --out o", 1), ("replay run.parquet --out o.parquet", 4)),
        *(("import s.py --out o.csv", 7), ("import none.csv --out o.csv", None)),
        *(("record 0 --out o.csv --seconds 9", 9), ("record 0 --out o.csv", None)),
        *(("simulate warm-up-a --out o.csv", 2), ("simulate car --out o.csv --session 1", 1)),
    ],
)
def test_the_bar_is_as_long_as_the_work(stands_in, words, total):
    progress = stands_in("zerorate_tools.progress.progress", Asked())
    with pytest.raises(Asked):
        cli.main(words.split())
    assert progress.call_args.args[1:] == (total,)


EXPORTED = "--odr-hz 50 --gyro-lsb-per-dps 65 --accel-lsb-per-g 8 --temp-lsb-per-degc 9 --model m"


@pytest.mark.parametrize(
    ("words", "scales", "model"),
    [("", (100, 131, 16384, 340), None), (EXPORTED, (50, 65, 8, 9), Path("m"))],
)
def test_export_is_given_the_scales_of_an_mpu6050_or_those_typed(stands_in, words, scales, model):
    export = stands_in("zerorate_tools.kernels.export.export_c", Asked())
    with pytest.raises(Asked):
        cli.main(["export", "c", "o", *words.split()])
    (folder, sensor, given), _ = export.call_args
    assert (folder, given) == (TO, model)
    of = ("odr_hz", "gyro_lsb_per_dps", "accel_lsb_per_g", "temp_lsb_per_degc")
    assert tuple(getattr(sensor, name) for name in of) == scales


@pytest.mark.parametrize(
    "words",
    [
        *("close a.csv", "close --out o", "allan", "export", "model", "state", "runtimes"),
        *("bench none-such", "runtimes get vax", "cut x.csv --out o", "cut x.csv --at-row 2"),
        *(f"cut x.csv --at-row {row} --out o" for row in ("1", "0", "-3", "x")),
        *("fleet x --out s3://x/y", "fleet x --out o --workers 0", "fleet x --out o --minutes 0"),
        *("fleet x --job replay", "fleet x --out o --workers -1"),
        *("import a.csv", "import a.csv --out o --hz 0", "import a.csv --out o --hz 1/0"),
        *("import a.csv --out o --map gx", "import a.csv --out o --temp-offset-degc nan"),
        *(f"model check m.bin --chip-id {code}" for code in ("255", "-1", "0x100", "x")),
        *(
            f"replay run.parquet --out o.parquet {words}"
            for words in ("--resume", "--rests", "--rests --every", "--rests --document --every")
        ),
        *(f"replay run.parquet --out o.parquet --set {n}" for n in ("bins", "bins=x", "bins=inf")),
        *("replay x.csv", "simulate car", "simulate --out o.csv"),
        *("simulate car --out o.csv --seed -1", "watch P --for 0", "watch P --every -1"),
    ],
)
def test_words_that_cannot_be_meant_are_refused(words):
    assert refused(*words.split())


@pytest.mark.parametrize(
    "words", ["export c o --odr-hz -1", "watch P --own --model m", "watch P --own --setup s"]
)
def test_what_the_function_could_not_do_ends_with_2(words):
    assert cli.main(words.split()) == 2


NONE = SimpleNamespace(samples=0, resumed=0, report={"sessions": 0})


@pytest.mark.parametrize(
    ("words", "function", "nothing"),
    [
        ("fleet run.parquet --out o --json", "fleet.fleet", NONE),
        ("record 0 --out o.csv", RECORDER, NONE),
        ("record fake: --out o.csv --guide", RECORDER, NONE),
        ("watch x.csv --plot p.png", WATCHED, None),
    ],
)
def test_1_says_that_nothing_came(stands_in, words, function, nothing, capsys):
    stands_in(f"zerorate_tools.{function}", nothing)
    assert cli.main(words.split()) == 1
    assert words[:6] != "record" or "no sample came" in capsys.readouterr().out


def test_allan_prints_mdps_of_each_length_and_the_lowest(stands_in, capsys):
    rates = np.random.default_rng(1).normal(0, 1e-3, (50, 3))
    stands_in("zerorate_tools.loop.read.still.still_stretch", (rates, 0.5))
    assert cli.main(["allan", "run.parquet"]) == 0
    first, _, *rows, floor = capsys.readouterr().out.splitlines()
    numbers = np.array([row.split() for row in rows], float)
    assert first == "the longest stretch at rest: 25.0 s" and numbers[0, 0] == 0.5
    assert numbers[0, 1:] == pytest.approx(np.full(3, 1.0), abs=0.3)
    assert [float(n) for n in floor.split()[1:]] == numbers[:, 1:].min(axis=0).tolist()


def test_what_was_watched_is_drawn_where_that_is_asked(stands_in, capsys):
    stands_in("zerorate_tools.watch.watching.watch", "live")
    draw = stands_in("zerorate_tools.watch.screen.draw")
    assert cli.main(["watch", "x.csv", "--plot", "p.png"]) == 0
    assert draw.call_args == call("live", Path("p.png")) and capsys.readouterr().out == "p.png\n"


def test_what_simulate_knows_is_listed(capsys):
    assert cli.main(["simulate", "--list"]) == 0
    assert "turntable" in capsys.readouterr().out.splitlines()
    assert cli.main(["simulate", "--entries"]) == 0
    assert "turn_on_dps" in capsys.readouterr().out


@pytest.mark.parametrize(("words", "said"), [("", "in words\n"), ("--json", "{}\n")])
def test_a_model_is_shown_in_words_or_as_json(stands_in, capsys, words, said):
    read = stands_in("zerorate_tools.model.read_model", "model")
    stands_in("zerorate_tools.model.to_json", "{}\n")
    stands_in("zerorate_tools.model.model_in_words.in_words", "in words")
    assert cli.main(["model", "show", "m.bin", *words.split()]) == 0
    assert read.call_args == call(Path("m.bin")) and capsys.readouterr().out == said


@pytest.mark.parametrize("in_motion", [False, True])
def test_close_prints_what_it_found_at_rest_or_in_motion(stands_in, capsys, in_motion):
    stands_in("zerorate_tools.closing.close", {"in_motion": 1} if in_motion else {})
    stands_in("zerorate_tools.closing_in_motion.motion_in_words", "in motion")
    stands_in("zerorate_tools.loop.report.in_words.in_words", "the words")
    stands_in("zerorate_tools.report.sentences.headline", "the headline")
    stands_in("zerorate_tools.report.sentences.why_both", "why")
    assert cli.main(["close", "a.csv", "--out", "o"]) == 0
    words = ["in motion"] if in_motion else ["the headline.", "why", "the words"]
    assert capsys.readouterr().out.splitlines() == [*words, "report: o/report.html"]


# --- numbers ---


@pytest.mark.parametrize("text", ["nan", "inf", "-inf"])
@pytest.mark.parametrize("kind", [finite, above_zero])
def test_what_is_no_finite_number_is_refused(kind, text):
    with pytest.raises(argparse.ArgumentTypeError):
        kind(text)


@pytest.mark.parametrize("text", ["1e-9", "1e9", "0.5", "1"])
def test_a_rate_or_a_time_is_above_zero(text):
    assert finite(text) == above_zero(text) == float(text)


@pytest.mark.parametrize("text", ["0", "-1", "1000000001", "1e10"])
def test_a_rate_or_a_time_is_not_0_nor_beyond_a_billion(text):
    assert finite(text) == float(text)
    with pytest.raises(argparse.ArgumentTypeError):
        above_zero(text)


@pytest.mark.parametrize("words", ["--seconds abc", "--address 300", "--address 0x7", "--hz 1,5"])
def test_a_number_that_is_none_is_told_without_a_functions_name(words, capsys):
    with pytest.raises(SystemExit):
        cli.main(["record", "0", "--out", "o.csv", *words.split()])
    said = capsys.readouterr().err.splitlines()[-1]
    assert words.split()[1] in said and "_" not in said and "invalid" not in said


# --- JSON ---


@dataclass
class Of:
    path: Path
    numbers: tuple


def test_json_has_plain_values_and_null_where_there_is_no_number(capsys):
    print_json(
        {
            1: Of(Path("a/b"), (1, np.float32(0.5), np.arange(2))),
            "none": [float("nan"), float("inf"), np.nan, True, None, "text"],
            "set": {3},
            "frozen": frozenset([4]),
        }
    )
    assert json.loads(capsys.readouterr().out) == {
        "1": {"path": "a/b", "numbers": [1, 0.5, [0, 1]]},
        "none": [None, None, None, True, None, "text"],
        "set": [3],
        "frozen": [4],
    }
    with pytest.raises(TypeError):
        print_json(Of)


# --- bench and demo ---


def test_without_its_package_bench_says_what_to_install(monkeypatch, capsys):
    from zerorate_tools.commands import demo

    monkeypatch.setattr(demo, "find_spec", lambda name: None)
    assert cli.main(["bench", "accuracy"]) == 2
    assert "the wheel has no benchmarks" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("same", "code"), [((True,) * 3, 0), ((False, True, True), 1), ((True, True, False), 1)]
)
def test_each_chapter_of_the_demo_is_read_while_the_next_is_made_and_1_says_that_states_differ(
    stands_in, monkeypatch, same, code
):
    pipe, read = io.TextIOWrapper(io.BytesIO()), []
    monkeypatch.setattr("sys.stdout", pipe)
    first, before, after = (SimpleNamespace(same_state=one) for one in same)
    works = {"first_power_on": first, "closed": None, "back_on_the_chip": (before, after)}
    for name, result in works.items():
        work = stands_in(f"zerorate_tools.demo.{name}")
        work.side_effect = lambda *a, result=result: (
            read.append(pipe.buffer.getvalue().decode().split()[-1]) or result
        )
    stands_in("zerorate_tools.demo.make_device", SimpleNamespace(logs=["l"]))
    chapters = ["opening", "chapter_one", "chapter_two", "chapter_three", "compared", "ending"]
    for name in chapters:
        stands_in(f"zerorate_tools.demo.story.{name}", name)
    for name in ("runtimes.find", "compare.compare", "compare.show.write_page"):
        stands_in(f"zerorate_tools.{name}")
    draw = stands_in("zerorate_tools.demo.picture.draw_job")
    draw.side_effect = lambda *shown: shown[-1].touch()
    assert cli.main(["demo", "--out", "deep", "--runtime", "x86"]) == code
    pipe.flush()
    assert pipe.buffer.getvalue().decode().split() == chapters and read == chapters[:3]
    assert draw.call_args == call(first, before, after, ANY) and Path("deep/demo.png").exists()


def test_an_interpreter_of_ones_own_is_not_fetched(stands_in, capsys):
    stands_in("zerorate_tools.runtimes.find", MissingRuntime("not there"))
    fetch = stands_in("zerorate_tools.runtimes.fetch")
    assert cli.main(["demo", "--runtime", "./mine"]) == 2 and not fetch.called
    assert "not there" in capsys.readouterr().err


# --- record ---


def test_record_says_what_a_killed_one_left(stands_in, capsys):
    stands_in("zerorate_tools.boards.recording.record", SimpleNamespace(samples=1))
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
    write_log("whole.csv", 6)
    recover = stands_in("zerorate_tools.recordings.recover", Path("whole.csv"))
    assert cli.main(["record", "--recover", "x.partial.csv"]) == 0
    assert recover.call_args == call(Path("x.partial.csv"), None)
    assert capsys.readouterr().out == "whole.csv: 6 samples of x.partial.csv\n"


# --- run ---


@pytest.fixture
def serving(stands_in, monkeypatch):
    """What the service is made of, and what opens a bus of Linux."""
    service = stands_in("zerorate_tools.service.Service", SimpleNamespace(run=lambda: None))
    stands_in("signal.signal")
    imu = stands_in("zerorate_i2c.mpu6050.MPU6050", "imu")
    bus = SimpleNamespace(close=Mock())
    linux = stands_in("zerorate_i2c.linux.LinuxI2C", bus)
    made = {
        name: stands_in(f"zerorate_tools.service.{name}", name)
        for name in ("Datagrams", "Metrics", "UnixSocket", "Lines", "FakeBus")
    }
    return SimpleNamespace(service=service, imu=imu, bus=bus, linux=linux, **made)


def test_run_serves_lines_unless_told(serving, capsys):
    assert cli.main(["run", "/dev/i2c-7"]) == 0
    system, sinks, model = serving.service.call_args.args
    assert sinks == ["Lines"] and model == b"" and not serving.FakeBus.called
    assert system.open_imu() == "imu" and serving.linux.call_args.args == ("/dev/i2c-7",)
    assert serving.imu.call_args == call(serving.bus)  # which has the defaults
    Path("learned.bin").touch()
    os.utime("learned.bin", (0, time.time() - 500))
    assert system.stored_ago_s() == pytest.approx(500, abs=60)
    system.say("a line")
    assert capsys.readouterr().err == "a line\n"


def test_run_is_given_what_was_typed(serving):
    Path("m.bin").write_bytes(b"model")
    words = "--address 0x69 --hz 50 --dps 500 --g 8 --dlpf-hz 20 --part mpu6500 --model m.bin"
    words += " --udp h:1 --metrics h:2 --socket s --remote"
    assert cli.main(["run", "fake:", *words.split()]) == 0
    system, sinks, model = serving.service.call_args.args
    assert sinks == ["Datagrams", "Metrics", "UnixSocket"] and model == b"model"
    assert serving.Datagrams.call_args == call("h:1", True)
    assert serving.Metrics.call_args == call("h:2", True)
    assert serving.FakeBus.call_args == call(address=0x69, part="mpu6500")
    assert system.open_imu() == "imu" and not serving.linux.called
    typed = {"odr_hz": 50, "full_scale_dps": 500, "full_scale_g": 8, "dlpf_hz": 20}
    assert serving.imu.call_args == call("FakeBus", address=0x69, part="mpu6500", **typed)
    assert cli.main(["run", "fake:", "--udp", "h:1"]) == 0
    assert serving.Datagrams.call_args.args == ("h:1", False)


def test_a_model_in_words_is_turned_into_bytes_for_the_service(serving, stands_in):
    read = stands_in("zerorate_tools.model.read_model", "model")
    stands_in("zerorate_tools.model.encoded", b"bytes of it")
    cli.main(["run", "fake:", "--model", "m.json"])
    assert serving.service.call_args.args[2] == b"bytes of it"
    assert read.call_args == call(Path("m.json"))


def test_an_open_bus_is_closed_where_no_chip_answers_and_a_wrong_setting_is_one_line(serving):
    cli.main(["run", "/dev/i2c-7"])
    open_imu = serving.service.call_args.args[0].open_imu
    serving.imu.side_effect = OSError("nothing answers")
    with pytest.raises(OSError, match="nothing answers"):
        open_imu()
    assert serving.bus.close.call_count == 1
    serving.imu.side_effect = ValueError("no such rate")
    with pytest.raises(ZerorateError, match="no such rate"):
        open_imu()
    serving.linux.side_effect = OSError(errno.ENOTTY, "no ioctl")
    with pytest.raises(ZerorateError, match="no I2C bus"):
        open_imu()
    for number in (errno.ENOENT, errno.EACCES):
        serving.linux.side_effect = OSError(number, "not there yet")
        with pytest.raises(OSError, match="not there yet"):
            open_imu()


def test_run_needs_the_folder_of_its_state(serving, capsys):
    assert cli.main(["run", "fake:", "--state", "no/learned.bin"]) == 2
    assert not serving.service.called and capsys.readouterr().err.startswith("zerorate: no: ")


@pytest.mark.parametrize("words", ["--hz 3000", "--dlpf-hz 2", "--part nosuch"])
def test_a_setting_that_no_chip_takes_is_not_waited_for(serving, words, capsys):
    assert cli.main(["run", "/dev/i2c-7", *words.split()]) == 2
    assert words.split()[1] in capsys.readouterr().err
    assert not serving.service.called and not serving.linux.called
    for right in ("--hz 8000 --dlpf-hz 256", "--hz 10 --dlpf-hz 256 --part MPU-6500"):
        assert cli.main(["run", "/dev/i2c-7", *right.split()]) == 0


# --- runtimes ---


def test_interpreters_are_fetched_in_turn_and_2_says_that_one_could_not_be(stands_in, capsys):
    fetch = stands_in("zerorate_tools.runtimes.fetch")
    pico = stands_in("zerorate_bench.boards.pico.fetch_rp2040")
    assert cli.main(["runtimes", "get", "wasm", "rp2040", "x64"]) == 0
    assert fetch.call_args_list == [call("wasm"), call("x64")] and pico.call_count == 1
    assert capsys.readouterr().out == "wasm: ready\nrp2040: ready\nx64: ready\n"
    fetch.side_effect = MissingRuntime("cannot be had")
    assert cli.main(["runtimes", "get", "wasm", "rp2040"]) == 2
    ended = capsys.readouterr()
    assert ended.out == "rp2040: ready\n" and ended.err == "zerorate: wasm: cannot be had\n"


def test_the_emulated_pico_is_in_a_checkout_only(monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "zerorate_bench.boards.pico", None)
    assert cli.main(["runtimes", "get", "rp2040"]) == 2
    assert "in a checkout only" in capsys.readouterr().err


def test_interpreters_are_listed_with_how_to_get_those_missing(monkeypatch, capsys):
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
