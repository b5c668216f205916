"""`zerorate flash`: the firmware and the driver onto a board."""

from __future__ import annotations

import argparse
from pathlib import Path


def add_parser(subparsers) -> None:
    """Register the sub-command."""
    parser = subparsers.add_parser(
        "flash",
        help="put the firmware and the driver on a MicroPython board",
        description="Copy zerorate and zerorate_i2c to the board's lib folder through mpremote.",
    )
    parser.add_argument("port", metavar="PORT", help="serial port, such as /dev/ttyACM0 or COM3")
    parser.add_argument("--dry-run", action="store_true", help="list every file and its size only")
    parser.add_argument("--main", type=Path, metavar="FILE", help="copy FILE to main.py too")
    parser.add_argument("--model", type=Path, metavar="FILE", help="copy FILE to model.bin too")
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> None:
    """Copy, saying each file."""
    from ..boards import flash

    a = arguments
    flash(a.port, dry_run=a.dry_run, main=a.main, model=a.model)
