"""`zerorate flash`: the firmware and the driver onto a board."""

import argparse
from pathlib import Path


def add_parser(subparsers: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = subparsers.add_parser(
        "flash",
        help="put the firmware and the driver on a MicroPython board",
        description="Ask the board what it is, compile zerorate and zerorate_i2c for it, and put "
        "them into its lib folder: whole, or not at all. What is there already is not sent again.",
    )
    parser.add_argument("port", metavar="PORT", help="serial port: /dev/ttyACM0, COM3, any path")
    parser.add_argument("--dry-run", action="store_true", help="list files and needs only")
    parser.add_argument(
        "--with",
        dest="parts",
        type=lambda text: text.split(","),
        default=[],
        metavar="PARTS",
        help="more than learning at rest: motion,gravity,effects,refine,bursts,self-test,"
        "differing or all",
    )
    parser.add_argument(
        "--only", action="store_true", help="remove parts sent before that are not named now"
    )
    parser.add_argument("--main", type=Path, metavar="FILE", help="copy FILE to main.py too")
    parser.add_argument(
        "--model",
        type=Path,
        metavar="FILE",
        help="copy FILE to model.bin too, and send what it needs",
    )
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> None:
    from ..boards.flashing import flash

    a = arguments
    flash(a.port, dry_run=a.dry_run, main=a.main, model=a.model, parts=a.parts, only=a.only)
