"""`zerorate allan`: the floor below which no model can go."""

import argparse
from pathlib import Path


def add_parser(subparsers: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = subparsers.add_parser(
        "allan",
        help="Allan deviation of a recording at rest",
        description="Allan deviation of the longest still stretch (overlapping, IEEE Std 952).",
    )
    parser.add_argument("log", type=Path, metavar="LOG", help="a recording, at rest for a while")
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> None:
    """Print the deviation by cluster time, and its lowest point."""
    from ..allan import overlapping
    from ..loop.read.stretch import still_stretch

    rate_dps, each_s = still_stretch(arguments.log)
    tau_s, deviation_dps = overlapping(rate_dps, each_s)
    print(f"the longest stretch at rest: {len(rate_dps) * each_s:,.1f} s")
    print("   tau_s     x_mdps     y_mdps     z_mdps")
    for tau, row in zip(tau_s, deviation_dps):
        print(f"{tau:8.2f} " + " ".join(f"{1e3 * v:10.4f}" for v in row))
    floor = 1e3 * deviation_dps.min(axis=0)
    print("   floor " + " ".join(f"{v:10.4f}" for v in floor))
