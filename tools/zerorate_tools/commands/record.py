"""`zerorate record`: a recording from a board or from a Linux I2C bus."""

import argparse
import sys
from pathlib import Path
from typing import Any

from .numbers_given import above_zero


def add_parser(subparsers: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = subparsers.add_parser(
        "record",
        help="make a recording from a board or a Linux I2C bus",
        description="Record a chip until Ctrl-C: PORT is a board's serial port, /dev/i2c-N, "
        "or fake: for an emulated chip in a simulated hand. "
        "Until it ends the recording is in NAME.partial.csv, also if the program is killed.",
    )
    parser.add_argument("port", nargs="?", metavar="PORT", help="/dev/ttyACM0, COM3 or /dev/i2c-1")
    parser.add_argument("-o", "--out", type=Path, metavar="FILE", help=".parquet, .csv or .csv.gz")
    parser.add_argument(
        "--recover", type=Path, metavar="FILE", help="finish the .partial.csv of a killed one"
    )
    parser.add_argument(
        "--seconds", type=above_zero, metavar="S", help="end by itself after this long"
    )
    parser.add_argument(
        "--guide", action="store_true", help="say how to turn it in the hand, until all is known"
    )
    group = parser.add_argument_group("on a Linux bus")
    group.add_argument(
        "--address", type=lambda text: int(text, 0), metavar="N", help="of the chip (0x68)"
    )
    group.add_argument(
        "--hz", dest="odr_hz", type=float, metavar="N", help="output data rate (100)"
    )
    group.add_argument(
        "--dps", dest="full_scale_dps", type=int, metavar="N", help="250, 500, 1000 or 2000"
    )
    group.add_argument("--g", dest="full_scale_g", type=int, metavar="N", help="2, 4, 8 or 16")
    group.add_argument("--dlpf-hz", type=float, metavar="N", help="low-pass bandwidth of the gyro")
    group.add_argument(
        "--part", metavar="NAME", help="name the part where its id is of none known: MPU-6500"
    )
    board = parser.add_argument_group("on a board")
    board.add_argument(
        "--setup", type=Path, metavar="FILE", help="MicroPython source that makes `imu`"
    )
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Record, or finish a recording; 1 where no sample came."""
    from ..errors import ZerorateError

    if (arguments.port is None) == (arguments.recover is None):
        raise ZerorateError("name a PORT to record, or a file by --recover FILE")
    if arguments.recover is not None:
        _recover(arguments)
    elif arguments.out is None:
        raise ZerorateError("name the file to record into by --out FILE")
    else:
        return _record(arguments)
    return 0


def _recover(arguments: argparse.Namespace) -> None:
    from ..recordings import open_recording, recover

    target = recover(arguments.recover, arguments.out)
    samples = sum(len(columns["t_us"]) for columns in open_recording(target).batches())
    print(f"{target}: {samples} samples of {arguments.recover}")


def _record(arguments: argparse.Namespace) -> int:
    from ..boards.recording import record
    from ..progress import progress
    from ..recordings.growing import left_over
    from ..small_file import text_of

    for partial in left_over(arguments.out):
        finish = f"zerorate record --recover {partial} finishes it"
        print(f"{partial}: of a recording that was killed; {finish}", file=sys.stderr)
    names = ("address", "odr_hz", "full_scale_dps", "full_scale_g", "dlpf_hz", "part", "setup")
    options = {k: v for k in names if (v := getattr(arguments, k)) is not None}
    if "setup" in options:
        options["setup"] = text_of(options["setup"], "name MicroPython source")
    if arguments.guide:
        return _guided(arguments, options)
    with progress(f"recording {arguments.port}", arguments.seconds) as done:
        result = record(
            arguments.port, arguments.out, seconds=arguments.seconds, done=done, **options
        )
    return _made(arguments.out, result)


def _guided(arguments: argparse.Namespace, options: dict[str, Any]) -> int:
    """Record until every entry is known; say what is not where it ends before."""
    from ..boards.recording import FAKE, record
    from ..guide import Guide, screen, unknown

    with screen() as shown, Guide(shown, waits=arguments.port == FAKE) as guide:
        result = record(
            *(arguments.port, arguments.out),
            seconds=arguments.seconds,
            done=guide.done,
            heard=guide.heard,
            **options,
        )
    code = _made(arguments.out, result)
    if guide.known is not None and not guide.known.all_known:
        print(f"not known yet: {', '.join(unknown(guide.known))}")
    if not code:
        print(f"next: zerorate close {arguments.out} --out closed")
    return code


def _made(out: Path, result: Any) -> int:
    print(f"{out}: {result}" if result.samples else "no sample came, nothing is written")
    return 0 if result.samples else 1
