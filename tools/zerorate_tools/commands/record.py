"""`zerorate record`: a recording from a board or from a Linux I2C bus."""

import argparse
from pathlib import Path


def add_parser(subparsers) -> None:
    parser = subparsers.add_parser(
        "record",
        help="make a recording from a board or a Linux I2C bus",
        description="Record a chip until Ctrl-C: PORT is a board's serial port or /dev/i2c-N.",
    )
    parser.add_argument("port", metavar="PORT", help="/dev/ttyACM0, COM3 or /dev/i2c-1")
    parser.add_argument(
        "--out", type=Path, required=True, metavar="FILE", help=".parquet, .csv or .csv.gz"
    )
    parser.add_argument("--seconds", type=float, metavar="S", help="end by itself after this long")
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


def run(arguments: argparse.Namespace) -> None:
    from ..boards.recording import record
    from ..progress import progress

    names = ("address", "odr_hz", "full_scale_dps", "full_scale_g", "dlpf_hz", "part", "setup")
    options = {k: v for k in names if (v := getattr(arguments, k)) is not None}
    if "setup" in options:
        options["setup"] = options["setup"].read_text(encoding="utf-8")
    with progress(f"recording {arguments.port}", arguments.seconds) as done:
        result = record(
            arguments.port, arguments.out, seconds=arguments.seconds, done=done, **options
        )
    print(f"{arguments.out}: {result}")
