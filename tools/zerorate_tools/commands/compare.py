"""`zerorate compare`: would it have been better than your average at boot?"""

import argparse
from pathlib import Path

from .as_json import add_json, print_json


def add_parser(subparsers: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = subparsers.add_parser(
        "compare",
        help="how wrong your average at boot would have been, and zerorate",
        description="At each later rest of the recordings: how wrong the mean of the first rest, "
        "vqf, imufusion and zerorate would have been, in deg/s and degrees of heading lost a "
        "minute; and what the matrix of scale factors and axes would win in motion. It needs "
        "nothing but the logs: power-ons of one device, in their order.",
    )
    parser.add_argument("logs", nargs="+", type=Path, metavar="LOG", help="a recording")
    parser.add_argument(
        "-o", "--out", type=Path, metavar="FILE", help="write one HTML page with a plot"
    )
    add_json(parser)
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> None:
    """Print the headline and the table, and what the matrix would win; write the page."""
    from ..compare import TooFewRests, compare, matrix_of
    from ..compare.show import in_motion, table, write_page
    from ..progress import progress
    from ..recordings.atomic import check_apart

    check_apart([arguments.out], arguments.logs)
    with progress("comparing", len(arguments.logs) + 4) as advance:
        won = matrix_of(arguments.logs)
        advance(1)
        try:
            compared = compare(arguments.logs, advance)
        except TooFewRests:
            if won is None or not won.deployed or arguments.out is not None:
                raise
            print_json({"in_motion": won}) if arguments.json else print(in_motion(won))
            return
    if arguments.out is not None:
        write_page(compared, arguments.out, won)
    if arguments.json:
        print_json({**compared.figures(), "in_motion": won, "page": arguments.out})
        return
    print(table(compared))
    if won is not None:
        print(f"\n{in_motion(won)}")
    if arguments.out is not None:
        print(f"\n{arguments.out}")
