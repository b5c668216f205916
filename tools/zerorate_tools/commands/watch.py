"""`zerorate watch`: the firmware at work, live."""

import argparse
from pathlib import Path

from ..errors import ZerorateError
from .numbers_given import above_zero
from .replay import add_sources


def add_parser(subparsers: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = subparsers.add_parser(
        "watch",
        help="the firmware live on a recording being written, or on a board",
        description="Show rates, bias with its source and quality, temperature and what is being "
        "learned, until Ctrl-C. SOURCE is a .csv that is being written (by `zerorate record` too), "
        "a board's serial port, or /dev/i2c-N.",
    )
    parser.add_argument("source", metavar="SOURCE", help="run.csv, /dev/ttyACM0 or /dev/i2c-1")
    parser.add_argument(
        "--for", dest="seconds", type=above_zero, metavar="SECONDS", help="then end"
    )
    parser.add_argument("--once", action="store_true", help="show what is there, and end")
    parser.add_argument("--every", type=above_zero, metavar="SECONDS", help="between two looks")
    parser.add_argument("--plain", action="store_true", help="lines, on a terminal too")
    parser.add_argument("--model", type=Path, metavar="FILE", help="an effect model to load")
    add_sources(parser)
    parser.add_argument("--own", action="store_true", help="what the board's own program prints")
    parser.add_argument("--plot", type=Path, metavar="FILE", help="then draw the bias over time")
    parser.add_argument(
        "--setup", type=Path, metavar="FILE", help="on a board: source that makes `imu`"
    )
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Watch; 1 where no sample, or no line, ever came."""
    if arguments.own and (arguments.model or arguments.setup):
        raise ZerorateError("--own leaves the board's program as it is; drop --model and --setup")
    from ..small_file import text_of
    from ..watch.options import WatchOptions
    from ..watch.watching import watch

    options = WatchOptions(
        seconds=arguments.seconds,
        once=arguments.once,
        every_s=arguments.every,
        plain=arguments.plain,
        settings={"motion": arguments.motion, "gravity": arguments.gravity},
        model=arguments.model,
        setup=text_of(arguments.setup, "name MicroPython source") if arguments.setup else "",
        own=arguments.own,
    )
    live = watch(arguments.source, options)
    if live and arguments.plot:
        from ..watch.picture import draw

        draw(live, arguments.plot)
        print(arguments.plot)
    return 0 if live else 1
