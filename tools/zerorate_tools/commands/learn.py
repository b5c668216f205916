"""Commands that learn from recordings: `zerorate replay`, `close`, `compare`, `allan`, `fleet`."""

import argparse
from pathlib import Path

from .options import above_zero, add_json, option, print_json, switch


def add_replay(subparsers: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = subparsers.add_parser(
        "replay",
        help="run the firmware over a recording",
        description="Run the learning firmware over a recording. Write the bias of each sample, "
        "its source and its one sigma.",
    )
    option(parser, "log", "LOG", "a recording", Path)
    option(parser, "-o --out", "FILE", "a .parquet", Path, required=True)
    option(
        parser,
        "--runtime",
        "NAME",
        "native (default), cpython, wasm, x86, armhf, or the path of a MicroPython",
        default="native",
    )
    option(parser, "--state", "FILE", "write the final state", Path)
    option(parser, "--from-state", "FILE", "start from a state that --state wrote", Path)
    switch(parser, "--resume", "with --from-state: continue the same power-on")
    switch(
        parser, "--document", "follow the patents to the letter, with --motion and --gravity too"
    )
    switch(parser, "--rests", "with --document: learn only from rests")
    switch(parser, "--every", "learn from every reading, moving or still")
    option(parser, "--model", "FILE", "an effect model to load", Path)
    add_sources(parser, "yes, but not with --document or --every")
    option(
        parser,
        "--set",
        "NAME=VALUE",
        "a setting of the firmware, for example step_degc=2",
        setting,
        action="append",
        default=[],
    )
    add_json(parser)
    parser.set_defaults(run=run_replay, refuse=parser.error)


def add_sources(parser: argparse.ArgumentParser, default: str = "yes") -> None:
    """Add --motion, --gravity and their opposites; default: what help says of it."""
    for name, how in (("motion", "in motion"), ("gravity", "against gravity")):
        what = f"learn {how} as well (default: {default})"
        parser.add_argument(f"--{name}", action=argparse.BooleanOptionalAction, help=what)


def run_replay(arguments: argparse.Namespace) -> None:
    from ..progress import progress
    from ..recordings import open_recording
    from ..replay import replay

    if arguments.resume and arguments.from_state is None:
        arguments.refuse("--resume goes on from a state: give --from-state, too")
    if arguments.rests and (arguments.every or not arguments.document):
        arguments.refuse("--rests goes with --document and not with --every")
    options: dict[str, object] = dict(arguments.set)
    options.update(document=arguments.document, motion=arguments.motion)
    options.update(gravity=arguments.gravity)
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


def setting(text: str) -> tuple[str, float]:
    name, _, value = text.partition("=")
    try:
        number = float(value)
        return name, int(number) if name in ("bins", "short", "long") else number
    except (ValueError, OverflowError) as error:
        raise argparse.ArgumentTypeError(f"{text}: not of the form NAME=NUMBER") from error


def add_close(subparsers: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = subparsers.add_parser(
        "close",
        help="find the causes of the remaining error, and write a correction",
        description="Each LOG is one power-on of one device. Fit a correction to all but one LOG, "
        "and judge it on that one. A single LOG is judged by cross-validation over pieces of it.",
    )
    option(parser, "logs", "LOG", "a recording of one power-on", Path, nargs="+")
    option(parser, "-o --out", "DIR", "folder to write", Path, required=True)
    option(parser, "--holdout", "LOG", "the recording to hold out (default: the last)")
    switch(
        parser,
        "--online",
        "also write bias_online_g? to corrected.parquet: of a firmware that keeps learning",
    )
    add_json(parser)
    parser.set_defaults(run=run_close)


def run_close(arguments: argparse.Namespace) -> None:
    """Close the loop and print what was found."""
    from ..closing import close
    from ..closing_in_motion import motion_in_words
    from ..loop.report.in_words import in_words
    from ..progress import progress
    from ..report.sentences import headline, why_both

    a = arguments
    with progress("reading, replaying", 2 * len(a.logs)) as advance:
        result = close(a.logs, a.out, a.holdout, advance, online=a.online)
    if arguments.json:
        print_json({**result, "folder": arguments.out})
        return
    if "in_motion" in result:
        print(motion_in_words(result))
        print(f"report: {arguments.out / 'report.html'}")
        return
    print(headline(result) + ".")
    if why := why_both(result):
        print(why)
    print(in_words(result))
    print(f"report: {arguments.out / 'report.html'}")


def add_compare(subparsers: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = subparsers.add_parser(
        "compare",
        help="would zerorate have helped? the error of several methods on a log",
        description="Print the error of the mean of the first rest, vqf, imufusion and zerorate at "
        "each later rest, in deg/s and degrees of heading lost a minute. Then print what a matrix "
        "of scale factors and axes would gain in motion. It needs only the logs: power-ons of one "
        "device, in order.",
    )
    option(parser, "logs", "LOG", "a recording", Path, nargs="+")
    option(parser, "-o --out", "FILE", "write one HTML page with a plot", Path)
    add_json(parser)
    parser.set_defaults(run=run_compare)


def run_compare(arguments: argparse.Namespace) -> None:
    """Print the headline and the table, and what the matrix would win; write the page."""
    from ..compare import TooFewRests, compare, matrix_of
    from ..compare.show import NO_RESTS, in_motion, table, write_page
    from ..progress import progress
    from ..recordings.atomic import check_apart

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
    parts = [NO_RESTS if compared is None else table(compared)]
    parts += [in_motion(won)] if won is not None else []
    print("\n\n".join([*parts, *([str(arguments.out)] if arguments.out is not None else [])]))


def add_allan(subparsers: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = subparsers.add_parser(
        "allan",
        help="Allan deviation of a recording at rest",
        description="Allan deviation of the longest still stretch (overlapping, IEEE Std 952).",
    )
    option(parser, "log", "LOG", "a recording with a long rest", Path)
    parser.set_defaults(run=run_allan)


def run_allan(arguments: argparse.Namespace) -> None:
    """Print the deviation by cluster time, and its lowest point."""
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


def add_fleet(subparsers: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = subparsers.add_parser(
        "fleet",
        help="process the recordings of many devices, and make a prior for the next",
        description="Run replay or close on the recordings of many devices, on this machine's "
        "cores or on a Dask cluster. Report what the devices have in common, and make a prior for "
        "a new device of the part. A folder device=NAME in the path names the device. A second run "
        "over the same DIR does only what is missing.",
    )
    option(
        parser,
        "recordings",
        "RECORDING",
        "files, patterns, or folders of them; s3://, gs:// too",
        nargs="+",
    )
    option(parser, "-o --out", "DIR", "folder to write", _folder, required=True)
    parser.add_argument(
        "--job",
        choices=("replay", "close"),
        default="replay",
        help="command to run for each (default: replay)",
    )
    option(
        parser,
        "--device-from",
        "REGEX",
        "the first group of this expression in the path is the name of the device",
    )
    switch(parser, "--keep", "also keep the files of each device")
    option(parser, "--model", "FILE", "an effect model to load", Path)
    option(
        parser,
        "--minutes",
        "N",
        "length of a new device's recording on which the prior is tried (5)",
        above_zero,
        default=5.0,
    )
    group = parser.add_argument_group("where it runs")
    option(group, "--scheduler", "ADDRESS", "of a running Dask cluster")
    option(group, "--workers", "N", "processes on this machine (default: all cores)", _count)
    option(group, "--devices-per-task", "N", "devices in one task (default: by size)", _count)
    add_json(parser)
    parser.set_defaults(run=run_fleet)


def run_fleet(arguments: argparse.Namespace) -> int:
    """Run the fleet and print what came of it; 1 where no device could be used."""
    from ..fleet import devices_of, fleet
    from ..fleet.fleet_in_words import in_words
    from ..progress import progress

    out = arguments.out
    devices = devices_of(arguments.recordings, arguments.device_from, without=out)
    options = {
        name: getattr(arguments, name)
        for name in ("job", "scheduler", "workers", "devices_per_task", "model", "keep", "minutes")
    }
    with progress("devices", len(devices)) as advance:
        done = fleet(devices, out, **options, advance=advance)
    if arguments.json:
        print_json({"written": out, "resumed": done.resumed, **done.report})
    else:
        print(in_words(done))
        print(f"written: {out}")
    return 0 if done.report["sessions"] else 1


def _folder(text: str) -> Path:
    if "://" in text:
        raise argparse.ArgumentTypeError(f"{text} is no folder of this machine; name one")
    return Path(text)


def _count(text: str) -> int:
    number = int(text)
    if number < 1:
        raise argparse.ArgumentTypeError(f"{text} is not 1 or more")
    return number


PARSERS = {
    "replay": add_replay,
    "close": add_close,
    "compare": add_compare,
    "allan": add_allan,
    "fleet": add_fleet,
}
