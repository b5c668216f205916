"""`zerorate bench`: what is claimed, measured; each bench is a sub-command of its own."""

from __future__ import annotations

import argparse
import json
from pathlib import Path


def add_parser(subparsers) -> None:
    """Register the sub-command and its benches."""
    parser = subparsers.add_parser("bench", help="measure what this project claims")
    benches = parser.add_subparsers(dest="bench", metavar="BENCH", required=True)
    add_accuracy(benches)
    add_cost(benches)
    add_faults(benches)
    add_loop(benches)
    add_motion(benches)


def add_accuracy(benches) -> None:
    """Register `bench accuracy`."""
    parser = benches.add_parser("accuracy", help="the bias error beside everyone else's")
    add_outputs(parser)
    parser.set_defaults(run=run_accuracy)


def add_cost(benches) -> None:
    """Register `bench cost`."""
    parser = benches.add_parser("cost", help="instructions, heap, sizes and replay speed")
    add_outputs(parser)
    parser.set_defaults(run=run_cost)


def add_outputs(parser) -> None:
    """The two places where a report can go."""
    parser.add_argument("--out", type=Path, metavar="FILE", help="write Markdown, not print it")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the figures there too")


def run_accuracy(arguments: argparse.Namespace) -> None:
    """Measure and write."""
    from ..bench.accuracy_report import STEPS, accuracy, in_markdown
    from ..progress import progress

    with progress("measuring accuracy", STEPS) as advance:
        found = accuracy(advance)
    write_report(arguments, in_markdown(found), found)


def run_cost(arguments: argparse.Namespace) -> None:
    """Measure and write."""
    from ..bench.cost import STEPS, cost, in_markdown
    from ..progress import progress

    with progress("measuring cost", STEPS) as advance:
        found = cost(advance)
    write_report(arguments, in_markdown(found), found)


def write_report(arguments: argparse.Namespace, text: str, found: dict) -> None:
    """Print the Markdown or write it, and write the figures where they are wanted."""
    from ..recordings.atomic import written_beside

    if arguments.out is None:
        print(text)
    else:
        with written_beside(arguments.out) as temporary:
            temporary.write_text(text, encoding="utf-8")
    if arguments.json is not None:
        with written_beside(arguments.json) as temporary:
            temporary.write_text(json.dumps(found, indent=2) + "\n", encoding="utf-8")


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


def add_loop(benches) -> None:
    """Register `bench loop`."""
    parser = benches.add_parser("loop", help="what closing the loop finds, and what it invents")
    parser.add_argument("--nulls", type=int, default=200, metavar="N", help="recordings of nothing")
    parser.add_argument("--seeds", type=int, default=20, metavar="N", help="devices an effect")
    parser.add_argument("--processes", type=int, default=2, metavar="N")
    parser.add_argument("--data", type=Path, metavar="DIR", help="folder of real recordings")
    add_outputs(parser)
    parser.set_defaults(run=run_loop)


def run_loop(arguments: argparse.Namespace) -> None:
    """Measure and write."""
    from ..bench.loop import markdown, run

    found = run(arguments.nulls, arguments.seeds, arguments.processes, data=arguments.data)
    write_report(arguments, markdown(found), found)


def add_motion(benches) -> None:
    """Register `bench motion`."""
    parser = benches.add_parser("motion", help="the bias learned in motion beside vqf's")
    parser.add_argument("--data", type=Path, metavar="DIR", help="folder of BROAD trials (.mat)")
    add_outputs(parser)
    parser.set_defaults(run=run_motion)


def run_motion(arguments: argparse.Namespace) -> None:
    """Measure and write."""
    from ..bench.motion import run, table

    found = run(arguments.data)
    write_report(arguments, table(found), found)
