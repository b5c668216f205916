"""`zerorate bench`: what is claimed, measured; each bench is a sub-command of its own."""

from __future__ import annotations

import argparse
import json
from pathlib import Path

_MORE = """\
Without a BENCH it measures what a sample costs, the replay, and the bias error beside everyone
else's, and says beside each figure what it must be: a quarter of an hour. The others are run by
name. `--quick` is a look at the same tables in a few minutes, not to be quoted.
"""
_QUICK_HOURS = (1.0, 4.0)
_QUICK_SEEDS = (1,)


def add_parser(subparsers) -> None:
    """Register the sub-command and its benches."""
    parser = subparsers.add_parser(
        "bench", help="measure what this project claims", description=_MORE
    )
    add_extent(parser)
    parser.set_defaults(run=run_main)
    benches = parser.add_subparsers(dest="bench", metavar="BENCH")
    add_accuracy(benches)
    add_boards(benches)
    add_cost(benches)
    add_faults(benches)
    add_filters(benches)
    add_fleet(benches)
    add_loop(benches)
    add_motion(benches)
    add_peers(benches)
    add_real(benches)
    add_refine(benches)
    add_service(benches)


def add_extent(parser) -> None:
    """How much is measured, and where the report goes."""
    parser.add_argument("--quick", action="store_true", help="short recordings and one seed")
    add_outputs(parser)


def run_main(arguments: argparse.Namespace) -> None:
    """Measure cost and accuracy and write one report."""
    from ..bench.cost_and_accuracy import in_markdown, measure, steps
    from ..progress import progress

    hours, seeds = extent(arguments)
    with progress("measuring", steps(seeds)) as advance:
        found = measure(hours, seeds, advance)
    write_report(arguments, in_markdown(found), found)


def extent(arguments: argparse.Namespace) -> tuple[tuple[float, ...], tuple[int, ...]]:
    """Hours of the replays, and seeds."""
    from ..bench.accuracy import SEEDS
    from ..bench.replay_speed import HOURS

    return (_QUICK_HOURS, _QUICK_SEEDS) if arguments.quick else (HOURS, SEEDS)


def add_accuracy(benches) -> None:
    """Register `bench accuracy`."""
    parser = benches.add_parser("accuracy", help="the bias error beside everyone else's")
    add_extent(parser)
    parser.set_defaults(run=run_accuracy)


def run_accuracy(arguments: argparse.Namespace) -> None:
    """Measure and write."""
    from ..bench.accuracy_report import accuracy, in_markdown, steps
    from ..progress import progress

    _, seeds = extent(arguments)
    with progress("measuring accuracy", steps(seeds)) as advance:
        found = accuracy(advance, seeds)
    write_report(arguments, in_markdown(found), found)


def add_boards(benches) -> None:
    """Register `bench boards`."""
    parser = benches.add_parser("boards", help="memory, time and numbers on an emulated Pico")
    add_outputs(parser)
    parser.set_defaults(run=run_boards)


def run_boards(arguments: argparse.Namespace) -> None:
    """Measure and write."""
    from ..bench.boards import in_markdown, measure
    from ..bench.boards.measuring import STEPS
    from ..progress import progress

    with progress("measuring on a Pico", STEPS) as advance:
        found = measure(advance)
    write_report(arguments, in_markdown(found), found)


def add_cost(benches) -> None:
    """Register `bench cost`."""
    parser = benches.add_parser("cost", help="instructions, heap, sizes and replay speed")
    add_extent(parser)
    parser.set_defaults(run=run_cost)


def run_cost(arguments: argparse.Namespace) -> None:
    """Measure and write."""
    from ..bench.cost import STEPS, cost
    from ..bench.cost_report import in_markdown
    from ..progress import progress

    hours, _ = extent(arguments)
    with progress("measuring cost", STEPS) as advance:
        found = cost(advance, hours)
    write_report(arguments, in_markdown(found), found)


def add_outputs(parser) -> None:
    """The two places where a report can go."""
    parser.add_argument("--out", type=Path, metavar="FILE", help="write Markdown, not print it")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the figures there too")


def write_report(arguments: argparse.Namespace, text: str, found: object) -> None:
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


def add_filters(benches) -> None:
    """Register `bench filters`."""
    parser = benches.add_parser("filters", help="heading of attitude filters fed by zerorate")
    parser.add_argument("--data", type=Path, metavar="DIR", help="folder of BROAD trials (.mat)")
    add_outputs(parser)
    parser.set_defaults(run=run_filters)


def run_filters(arguments: argparse.Namespace) -> None:
    """Measure and write."""
    from ..bench.filters import in_markdown, run
    from ..progress import progress

    with progress("trials") as advance:
        found = run(arguments.data, advance)
    write_report(arguments, in_markdown(found), found)


