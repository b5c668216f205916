"""`zerorate import`: foreign recordings into the project's own form."""

import argparse
from pathlib import Path
from typing import Any

from .as_json import add_json, print_json
from .numbers_given import above_zero, finite

_EPILOG = """\
A mapping names a column of the recording, where it comes from, and its unit:
  --map gx=gyro_x:rad/s --map temp=T:degc --map t_us=time:ms --map vdd_mv=volts:x1000
  --map t_us=sec:s+nanosec:ns adds two; --map temp=none leaves a column out.
units: time s ms us ns; rates dps mdps rad/s lsb; acceleration g mg m/s2 lsb; temperature degc k
degf lsb; an extra channel takes a factor. Usual names and a unit at their end (gx_dps) are seen.
Columns that no line names are called 1, 2, 3; an (n, 3) variable of a .mat name[0] to name[2].
"""


def add_parser(subparsers: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = subparsers.add_parser(
        "import",
        help="turn a foreign recording into this form",
        description="Turn a table (CSV, TSV, Parquet, .mat), a flight log (PX4 ULog, ArduPilot\n"
        "DataFlash, Betaflight blackbox) or a bag (ROS 1, ROS 2, MCAP) into a recording,\n"
        "and say what was dropped and why. Takes at most 600 MB, however large the file is.",
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        "sources", type=Path, nargs="+", metavar="SRC", help="foreign recordings of one device"
    )
    parser.add_argument(
        "-o",
        "--out",
        type=Path,
        required=True,
        metavar="FILE",
        help=".parquet, .csv or .csv.gz; for several SRC the folder of their .parquet",
    )
    parser.add_argument(
        "--map",
        action="append",
        default=[],
        type=_mapping,
        metavar="NAME=COLUMN",
        help="where a column comes from, and its unit (see below); may be repeated",
    )
    parser.add_argument(
        "--hz", type=_hz, metavar="N", help="samples a second, or 1/15, instead of time stamps"
    )
    parser.add_argument("--sensor", metavar="NAME", help="the part, for the record")
    chosen = "scale to write; chosen where it is not given"
    parser.add_argument("--gyro-lsb-per-dps", type=above_zero, metavar="N", help=chosen)
    parser.add_argument("--accel-lsb-per-g", type=above_zero, metavar="N", help=chosen)
    parser.add_argument("--temp-lsb-per-degc", type=above_zero, metavar="N", help=chosen)
    parser.add_argument(
        "--temp-offset-degc", type=finite, metavar="N", help="temperature of a raw reading of 0"
    )
    for kind in ("time", "gyro", "accel", "temp"):
        parser.add_argument(f"--{kind}-unit", metavar="UNIT", help="where a mapping names none")
    parser.add_argument(
        "--instance", type=int, default=0, metavar="N", help="of several sensors in a log (0)"
    )
    add_json(parser)
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> None:
    from ..importers import Options, import_recording, import_together
    from ..progress import progress

    known = {k: v for k, v in vars(arguments).items() if k in Options.__dataclass_fields__}
    units = {k: getattr(arguments, f"{k}_unit") for k in ("time", "gyro", "accel", "temp")}
    sources = arguments.sources
    size = sum(source.stat().st_size for source in sources if source.is_file())
    how = {
        "options": Options(**known),
        "mapping": arguments.map,
        "units": {kind: unit.lower() for kind, unit in units.items() if unit},
        "instance": arguments.instance,
    }
    with progress(f"importing {sources[0].name}", size or None) as advance:
        if len(sources) == 1 and not arguments.out.is_dir():
            report = import_recording(sources[0], arguments.out, **how, advance=advance)
            reports = {arguments.out: report}
        else:
            reports = import_together(sources, arguments.out, **how, advance=advance)
    if arguments.json:
        print_json({"recordings": [{"file": o, **vars(report)} for o, report in reports.items()]})
        return
    for out, report in reports.items():
        print(out)
        for line in report.lines():
            print(" ", line)


def _mapping(text: str) -> Any:
    from ..importers import parsed_mapping

    try:
        return parsed_mapping(text)
    except ValueError as error:
        raise argparse.ArgumentTypeError(str(error)) from error


def _hz(text: str) -> float:
    """A rate, or a fraction: 0.0666667 for 1/15 would be a row off after some hours."""
    over, slash, under = text.partition("/")
    return above_zero(over) / (above_zero(under) if slash else 1.0)
