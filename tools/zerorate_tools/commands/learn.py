"""Commands that learn from recordings: `zerorate replay`, `close`, `compare`, `allan`, `fleet`."""

import argparse
from pathlib import Path

from ..errors import InFile
from ..progress import progress
from .options import (
    JSON,
    Arguments,
    above_zero,
    argument,
    command,
    group,
    option,
    print_json,
    setting,
    switch,
)


def sources(default: str = "yes") -> tuple[Arguments, Arguments]:
    """--motion, --gravity and their opposites; default: what help says of it."""
    help, either = f"learn %s as well (default: {default})", argparse.BooleanOptionalAction
    return (
        argument("--motion", action=either, help=help.replace("%s", "in motion")),
        argument("--gravity", action=either, help=help.replace("%s", "against gravity")),
    )


@command(
    "replay",
    "run the firmware over a recording",
    option("log LOG", "a recording", Path),
    option("-o --out FILE", "a .parquet", Path, required=True),
    option(
        "--runtime NAME",
        "native (default), cpython, wasm, x86, armhf, or the path of a MicroPython",
        default="native",
    ),
    option("--state FILE", "write the final state", Path),
    option("--from-state FILE", "start from a state that --state wrote", Path),
    switch("--resume", "with --from-state: continue the same power-on"),
    switch(
        "--document", "follow the patent to the letter; with --motion and --gravity, theirs too"
    ),
    switch("--rests", "with --document: learn only from rests"),
    switch("--every", "learn from every reading, moving or still"),
    option("--model FILE", "an effect model to load", Path),
    *sources("yes, but not with --document or --every"),
    option(
        "--set NAME=VALUE",
        "a setting of the firmware, for example step_degc=2",
        setting,
        action="append",
        default=[],
    ),
    JSON,
    description="Run the learning firmware over a recording. Write the bias of each sample, its "
    "source and its one sigma.",
)
def run_replay(arguments: argparse.Namespace) -> None:
    from ..recordings import open_recording
    from ..replay import replay

    if arguments.resume and arguments.from_state is None:
        arguments.refuse("--resume goes on from a state: give --from-state, too")
    if arguments.rests and (arguments.every or not arguments.document):
        arguments.refuse("--rests goes with --document and not with --every")
    chosen = ("document", "motion", "gravity")
    options = {**dict(arguments.set), **{name: getattr(arguments, name) for name in chosen}}
    if arguments.every or arguments.rests:
        options["every"] = arguments.every
    names = ("runtime", "state", "from_state", "resume", "model")
    how = {name: getattr(arguments, name) for name in names}
    recording = open_recording(arguments.log, keep_gaps=True)
    with progress(f"replaying {arguments.log.name}", recording.n_samples) as advance:
        done = replay(arguments.log, arguments.out, **how, options=options, advance=advance)
    if arguments.json:
        told = ("samples", "verdicts", "sources", "explanation")
        print_json({"file": arguments.out, **{name: getattr(done, name) for name in told}})
        return
    print(f"{arguments.out}: {done.samples} samples")
    print("  verdicts:", _shares(done.verdicts, done.samples))
    print("  source of the bias:", _shares(done.sources, done.samples))
    for line in done.explanation.splitlines():
        print(" ", line)


def _shares(counts: dict[str, int], total: int) -> str:
    return ", ".join(f"{name} {number} ({number / total:.1%})" for name, number in counts.items())


@command(
    "close",
    "find the causes of the remaining error, and write a correction",
    option("logs LOG", "a recording of one power-on", Path, nargs="+"),
    option("-o --out DIR", "folder to write", Path, required=True),
    option("--holdout LOG", "the recording to hold out (default: the last)"),
    switch(
        "--online",
        "also write bias_online_g?, of a firmware that keeps learning, to corrected.parquet",
    ),
    JSON,
    description="Each LOG is one power-on of one device. Fit a correction to all but one LOG, and "
    "judge it on that one. A single LOG is judged by cross-validation over pieces of it.",
)
def run_close(arguments: argparse.Namespace) -> None:
    from ..closing import close, motion_in_words
    from ..loop.report.result import in_words
    from ..report.sentences import headline, why_both

    a = arguments
    with progress("reading, replaying", 2 * len(a.logs)) as advance:
        result = close(a.logs, a.out, a.holdout, advance, online=a.online)
    if a.json:
        print_json({**result, "folder": a.out})
        return
    if "in_motion" in result:
        lines = [motion_in_words(result)]
    else:
        lines = [headline(result) + ".", why_both(result), in_words(result)]
    print("\n".join([*filter(None, lines), f"report: {a.out / 'report.html'}"]))


