"""`zerorate close`: find what the model lacks, add it, and say what is left."""

import argparse
from pathlib import Path

from .as_json import add_json, print_json


def add_parser(subparsers: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = subparsers.add_parser(
        "close",
        help="find effects that the model lacks, and correct them",
        description="Each LOG is one power-on of one device. One of them is held out and looked at "
        "once, at the end; with a single LOG, stretches of its time are.",
    )
    parser.add_argument(
        "logs", type=Path, nargs="+", metavar="LOG", help="a recording of one power-on"
    )
    parser.add_argument(
        "-o", "--out", type=Path, required=True, metavar="DIR", help="folder to write"
    )
    parser.add_argument("--holdout", metavar="LOG", help="which to hold out (default: the last)")
    parser.add_argument(
        "--online",
        action="store_true",
        help="bias_online_g? in corrected.parquet: the firmware learning as it goes",
    )
    add_json(parser)
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> None:
    """Close the loop and print what was found."""
    from ..closing import close
    from ..closing_in_motion import motion_in_words
    from ..loop.report.in_words import in_words
    from ..progress import progress
    from ..report.sentences import headline, why_both

    with progress("reading, replaying", 2 * len(arguments.logs)) as advance:
        result = close(
            arguments.logs,
            arguments.out,
            arguments.holdout,
            advance,
            online=arguments.online,
        )
    if arguments.json:
        print_json({**result, "folder": arguments.out})
        return
    if "in_motion" in result:
        print(motion_in_words(result))
        print(f"report: {arguments.out / 'report.html'}")
        return
    print(headline(result) + ".")
    if why := why_both(result):
        print(why)
    print(in_words(result))
    print(f"report: {arguments.out / 'report.html'}")
