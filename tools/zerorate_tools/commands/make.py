"""Commands that make recordings: `zerorate simulate`, `import` and `cut`."""

import argparse
from pathlib import Path
from typing import Any

from ..progress import progress
from .options import JSON, above_zero, argument, command, finite, option, print_json, switch


def _seed(text: str) -> int:
    seed = int(text)
    if seed < 0:
        raise argparse.ArgumentTypeError(f"{seed} is below 0; write 0 or more")
    return seed


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


def _row(text: str) -> int:
    if (row := int(text)) < 2:
        raise argparse.ArgumentTypeError(f"{row} begins no second part; write 2 or more")
    return row


@command(
    "simulate",
    "make recordings of a described device",
    argument("description", nargs="?", help=".toml, .yaml, or a bundled scenario's name"),
    option("-o --out FILE", ".parquet, .csv or .csv.gz", Path),
    option("--truth FILE", "also write the true bias (.parquet)", Path),
    option("--session N", "only this power-on, counted from 1", int),
    option("--seed N", "seed to use instead of the description's", _seed),
    switch("--list", "list the bundled scenarios"),
    switch("--entries", "list what a description may contain"),
    description="Make recordings of a device described in TOML or YAML, or of a bundled one.",
)
def run_simulate(arguments: argparse.Namespace) -> None:
    from ..simulate import bundled_names, load_description, reference, simulate_to_files

    if arguments.list or arguments.entries:
        print("\n".join(bundled_names()) if arguments.list else reference())
        return
    if arguments.description is None or arguments.out is None:
        arguments.refuse("a description and --out FILE are needed (or --list, --entries)")
    described = load_description(arguments.description)
    options = {"truth": arguments.truth, "session": arguments.session, "seed": arguments.seed}
    total = 1 if arguments.session else len(described.sessions)
    with progress(f"simulating {described.name}", total) as done:
        files = simulate_to_files(described, arguments.out, **options, done=done)
    for file in files:
        print(file)


_EPILOG = """\
A mapping names a column of the recording, where it comes from, and its unit:
  --map gx=gyro_x:rad/s --map temp=T:degc --map t_us=time:ms --map vdd_mv=volts:x1000
  --map t_us=sec:s+nanosec:ns adds two; --map gx=-gyro_x changes a sign; --map temp=none leaves out;
  --map t_us=ticks:x30.5 takes ticks of 30.5 us; --map gx=rate_x:x0.1 takes tenths of dps.
units: time s ms us ns; rates dps mdps rad/s lsb; acceleration g mg ug m/s2 lsb; temperature degc
k degf lsb; an extra channel takes a factor. Usual names, and a unit at their end (gx_dps), need no
mapping. Columns without names are 1, 2, 3; an (n, 3) variable of a .mat is name[0] to name[2].
"""


_KINDS = ("time", "gyro", "accel", "temp")
_CHOSEN = "scale to write (default: chosen from the data)"


@command(
    "import",
    "convert a recording of another program or device",
    option(
        "sources SRC",
        "a recording; or the files of its sensors; or several recordings of one device",
        Path,
        nargs="+",
    ),
    option(
        "-o --out FILE",
        ".parquet, .csv or .csv.gz, of one recording; or the folder for a .parquet of each SRC",
        Path,
        required=True,
    ),
    option(
        "--map NAME=COLUMN",
        "source and unit of a column (see below); may be repeated",
        _mapping,
        action="append",
        default=[],
    ),
    option("--hz N", "sample rate, as 100 or 1/15, if there are no time stamps", _hz),
    option("--sensor NAME", "name of the part, stored in the recording"),
    option("--gyro-lsb-per-dps N", _CHOSEN, above_zero),
    option("--accel-lsb-per-g N", _CHOSEN, above_zero),
    option("--temp-lsb-per-degc N", _CHOSEN, above_zero),
    option("--temp-offset-degc N", "temperature of a raw reading of 0", finite),
    *(
        option(f"--{kind}-unit UNIT", "unit of columns whose mapping names none", str.lower)
        for kind in _KINDS
    ),
    option("--instance N", "which of several sensors in a log (0)", int, default=0),
    JSON,
    description="Turn a table (CSV, TSV, Parquet, .mat), a flight log (PX4 ULog, ArduPilot\n"
    "DataFlash, Betaflight blackbox) or a bag (ROS 1, ROS 2, MCAP) into a recording,\n"
    "and say what was dropped and why. Takes at most 600 MB, however large the file is.",
    epilog=_EPILOG,
    formatter_class=argparse.RawDescriptionHelpFormatter,
)
def run_import(arguments: argparse.Namespace) -> None:
    from ..importers import Options, import_recording, import_together
    from ..recordings.writing import is_recording_name

    known = {k: v for k, v in vars(arguments).items() if k in Options.__dataclass_fields__}
    units = {kind: getattr(arguments, f"{kind}_unit") for kind in _KINDS}
    sources = arguments.sources
    size = sum(source.stat().st_size for source in sources if source.is_file())
    how = {
        "options": Options(**known),
        "mapping": arguments.map,
        "units": {kind: unit for kind, unit in units.items() if unit},
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


@command(
    "cut",
    "cut a file that holds several recordings",
    option("source SRC", "a recording, or a table of text", Path),
    option(
        "--at-row N",
        "the data row, counted from 1, that begins a part; may be repeated",
        _row,
        action="append",
        required=True,
    ),
    option("-o --out DIR", "folder to write", Path, required=True),
    description="Cut a recording, or a text table not imported yet, before each given row. Each "
    "part of a table keeps its lines of names.",
)
def run_cut(arguments: argparse.Namespace) -> None:
    from ..importers import cut

    for part in cut(arguments.source, arguments.at_row, arguments.out):
        print(part)