def add_fleet(benches) -> None:
    """Register `bench fleet`."""
    parser = benches.add_parser("fleet", help="many devices at once, and what a prior is worth")
    sizes = {"type": int, "nargs": "+", "metavar": "N", "default": (100, 500, 2000)}
    parser.add_argument("--devices", **sizes, help="sizes of the fleet (100 500 2000)")
    add_outputs(parser)
    parser.set_defaults(run=run_fleet)


def run_fleet(arguments: argparse.Namespace) -> None:
    """Measure and write."""
    from ..bench.fleet import WORKERS, markdown, run, steps
    from ..progress import progress

    sizes = sorted(arguments.devices)
    with progress("devices", steps(sizes, WORKERS)) as advance:
        found = run(sizes, advance=advance)
    write_report(arguments, markdown(found), found)


def add_loop(benches) -> None:
    """Register `bench loop`."""
    parser = benches.add_parser("loop", help="what closing the loop finds, and what it invents")
    parser.add_argument("--nulls", type=int, default=200, metavar="N", help="recordings of nothing")
    parser.add_argument("--seeds", type=int, default=20, metavar="N", help="devices an effect")
    parser.add_argument("--processes", type=int, default=2, metavar="N")
    parser.add_argument("--data", type=Path, metavar="DIR", help="folder of real recordings")
    parser.add_argument("--resume", type=Path, metavar="FILE", help="outcomes: go on from them")
    parser.add_argument("--plots", type=Path, metavar="DIR", help="PNGs of the real recordings")
    add_outputs(parser)
    parser.set_defaults(run=run_loop)


def run_loop(arguments: argparse.Namespace) -> None:
    """Measure and write."""
    from ..bench.loop import markdown, run

    options = {name: getattr(arguments, name) for name in ("data", "resume", "plots")}
    found = run(arguments.nulls, arguments.seeds, arguments.processes, **options)
    write_report(arguments, markdown(found), found)


def add_real(benches) -> None:
    """Register `bench real`."""
    parser = benches.add_parser("real", help="closing the loop on real recordings, each alone")
    parser.add_argument("--data", type=Path, metavar="DIR", help="folder of real recordings")
    parser.add_argument("--plots", type=Path, metavar="DIR", help="PNGs of them")
    add_outputs(parser)
    parser.set_defaults(run=run_real)


def run_real(arguments: argparse.Namespace) -> None:
    """Measure and write."""
    from ..bench.loop.real import in_words, real_rows
    from ..bench.real_recordings import data_folder
    from ..errors import ZerorateError

    folder = arguments.data or data_folder()
    if folder is None or not Path(folder).is_dir():
        raise ZerorateError("bench real: no recordings; name their folder with --data DIR")
    rows = real_rows(Path(folder), arguments.plots)
    write_report(arguments, in_words(rows), rows)


def add_motion(benches) -> None:
    """Register `bench motion`."""
    parser = benches.add_parser("motion", help="the bias learned in motion beside vqf's")
    parser.add_argument("--data", type=Path, metavar="DIR", help="folder of BROAD trials (.mat)")
    add_outputs(parser)
    parser.set_defaults(run=run_motion)


def add_service(benches) -> None:
    """Register `bench service`."""
    parser = benches.add_parser("service", help="`zerorate run` through faults, kills, full disks")
    parser.add_argument("--hours", type=float, default=24, metavar="N", help="simulated (24)")
    parser.add_argument("--faults", type=int, default=1000, metavar="N", help="how many (1000)")
    add_outputs(parser)
    parser.set_defaults(run=run_service)


def run_service(arguments: argparse.Namespace) -> None:
    """Live through them and write."""
    from ..bench.service import in_words, run

    found = run(arguments.hours, arguments.faults)
    write_report(arguments, in_words(found), found)


def add_refine(benches) -> None:
    """Register `bench refine`."""
    parser = benches.add_parser("refine", help="one unit's effect model on another unit, refined")
    parser.add_argument("--seeds", type=int, default=20, metavar="N", help="units (default: 20)")
    add_outputs(parser)
    parser.set_defaults(run=run_refine)


def run_refine(arguments: argparse.Namespace) -> None:
    """Measure and write."""
    from ..bench.second_unit import run, table

    found = run(arguments.seeds)
    write_report(arguments, table(found), found)


def run_motion(arguments: argparse.Namespace) -> None:
    """Measure and write."""
    from ..bench.motion import run
    from ..bench.motion_table import table

    found = run(arguments.data)
    write_report(arguments, table(found), found)


def add_peers(benches) -> None:
    """Register `bench peers`."""
    parser = benches.add_parser("peers", help="what the figures of other filters hang on")
    add_extent(parser)
    parser.set_defaults(run=run_peers)


def run_peers(arguments: argparse.Namespace) -> None:
    """Measure and write."""
    from ..bench.peer_differences import CASES, in_markdown, peer_differences
    from ..progress import progress

    _, seeds = extent(arguments)
    with progress("simulating", len(CASES)) as advance:
        found = peer_differences(seeds, advance)
    write_report(arguments, in_markdown(found), {"cases": found})
