"""Commands that use what was learned: `zerorate model`, `state`, `export` and `flash`."""

import argparse
from pathlib import Path

from ..errors import ZerorateError
from .learn import setting
from .options import option, switch

FILE = "a model.bin or model.json"


def add_model(subparsers: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = subparsers.add_parser(
        "model",
        help="show, check or compare effect models",
        description="Look at effect models: model.bin, or its readable twin model.json.",
    )
    actions = parser.add_subparsers(metavar="ACTION", required=True)
    show = actions.add_parser("show", help="print what a model corrects")
    option(show, "file", "FILE", FILE, Path)
    switch(show, "--json", "print model.json")
    show.set_defaults(run=run_show)
    _add_check(actions)
    diff = actions.add_parser("diff", help="print how two models differ; exit code 1 if they do")
    option(diff, "one", "A", FILE, Path)
    option(diff, "other", "B", FILE, Path)
    diff.set_defaults(run=run_diff)


def _add_check(actions: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    check = actions.add_parser(
        "check",
        help="check whether a device would load a model",
        description="Ask the firmware's own reader whether a device would load a model; "
        "exit code 2 and the reason if not.",
    )
    option(check, "file", "FILE", FILE, Path)
    for flag, what in (
        ("--chip-id", "WHO_AM_I of the device, for example 0x68"),
        ("--gyro-range", "code of its gyroscope's range, 0..3 for 250..2000 dps"),
        ("--accel-range", "code of its accelerometer's range, 0..3 for 2..16 g"),
        ("--filter", "code of its low-pass filter, 0..7"),
    ):
        option(check, flag, "CODE", what, _code)
    option(check, "--log", "LOG", "a recording of the device", Path)
    check.set_defaults(run=run_check)


def run_show(arguments: argparse.Namespace) -> None:
    from ..model import read_model, to_json
    from ..model.model_in_words import in_words

    model = read_model(arguments.file)
    print(to_json(model), end="") if arguments.json else print(in_words(model))


def run_check(arguments: argparse.Namespace) -> None:
    """Print that the model would be loaded, or raise why not."""
    from ..model import Binding
    from ..model.files import check_model
    from ..model.model_in_words import slots_in_words
    from ..recordings import open_recording

    device = Binding(
        arguments.chip_id, arguments.gyro_range, arguments.accel_range, arguments.filter
    )
    scales = open_recording(arguments.log).scales if arguments.log else None
    model = check_model(arguments.file, device=device, scales=scales)
    print(f"{arguments.file}: good, {slots_in_words(model)}")


def run_diff(arguments: argparse.Namespace) -> int:
    from ..model import read_model
    from ..model.model_in_words import differences

    found = differences(read_model(arguments.one), read_model(arguments.other))
    print("\n".join(found) if found else "the same to the last bit")
    return 1 if found else 0


def _code(text: str) -> int:
    value = int(text, 0)
    if not 0 <= value < 255:
        raise argparse.ArgumentTypeError(f"{text} is no byte below 255")
    return value


def add_state(subparsers: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = subparsers.add_parser("state", help="print the words of a stored state")
    actions = parser.add_subparsers(metavar="ACTION", required=True)
    show = actions.add_parser("show", help="print each word: name, value, unit")
    option(show, "file", "FILE", "a file of `replay --state`, or learned.bin", Path)
    option(show, "--find", "TEXT", "only words with this in the name", default="")
    option(
        show,
        "--set",
        "NAME=VALUE",
        "a setting that changes the size of a state file, as bins=8; a store has its own",
        setting,
        action="append",
        default=[],
    )
    show.set_defaults(run=run_state)


def run_state(arguments: argparse.Namespace) -> None:
    from ..replay.state_in_words import in_words, words_of_file

    words = words_of_file(arguments.file, dict(arguments.set))
    found = [word for word in words if arguments.find.upper() in word.name.upper()]
    if arguments.find and not found:
        raise ZerorateError(f"{arguments.file}: no word has {arguments.find} in its name")
    print(in_words(found))


def add_export(subparsers: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = subparsers.add_parser("export", help="write the firmware as C")
    actions = parser.add_subparsers(metavar="LANGUAGE", required=True)
    c = actions.add_parser("c", help="a header, a C file, a test program, and build files")
    option(c, "folder", "DIR", "folder to write", Path)
    for name, default in (("odr-hz", 100.0), ("gyro-lsb-per-dps", 131.0)):
        option(c, f"--{name}", "N", f"{default:g}", float, default=default)
    for name, default in (("accel-lsb-per-g", 16384.0), ("temp-lsb-per-degc", 340.0)):
        text = f"{default:g}; 0 where there is none"
        option(c, f"--{name}", "N", text, float, default=default)
    option(c, "--model", "FILE", "a model.bin; its scales replace those above", Path)
    c.set_defaults(run=run_export)


def run_export(arguments: argparse.Namespace) -> None:
    from zerorate import Sensor

    from zerorate_tools.kernels.export import export_c

    try:
        sensor = Sensor(
            arguments.odr_hz,
            arguments.gyro_lsb_per_dps,
            arguments.accel_lsb_per_g,
            arguments.temp_lsb_per_degc,
        )
        paths = export_c(arguments.folder, sensor, arguments.model)
    except ValueError as error:
        raise ZerorateError(str(error)) from error
    for path in paths:
        print(path)


def add_flash(subparsers: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = subparsers.add_parser(
        "flash",
        help="put the firmware and the driver on a MicroPython board",
        description="Ask the board what it is, compile zerorate and zerorate_i2c for it, and put "
        "them into its lib folder, all or none. Files that the board has already are not sent.",
    )
    option(parser, "port", "PORT", "serial port: /dev/ttyACM0, COM3, any path")
    switch(parser, "--dry-run", "only list the files and the memory that they need")
    option(
        parser,
        "--with",
        "PARTS",
        "parts besides learning at rest: motion,gravity,effects,refine,bursts,self-test,"
        "differing or all",
        lambda text: text.split(","),
        dest="parts",
        default=[],
    )
    switch(parser, "--only", "remove parts that are not named now")
    option(parser, "--main", "FILE", "copy FILE to main.py", Path)
    option(
        parser, "--model", "FILE", "copy FILE to model.bin, and send the part that loads it", Path
    )
    parser.set_defaults(run=run_flash)


def run_flash(arguments: argparse.Namespace) -> None:
    from ..boards.flashing import flash

    a = arguments
    flash(a.port, dry_run=a.dry_run, main=a.main, model=a.model, parts=a.parts, only=a.only)


PARSERS = {"model": add_model, "state": add_state, "export": add_export, "flash": add_flash}
