"""`zerorate fleet`: many recordings at once."""

import argparse
from pathlib import Path

from .as_json import add_json, print_json
from .numbers_given import above_zero


def add_parser(subparsers: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = subparsers.add_parser(
        "fleet",
        help="many devices' recordings at once, and a prior for the next device",
        description="Run the recordings of many devices through replay or close, on this machine's "
        "cores or on a Dask cluster; say what they have in common, and make a prior for a new "
        "device of the part. A folder device=NAME on a file's path names its device. Run again "
        "over the same DIR, it does only what is left.",
    )
    parser.add_argument(
        "recordings",
        nargs="+",
        metavar="RECORDING",
        help="files, patterns, or folders of them; s3://, gs:// too",
    )
    parser.add_argument(
        "-o", "--out", type=_folder, required=True, metavar="DIR", help="folder to write"
    )
    parser.add_argument(
        "--job", choices=("replay", "close"), default="replay", help="run for each (replay)"
    )
    parser.add_argument(
        "--device-from",
        metavar="REGEX",
        help="a device's name is this expression's first group, found in the file's path",
    )
    parser.add_argument("--keep", action="store_true", help="keep each device's own files too")
    parser.add_argument("--model", type=Path, metavar="FILE", help="an effect model to load")
    parser.add_argument(
        "--minutes",
        type=above_zero,
        default=5.0,
        metavar="N",
        help="of a new device, to try the prior on (5)",
    )
    group = parser.add_argument_group("where it runs")
    group.add_argument("--scheduler", metavar="ADDRESS", help="of a Dask cluster that is there")
    group.add_argument("--workers", type=_count, metavar="N", help="processes here (all cores)")
    group.add_argument("--devices-per-task", type=_count, metavar="N", help="instead of by size")
    add_json(parser)
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Run the fleet and print what came of it; 1 where no device could be used."""
    from ..fleet import devices_of, fleet
    from ..fleet.fleet_in_words import in_words
    from ..progress import progress

    out = arguments.out
    devices = devices_of(arguments.recordings, arguments.device_from, without=out)
    options = {
        name: getattr(arguments, name)
        for name in ("job", "scheduler", "workers", "devices_per_task", "model", "keep", "minutes")
    }
    with progress("devices", len(devices)) as advance:
        done = fleet(devices, out, **options, advance=advance)
    if arguments.json:
        print_json({"written": out, "resumed": done.resumed, **done.report})
    else:
        print(in_words(done))
        print(f"written: {out}")
    return 0 if done.report["sessions"] else 1


def _folder(text: str) -> Path:
    if "://" in text:
        raise argparse.ArgumentTypeError(f"{text} is no folder of this machine; name one")
    return Path(text)


def _count(text: str) -> int:
    number = int(text)
    if number < 1:
        raise argparse.ArgumentTypeError(f"{text} is not 1 or more")
    return number
