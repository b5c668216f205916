"""`zerorate state show FILE`: the words of a stored state by name."""

import argparse
from pathlib import Path

from .replay import setting


def add_parser(subparsers: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = subparsers.add_parser("state", help="show what a stored state holds, word by word")
    actions = parser.add_subparsers(metavar="ACTION", required=True)
    show = actions.add_parser("show", help="each word of a state or store: name, value, unit")
    show.add_argument("file", type=Path, metavar="FILE", help="of `replay --state`, or learned.bin")
    show.add_argument("--find", metavar="TEXT", default="", help="only words with this in the name")
    show.add_argument(
        "--set", action="append", default=[], type=setting, metavar="NAME=VALUE",
        help="a setting of a state file that changes its size, as bins=8; a store holds its own",
    )  # fmt: skip
    show.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> None:
    from ..replay.state_in_words import in_words, words_of_file

    words = words_of_file(arguments.file, dict(arguments.set))
    print(in_words([word for word in words if arguments.find.upper() in word.name.upper()]))
