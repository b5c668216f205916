"""`zerorate bench`: what is claimed, measured. The benches are in a checkout, not in the wheel."""

import argparse
from importlib.util import find_spec


def add_parser(subparsers: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    """Register the sub-command with every bench that is there."""
    parser = subparsers.add_parser(
        "bench",
        help="measure what this project claims",
        description="Each bench measures figures that the pages claim. `--quick` is a short look.",
    )
    if find_spec("zerorate_bench") is None:
        parser.add_argument("bench", nargs="*", metavar="BENCH")
        parser.set_defaults(run=_refuse)
    else:
        from zerorate_bench.benches import add_benches

        add_benches(parser)


def _refuse(arguments: argparse.Namespace) -> None:
    from ..errors import ZerorateError

    do = "unpack the source distribution and run `pip install -e '.[tools,bench]'` there"
    raise ZerorateError(f"the wheel has no benchmarks; {do}")
