"""`zerorate replay`: the firmware over a recording."""

import argparse
from pathlib import Path

from .as_json import add_json, print_json


def add_parser(subparsers: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = subparsers.add_parser(
        "replay",
        help="run the firmware over a recording",
        description="Run the firmware over a recording, learning as it goes, and write per sample "
        "the bias, its source and its quality.",
    )
    parser.add_argument("log", type=Path, metavar="LOG", help="a recording")
    parser.add_argument("-o", "--out", type=Path, required=True, metavar="FILE", help="a .parquet")
    parser.add_argument(
        "--runtime",
        default="native",
        metavar="NAME",
        help="native (default), cpython, wasm, x86, armhf, or the path of a MicroPython",
    )
    parser.add_argument("--state", type=Path, metavar="FILE", help="write the final state's bytes")
    parser.add_argument("--from-state", type=Path, metavar="FILE", help="start from it")
    parser.add_argument(
        "--resume", action="store_true", help="with --from-state: the same power-on goes on"
    )
    parser.add_argument(
        "--document",
        action="store_true",
        help="the literal rules of the patent documents, with --motion and --gravity too",
    )
    parser.add_argument(
        "--rests", action="store_true", help="with --document: learn only the firmware's rests"
    )
    parser.add_argument("--every", action="store_true", help="learn every reading, moving or still")
    parser.add_argument("--model", type=Path, metavar="FILE", help="an effect model to load")
    add_sources(parser, "yes, but not with --document or --every")
    parser.add_argument(
        "--set",
        action="append",
        default=[],
        type=setting,
        metavar="NAME=VALUE",
        help="a setting of the firmware, for example step_degc=2",
    )
    add_json(parser)
    parser.set_defaults(run=run, refuse=parser.error)


def add_sources(parser: argparse.ArgumentParser, default: str = "yes") -> None:
    """Add --motion, --gravity and their opposites; default: what help says of it."""
    for name, how in (("motion", "in motion"), ("gravity", "against gravity")):
        told = f"learn {how} as well (default: {default})"
        parser.add_argument(f"--{name}", action=argparse.BooleanOptionalAction, help=told)


def run(arguments: argparse.Namespace) -> None:
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
    recording = open_recording(arguments.log, keep_gaps=True)
    with progress(f"replaying {arguments.log.name}", recording.n_samples) as advance:
        done = replay(
            arguments.log,
            arguments.out,
            runtime=arguments.runtime,
            state=arguments.state,
            from_state=arguments.from_state,
            resume=arguments.resume,
            model=arguments.model,
            options=options,
            advance=advance,
        )
    if arguments.json:
        names = ("samples", "verdicts", "sources", "explanation")
        print_json({"file": arguments.out, **{name: getattr(done, name) for name in names}})
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