@command(
    "compare",
    "would zerorate have helped? the error of several methods on a log",
    option("logs LOG", "a recording", Path, nargs="+"),
    option("-o --out FILE", "write one HTML page with a plot", Path),
    JSON,
    description="Print the error of the mean of the first rest, vqf, imufusion and zerorate at "
    "each later rest, in deg/s and degrees of heading lost a minute. Then print what a matrix of "
    "scale factors and axes would gain in motion. It needs only the logs: power-ons of one device, "
    "in order.",
)
def run_compare(arguments: argparse.Namespace) -> None:
    """Print the headline and the table, and what the matrix would win; write the page."""
    from ..compare import TooFewRests, compare, matrix_of
    from ..compare.show import NO_RESTS, in_motion, table, write_page
    from ..recordings.atomic import check_apart

    if arguments.out is not None and arguments.out.suffix != ".html":
        raise InFile(arguments.out, "the page is written as HTML", do="end the name in .html")
    check_apart([arguments.out], arguments.logs)
    with progress("comparing", len(arguments.logs) + 4) as advance:
        won = matrix_of(arguments.logs)
        advance(1)
        try:
            compared = compare(arguments.logs, advance)
        except TooFewRests:
            if won is None:
                raise
            compared = None
    if arguments.out is not None:
        write_page(compared, arguments.out, won, [log.name for log in arguments.logs])
    if arguments.json:
        figures = {"later_rests": 0} if compared is None else compared.figures()
        print_json({**figures, "in_motion": won, "page": arguments.out})
        return
    parts = [
        NO_RESTS if compared is None else table(compared),
        None if won is None else in_motion(won),
        arguments.out,
    ]
    print("\n\n".join(str(part) for part in parts if part is not None))


@command(
    "allan",
    "Allan deviation of a recording at rest",
    option("log LOG", "a recording with a long rest", Path),
    description="Print the Allan deviation of the longest still stretch "
    "(overlapping, IEEE Std 952).",
)
def run_allan(arguments: argparse.Namespace) -> None:
    from ..allan import overlapping
    from ..loop.read.still import still_stretch

    rate_dps, each_s = still_stretch(arguments.log)
    tau_s, deviation_dps = overlapping(rate_dps, each_s)
    print(f"the longest stretch at rest: {len(rate_dps) * each_s:,.1f} s")
    print("   tau_s     x_mdps     y_mdps     z_mdps")
    for tau, row in zip(tau_s, deviation_dps):
        print(f"{tau:8.2f} " + " ".join(f"{1e3 * v:10.4f}" for v in row))
    floor = 1e3 * deviation_dps.min(axis=0)
    print("   floor " + " ".join(f"{v:10.4f}" for v in floor))


def _folder(text: str) -> Path:
    if "://" in text:
        raise argparse.ArgumentTypeError(f"{text} is no folder of this machine; name one")
    return Path(text)


def _count(text: str) -> int:
    number = int(text)
    if number < 1:
        raise argparse.ArgumentTypeError(f"{text} is not 1 or more")
    return number


@command(
    "fleet",
    "process the recordings of many devices, and make a prior for the next",
    option(
        "recordings RECORDING", "files, patterns, or folders of them; s3://, gs:// too", nargs="+"
    ),
    option("-o --out DIR", "folder to write", _folder, required=True),
    argument(
        "--job",
        choices=("replay", "close"),
        default="replay",
        help="command to run for each (default: replay)",
    ),
    option(
        "--device-from REGEX",
        "the first group of this expression in the path is the name of the device",
    ),
    switch("--keep", "also keep the files of each device"),
    option("--model FILE", "an effect model to load", Path),
    option(
        "--minutes N",
        "length of a new device's recording on which the prior is tried (5)",
        above_zero,
        default=5.0,
    ),
    group(
        "where it runs",
        option("--scheduler ADDRESS", "of a running Dask cluster"),
        option("--workers N", "processes on this machine (default and most: all cores)", _count),
        option("--devices-per-task N", "devices in one task (default: by size)", _count),
    ),
    JSON,
    description="Run replay or close on the recordings of many devices, on this machine's cores or "
    "on a Dask cluster. Report what the devices have in common, and make a prior for a new device "
    "of the part. A folder device=NAME in the path names the device. A second run over the same "
    "DIR does only what is missing.",
)
def run_fleet(arguments: argparse.Namespace) -> int:
    """Run the fleet and print what came of it; 1 where no device could be used."""
    from ..fleet import devices_of, fleet
    from ..fleet.fleet_in_words import in_words

    out = arguments.out
    devices = devices_of(arguments.recordings, arguments.device_from, without=out)
    names = ("job", "scheduler", "workers", "devices_per_task", "model", "keep", "minutes")
    options = {name: getattr(arguments, name) for name in names}
    with progress("devices", len(devices)) as advance:
        done = fleet(devices, out, **options, advance=advance)
    if arguments.json:
        print_json({"written": out, "resumed": done.resumed, **done.report})
    else:
        print(f"{in_words(done)}\nwritten: {out}")
    return 0 if done.report["sessions"] else 1
