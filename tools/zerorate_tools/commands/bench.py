"""`zerorate bench`: what is claimed, measured; each bench is a sub-command of its own."""

from __future__ import annotations

import argparse
from pathlib import Path


def add_parser(subparsers) -> None:
    """Register the sub-command and its benches."""
    parser = subparsers.add_parser("bench", help="measure what this project claims")
    benches = parser.add_subparsers(dest="bench", metavar="BENCH", required=True)
    add_faults(benches)


def add_faults(benches) -> None:
    """Register `bench faults`."""
    parser = benches.add_parser(
        "faults",
        help="every fault of a bus and every cut of a write",
        description="Inject every fault; exit code 1 when one goes unnoticed or is learned from.",
    )
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the tables there too")
    parser.set_defaults(run=run_faults)


def run_faults(arguments: argparse.Namespace) -> int:
    """Inject, print both tables and say by the exit code whether all is well."""
    from ..bench.faults import passed, run

    return 0 if passed(run(arguments.json)) else 1
