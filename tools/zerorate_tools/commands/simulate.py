"""`zerorate simulate`: recordings from a described device."""

import argparse
from pathlib import Path


def add_parser(subparsers: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = subparsers.add_parser(
        "simulate",
        help="make recordings of a described device",
        description="Make recordings of a device described in TOML or YAML, or of a bundled one.",
    )
    parser.add_argument("description", nargs="?", help=".toml, .yaml, or a bundled scenario's name")
    parser.add_argument("-o", "--out", type=Path, metavar="FILE", help=".parquet, .csv or .csv.gz")
    parser.add_argument("--truth", type=Path, metavar="FILE", help="the true bias too (.parquet)")
    parser.add_argument("--session", type=int, metavar="N", help="this power-on only, 1-based")
    parser.add_argument("--seed", type=_seed, metavar="N", help="instead of the description's")
    parser.add_argument("--list", action="store_true", help="list the bundled scenarios")
    parser.add_argument("--entries", action="store_true", help="what a description may say")
    parser.set_defaults(run=run, refuse=parser.error)


def _seed(text: str) -> int:
    seed = int(text)
    if seed < 0:
        raise argparse.ArgumentTypeError(f"{seed} is below 0; write 0 or more")
    return seed


def run(arguments: argparse.Namespace) -> int:
    """Simulate and say which files were written."""
    from ..progress import progress
    from ..simulate import bundled_names, load_description, reference, simulate_to_files

    if arguments.list or arguments.entries:
        print("\n".join(bundled_names()) if arguments.list else reference())
        return 0
    if arguments.description is None or arguments.out is None:
        arguments.refuse("a description and --out FILE are needed (or --list, --entries)")
    described = load_description(arguments.description)
    options = {"truth": arguments.truth, "session": arguments.session, "seed": arguments.seed}
    total = 1 if arguments.session else len(described.sessions)
    with progress(f"simulating {described.name}", total) as done:
        files = simulate_to_files(described, arguments.out, **options, done=done)
    for file in files:
        print(file)
    return 0
