"""Commands that use what was learned: `zerorate model`, `state`, `export` and `flash`."""

import argparse
from pathlib import Path

from ..errors import ZerorateError
from .options import command, option, setting, switch, with_actions

FILE = "a model.bin or model.json"


def _code(text: str) -> int:
    value = int(text, 0)
    if not 0 <= value < 255:
        raise argparse.ArgumentTypeError(f"{text} is no byte below 255")
    return value


with_actions(
    "model",
    "show, check or compare effect models",
    "Look at effect models: model.bin, or its readable twin model.json.",
)


@command(
    "model show",
    "print what a model corrects",
    option("file FILE", FILE, Path),
    switch("--json", "print model.json"),
)
def run_show(arguments: argparse.Namespace) -> None:
    from ..model import read_model, to_json
    from ..model.model_in_words import in_words

    model = read_model(arguments.file)
    print(to_json(model), end="") if arguments.json else print(in_words(model))


@command(
    "model check",
    "check whether a device would load a model",
    option("file FILE", FILE, Path),
    option("--chip-id CODE", "WHO_AM_I of the device, for example 0x68", _code),
    option("--gyro-range CODE", "code of its gyroscope's range, 0..3 for 250..2000 dps", _code),
    option("--accel-range CODE", "code of its accelerometer's range, 0..3 for 2..16 g", _code),
    option("--filter CODE", "code of its low-pass filter, 0..7", _code),
    option("--log LOG", "a recording of the device", Path),
    description="Ask the firmware's own reader whether a device would load a model; exit code 2 "
    "and the reason if not.",
)
def run_check(arguments: argparse.Namespace) -> None:
    """Print that the model would be loaded, or raise why not."""
    from ..model import Binding
    from ..model.files import check_model
    from ..model.model_in_words import slots_in_words
    from ..recordings import open_recording

    a = arguments
    device = Binding(a.chip_id, a.gyro_range, a.accel_range, a.filter)
    scales = open_recording(a.log).scales if a.log else None
    model = check_model(a.file, device=device, scales=scales)
    print(f"{a.file}: good, {slots_in_words(model)}")


@command(
    "model diff",
    "print how two models differ; exit code 1 if they do",
    option("one A", FILE, Path),
    option("other B", FILE, Path),
)
def run_diff(arguments: argparse.Namespace) -> int:
    from ..model import read_model
    from ..model.model_in_words import differences

    found = differences(read_model(arguments.one), read_model(arguments.other))
    print("\n".join(found) if found else "the same to the last bit")
    return 1 if found else 0


with_actions(
    "state",
    "print the words of a stored state",
    "Look at a stored state: learned.bin, or a file of `replay --state`.",
)


@command(
    "state show",
    "print each word: name, value, unit",
    option("file FILE", "a file of `replay --state`, or learned.bin", Path),
    option("--find TEXT", "only words with this in the name", default=""),
    option(
        "--set NAME=VALUE",
        "a setting that changes the size of a state file, as bins=8; a store has its own",
        setting,
        action="append",
        default=[],
    ),
)
def run_state(arguments: argparse.Namespace) -> None:
    from ..replay.state_in_words import in_words, words_of_file

    words = words_of_file(arguments.file, dict(arguments.set))
    found = [word for word in words if arguments.find.upper() in word.name.upper()]
    if arguments.find and not found:
        raise ZerorateError(f"{arguments.file}: no word has {arguments.find} in its name")
    print(in_words(found))


with_actions(
    "export",
    "write the firmware as C",
    "Write the firmware as C, for a device without MicroPython.",
    metavar="LANGUAGE",
)


@command(
    "export c",
    "a header, a C file, a test program, and build files",
    option("folder DIR", "folder to write", Path),
    option("--odr-hz N", "100", float, default=100.0),
    option("--gyro-lsb-per-dps N", "131", float, default=131.0),
    option("--accel-lsb-per-g N", "16384; 0 where there is none", float, default=16384.0),
    option("--temp-lsb-per-degc N", "340; 0 where there is none", float, default=340.0),
    option("--model FILE", "a model.bin; its scales replace those above", Path),
)
def run_export(arguments: argparse.Namespace) -> None:
    from zerorate import Sensor

    from zerorate_tools.kernels.export import export_c

    a = arguments
    try:
        sensor = Sensor(a.odr_hz, a.gyro_lsb_per_dps, a.accel_lsb_per_g, a.temp_lsb_per_degc)
        paths = export_c(a.folder, sensor, a.model)
    except ValueError as error:
        raise ZerorateError(str(error)) from error
    for path in paths:
        print(path)


@command(
    "flash",
    "put the firmware and the driver on a MicroPython board",
    option("port PORT", "serial port: /dev/ttyACM0, COM3, any path"),
    switch("--dry-run", "only list the files and the memory that they need"),
    option(
        "--with PARTS",
        "parts besides learning at rest: motion,gravity,effects,refine,bursts,self-test,"
        "differing or all",
        lambda text: text.split(","),
        dest="parts",
        default=[],
    ),
    switch("--only", "remove parts that are not named now"),
    option("--main FILE", "copy FILE to main.py; the one that is there becomes main.old.py", Path),
    option("--model FILE", "copy FILE to model.bin, and send the part that loads it", Path),
    description="Ask the board what it is, compile zerorate and zerorate_i2c for it, and put them "
    "into its lib folder, all or none. Files that the board has already are not sent.",
)
def run_flash(arguments: argparse.Namespace) -> None:
    from ..boards.flashing import flash

    a = arguments
    flash(a.port, dry_run=a.dry_run, main=a.main, model=a.model, parts=a.parts, only=a.only)
