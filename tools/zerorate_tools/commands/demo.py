"""`zerorate demo`: the whole job without hardware."""

import argparse
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

#: The interpreter that is fetched where nobody names one.
BY_DEFAULT = "wasm"


def add_parser(subparsers: "argparse._SubParsersAction[argparse.ArgumentParser]") -> None:
    parser = subparsers.add_parser(
        "demo",
        help="the whole job without hardware",
        description="The whole job on a built-in device, no hardware: an emulated chip on an "
        "emulated I2C bus, driver and firmware on a real MicroPython, the loop closed, and what it "
        "found run by MicroPython again.",
    )
    parser.add_argument(
        "--real",
        action="store_true",
        help="a real recording of the public BROAD data set instead, fetched once (3.6 MB)",
    )
    parser.add_argument(
        "-o",
        "--out",
        type=Path,
        default=Path("zerorate-demo"),
        metavar="DIR",
        help="folder to write",
    )
    parser.add_argument(
        "--runtime",
        default=BY_DEFAULT,
        metavar="NAME",
        help="wasm (default), x86, armhf, cpython, or a path",
    )
    parser.set_defaults(run=run)


def run(arguments: argparse.Namespace) -> int:
    """Do the whole job, or run over the public recording; exit code 2 where that was not to be had.

    What needs no network takes the place of what cannot be fetched, and that is said.
    """
    from ..errors import CannotFetch, MissingRuntime

    try:
        get_ready(arguments.runtime)
    except MissingRuntime as missing:
        if arguments.runtime != BY_DEFAULT:
            raise
        print(f"zerorate: {missing}\nThis Python runs the firmware instead.", file=sys.stderr)
        arguments.runtime = "cpython"
    if not arguments.real:
        return run_job(arguments)
    try:
        return run_real(arguments)
    except CannotFetch as missing:
        print(f"zerorate: {missing}\nThe built-in device is shown instead.", file=sys.stderr)
        run_job(arguments)
        return 2


def get_ready(runtime: str) -> None:
    """Fetch the interpreter where it is not there yet. Raises MissingRuntime."""
    from ..errors import MissingRuntime
    from ..progress import waiting
    from ..runtimes import NAMES, fetch, find

    try:
        find(runtime)
    except MissingRuntime:
        if runtime not in NAMES:
            raise
        print(f"fetching MicroPython ({runtime}), once ...", file=sys.stderr, flush=True)
        with waiting(f"fetching MicroPython ({runtime})"):
            fetch(runtime)


def run_job(arguments: argparse.Namespace) -> int:
    """Tell the whole story; exit code 1 if the interpreters disagree."""
    from .. import demo
    from ..compare import compare
    from ..compare.show import write_page
    from ..demo import story
    from ..demo.picture import draw_job
    from ..progress import progress

    folder, runtime = arguments.out, arguments.runtime
    with progress("simulating a device"):
        device = demo.make_device(folder)
    print(story.opening(device, folder), flush=True)
    with progress("playing its first power-on through chip, bus, driver and firmware"):
        first = demo.first_power_on(device, runtime)
    print(story.chapter_one(first), flush=True)
    with progress("closing the loop"):
        result = demo.closed(device, folder)
    print(story.chapter_two(device, result), flush=True)
    model = folder / "model.bin"
    with progress("playing the last power-on without and with the model"):
        before, after = demo.back_on_the_chip(device, model, runtime)
    print(story.chapter_three(before, after, model))
    with progress("comparing with the average at boot"):
        found = compare(device.logs)
        write_page(found, folder / "compare.html")
    print(story.compared(found))
    drawn = draw_into(folder, draw_job, first, before, after)
    print(story.ending([*reports(folder), (drawn, "power-on 1, and the last without and with it")]))
    return 0 if all(shown.same_state for shown in (first, before, after)) else 1


def run_real(arguments: argparse.Namespace) -> int:
    """The firmware on a real recording, beside others."""
    from ..demo import story
    from ..demo.broad_trial import broad_trial
    from ..demo.real import real
    from ..progress import progress, waiting

    with waiting("fetching a trial of BROAD"):
        trial = broad_trial()
    with progress("running the firmware over it", 4) as advance:
        shown = real(trial, arguments.runtime, advance)
    print(story.real_trial(shown, arguments.runtime))
    return 0


def draw_into(folder: Path, draw: Callable[..., None], *shown: Any) -> Path:
    """Draw demo.png into a folder, made where it is not there."""
    from ..recordings.atomic import written_beside

    folder.mkdir(parents=True, exist_ok=True)
    path = folder / "demo.png"
    with written_beside(path) as temporary:
        draw(*shown, temporary)
    return path


def reports(folder: Path) -> list[tuple[Path, str]]:
    """What closing the loop wrote for people."""
    said = {
        "report.html": "what was found and how sure, before and after: open it in a browser",
        "compare.html": "the average at boot, other filters and zerorate at each later rest",
        "model.json": "the effects found, to be read; `zerorate model show` says them in words",
    }
    return [(folder / name, what) for name, what in said.items() if (folder / name).exists()]
