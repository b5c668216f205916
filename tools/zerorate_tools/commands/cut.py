"""`zerorate cut`: one file that holds several recordings, a file for each."""

import argparse
from pathlib import Path
from typing import Any


def add_parser(subparsers: Any) -> None:
    parser = subparsers.add_parser(
        "cut",
        help="cut a file where another recording begins",
        description="Cut a recording, or a table that is yet to be imported, into the stretches\n"
        "before and from each row named. The parts of a table keep its lines of names.",
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("source", type=Path, metavar="SRC", help="a recording, or a table of text")
    parser.add_argument(
        "--at-row",
        type=_row,
        action="append",
        required=True,
        metavar="N",
        help="the data row, counted from 1, that begins a part; may be repeated",
    )
    parser.add_argument(
        "-o", "--out", type=Path, required=True, metavar="DIR", help="folder to write"
    )
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> None:
    from ..importers import cut

    for part in cut(arguments.source, arguments.at_row, arguments.out):
        print(part)


def _row(text: str) -> int:
    if (row := int(text)) < 2:
        raise argparse.ArgumentTypeError(f"{row} begins no second part; write 2 or more")
    return row
