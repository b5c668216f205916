"""Commands that make recordings: `zerorate simulate`, `import` and `cut`."""

import argparse
from pathlib import Path
from typing import Any

from .options import above_zero, add_json, finite, option, print_json, switch


def add_simulate(subparsers: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = subparsers.add_parser(
        "simulate",
        help="make recordings of a described device",
        description="Make recordings of a device described in TOML or YAML, or of a bundled one.",
    )
    parser.add_argument("description", nargs="?", help=".toml, .yaml, or a bundled scenario's name")
    option(parser, "-o --out", "FILE", ".parquet, .csv or .csv.gz", Path)
    option(parser, "--truth", "FILE", "also write the true bias (.parquet)", Path)
    option(parser, "--session", "N", "only this power-on, counted from 1", int)
    option(parser, "--seed", "N", "seed to use instead of the description's", _seed)
    switch(parser, "--list", "list the bundled scenarios")
    switch(parser, "--entries", "list what a description may contain")
    parser.set_defaults(run=run_simulate, refuse=parser.error)


def _seed(text: str) -> int:
    seed = int(text)
    if seed < 0:
        raise argparse.ArgumentTypeError(f"{seed} is below 0; write 0 or more")
    return seed


def run_simulate(arguments: argparse.Namespace) -> int:
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


_EPILOG = """\
A mapping names a column of the recording, where it comes from, and its unit:
  --map gx=gyro_x:rad/s --map temp=T:degc --map t_us=time:ms --map vdd_mv=volts:x1000
  --map t_us=sec:s+nanosec:ns adds two; --map gx=-gyro_x changes a sign; --map temp=none leaves out.
units: time s ms us ns; rates dps mdps rad/s lsb; acceleration g mg m/s2 lsb; temperature degc k
degf lsb; an extra channel takes a factor. Usual names, and a unit at their end (gx_dps), need no
mapping. Columns without names are 1, 2, 3; an (n, 3) variable of a .mat is name[0] to name[2].
"""


def add_import(subparsers: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = subparsers.add_parser(
        "import",
        help="convert a recording of another program or device",
        description="Turn a table (CSV, TSV, Parquet, .mat), a flight log (PX4 ULog, ArduPilot\n"
        "DataFlash, Betaflight blackbox) or a bag (ROS 1, ROS 2, MCAP) into a recording,\n"
        "and say what was dropped and why. Takes at most 600 MB, however large the file is.",
        epilog=_EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    what = "a recording; files of its sensors; or recordings of one device"
    option(parser, "sources", "SRC", what, Path, nargs="+")
    option(
        parser,
        "-o --out",
        "FILE",
        ".parquet, .csv or .csv.gz, of one recording; or the folder for a .parquet of each SRC",
        Path,
        required=True,
    )
    option(
        parser,
        "--map",
        "NAME=COLUMN",
        "source and unit of a column (see below); may be repeated",
        _mapping,
        action="append",
        default=[],
    )
    option(parser, "--hz", "N", "sample rate, as 100 or 1/15, if there are no time stamps", _hz)
    option(parser, "--sensor", "NAME", "name of the part, stored in the recording")
    chosen = "scale to write (default: chosen from the data)"
    option(parser, "--gyro-lsb-per-dps", "N", chosen, above_zero)
    option(parser, "--accel-lsb-per-g", "N", chosen, above_zero)
    option(parser, "--temp-lsb-per-degc", "N", chosen, above_zero)
    option(parser, "--temp-offset-degc", "N", "temperature of a raw reading of 0", finite)
    for kind in ("time", "gyro", "accel", "temp"):
        parser.add_argument(
            f"--{kind}-unit", metavar="UNIT", help="unit of columns whose mapping names none"
        )
    option(parser, "--instance", "N", "which of several sensors in a log (0)", int, default=0)
    add_json(parser)
    parser.set_defaults(run=run_import)


def run_import(arguments: argparse.Namespace) -> None:
    from ..importers import Options, import_recording, import_together
    from ..progress import progress
    from ..recordings.writing import is_recording_name

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
        one = len(sources) == 1 or is_recording_name(arguments.out)
        if one and not arguments.out.is_dir():
            report = import_recording(sources, arguments.out, **how, advance=advance)
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


def add_cut(subparsers: Any) -> None:
    parser = subparsers.add_parser(
        "cut",
        help="cut a file that holds several recordings",
        description="Cut a recording, or a text table not imported yet, before each given row. "
        "Each part of a table keeps its lines of names.",
    )
    option(parser, "source", "SRC", "a recording, or a table of text", Path)
    option(
        parser,
        "--at-row",
        "N",
        "the data row, counted from 1, that begins a part; may be repeated",
        _row,
        action="append",
        required=True,
    )
    option(parser, "-o --out", "DIR", "folder to write", Path, required=True)
    parser.set_defaults(run=run_cut)


def run_cut(arguments: argparse.Namespace) -> None:
    from ..importers import cut

    for part in cut(arguments.source, arguments.at_row, arguments.out):
        print(part)


def _row(text: str) -> int:
    if (row := int(text)) < 2:
        raise argparse.ArgumentTypeError(f"{row} begins no second part; write 2 or more")
    return row


PARSERS = {"simulate": add_simulate, "import": add_import, "cut": add_cut}
