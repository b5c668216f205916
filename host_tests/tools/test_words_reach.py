"""What is typed reaches the function behind a command, and the code that the shell gets says how it
went. What the commands print is tested with what they do, and by the pages of docs."""

import json
from dataclasses import dataclass
from pathlib import Path
from unittest.mock import ANY, call

import numpy as np
import pytest
from zerorate_tools import cli
from zerorate_tools.commands.options import print_json
from zerorate_tools.importers import Options, parsed_mapping
from zerorate_tools.model import Binding
from zerorate_tools.recordings import Scales
from zerorate_tools.watch.screen import WatchOptions

SCALES = Scales("X", 10.0, 131.0)
pytestmark = pytest.mark.usefixtures("own_folder")


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
    *((f"record 0 --out o.parquet --address {at}", RECORDER, call("0", OUT, **RECORD, address=at))
      for at in (0x08, 0x77)),
    ("record --recover x.partial.csv", "recordings.recover", call(Path("x.partial.csv"), None)),
    ("model show m.bin", "model.read_model", call(M)),
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
    ("simulate car --out o.parquet --truth t --session 2 --seed 0", TO_FILES,
     call(ANY, OUT, truth=Path("t"), session=2, seed=0, done=ANY)),
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
    ("words", "said"),
    [
        ("export c o --odr-hz -1", "odr_hz"),
        *((f"watch P --own {words}", "--own leaves") for words in ("--model m", "--setup s")),
    ],
)
def test_what_the_function_could_not_do_ends_with_2(words, said, capsys):
    assert cli.main(words.split()) == 2 and said in capsys.readouterr().err


# --- numbers ---


@pytest.mark.parametrize("words", ["--seconds abc", "--address 0x78", "--address 7", "--hz 1,5"])
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
    printed = capsys.readouterr().out
    assert printed.startswith('{\n "1": {\n  "path"')
    assert json.loads(printed) == {
        "1": {"path": "a/b", "numbers": [1, 0.5, [0, 1]]},
        "none": [None, None, None, True, None, "text"],
        "set": [3],
        "frozen": [4],
    }
    with pytest.raises(TypeError):
        print_json(Of)
