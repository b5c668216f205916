"""`zerorate model`: look at effect models."""

import argparse
from pathlib import Path

FILE = "a model.bin or model.json"


def add_parser(subparsers: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = subparsers.add_parser(
        "model",
        help="show, check or compare effect models",
        description="Look at effect models: model.bin, or its readable twin model.json.",
    )
    actions = parser.add_subparsers(metavar="ACTION", required=True)
    show = actions.add_parser("show", help="say in words what a model corrects")
    show.add_argument("file", type=Path, metavar="FILE", help=FILE)
    show.add_argument("--json", action="store_true", help="print model.json instead")
    show.set_defaults(run=run_show)
    _add_check(actions)
    diff = actions.add_parser("diff", help="say how two models differ; exit code 1 if they do")
    diff.add_argument("one", type=Path, metavar="A", help=FILE)
    diff.add_argument("other", type=Path, metavar="B", help=FILE)
    diff.set_defaults(run=run_diff)


def _add_check(actions: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    check = actions.add_parser(
        "check",
        help="say whether a device would load a model",
        description="Ask the firmware's own reader whether a device would load a model; "
        "exit code 2 and the reason if not.",
    )
    check.add_argument("file", type=Path, metavar="FILE", help=FILE)
    for option, what in (
        ("--chip-id", "WHO_AM_I of the device, for example 0x68"),
        ("--gyro-range", "code of its gyroscope's range, 0..3 for 250..2000 dps"),
        ("--accel-range", "code of its accelerometer's range, 0..3 for 2..16 g"),
        ("--filter", "code of its low-pass filter, 0..7"),
    ):
        check.add_argument(option, type=_code, metavar="CODE", help=what)
    check.add_argument("--log", type=Path, metavar="LOG", help="a recording of the device")
    check.set_defaults(run=run_check)


def run_show(arguments: argparse.Namespace) -> None:
    from ..model import read_model, to_json
    from ..model.model_in_words import in_words

    model = read_model(arguments.file)
    print(to_json(model), end="") if arguments.json else print(in_words(model))


def run_check(arguments: argparse.Namespace) -> None:
    """Print that the model would be loaded, or raise why not."""
    from ..model import Binding
    from ..model.check import check_model
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
