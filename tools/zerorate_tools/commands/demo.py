"""Commands to begin with: `zerorate demo`, `runtimes` and `bench`."""

import argparse
import sys
from collections.abc import Callable
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

from ..errors import CannotFetch, MissingRuntime, ZerorateError
from ..progress import progress, waiting
from .options import argument, command, option, switch, with_actions

#: The interpreter that is fetched where nobody names one.
BY_DEFAULT = "wasm"


@command(
    "demo",
    "record, learn and correct a simulated sensor, without hardware",
    switch("--real", "use a recording of the public BROAD data set (downloads 3.6 MB once)"),
    option("-o --out DIR", "folder to write (zerorate-demo); not with --real", Path),
    option(
        "--runtime NAME",
        "wasm (default), x86, armhf, cpython, or the path of a MicroPython",
        default=BY_DEFAULT,
    ),
    description="Record an emulated chip on an emulated I2C bus with driver and firmware on a real "
    "MicroPython, run `close` on the recordings, and run its model in MicroPython.",
)
def run_demo(arguments: argparse.Namespace) -> int | None:
    """Do the whole job, or run over the public recording; exit code 2 where that was not to be had.

    What needs no network takes the place of what cannot be fetched, and that is said.
    """
    if arguments.real and arguments.out:
        raise ZerorateError("--real only prints: leave --out away, or redirect what it prints")
    arguments.out = arguments.out or Path("zerorate-demo")
    import_module("..demo", __package__)  # a missing library is told before anything is fetched
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
        run_real(arguments)
    except CannotFetch as missing:
        print(f"zerorate: {missing}\nThe built-in device is shown instead.", file=sys.stderr)
        run_job(arguments)
        return 2
    return None


def get_ready(runtime: str) -> None:
    """Fetch the interpreter where it is not there yet. Raises MissingRuntime."""
    from ..runtimes import NAMES, fetch, find

    try:
        find(runtime)
    except MissingRuntime:
        if runtime not in NAMES:
            raise
        print(f"fetching MicroPython ({runtime}), once ...", file=sys.stderr)
        with waiting(f"fetching MicroPython ({runtime})"):
            fetch(runtime)


def run_job(arguments: argparse.Namespace) -> int:
    """Tell the whole story; exit code 1 if the interpreters disagree."""
    from .. import demo
    from ..closing import close
    from ..compare import compare
    from ..compare.show import write_page
    from ..demo import story
    from ..demo.picture import draw_job

    folder, runtime = arguments.out, arguments.runtime
    with progress("simulating a device"):
        device = demo.make_device(folder)
    print(story.opening(device, folder), flush=True)
    with progress("playing its first power-on through chip, bus, driver and firmware"):
        first = demo.first_power_on(device, runtime)
    print(story.chapter_one(first), flush=True)
    with progress("closing the loop"):
        result = close(list(device.logs), folder)
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


def run_real(arguments: argparse.Namespace) -> None:
    from ..demo import story
    from ..demo.broad import broad_trial, real

    with waiting("fetching a trial of BROAD"):
        trial = broad_trial()
    with progress("running the firmware over it", 4) as advance:
        shown = real(trial, arguments.runtime, advance)
    print(story.real_trial(shown, arguments.runtime))


def draw_into(folder: Path, draw: Callable[..., None], *shown: Any) -> Path:
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


_GETTABLE = ("wasm", "x86", "armhf", "x64", "rp2040")
with_actions("runtimes", "fetch and list the MicroPython interpreters")


@command(
    "runtimes get",
    "fetch missing interpreters into the cache",
    argument("names", nargs="+", choices=_GETTABLE, metavar="NAME"),
)
def get(arguments: argparse.Namespace) -> int:
    from zerorate_tools.runtimes import fetch

    missing = []
    for name in arguments.names:
        try:
            _fetch_emulator() if name == "rp2040" else fetch(name)
            print(f"{name}: ready")
        except MissingRuntime as error:
            missing.append(name)
            print(f"zerorate: {name}: {error}", file=sys.stderr)
    return MissingRuntime.exit_code if missing else 0


def _fetch_emulator() -> None:
    try:
        from zerorate_bench.boards.pico import fetch_rp2040
    except ModuleNotFoundError:
        raise MissingRuntime("the emulated Pico is in a checkout only") from None
    fetch_rp2040()


@command("runtimes list", "list those in the cache, and how to get the others")
def list_all(arguments: argparse.Namespace) -> None:
    from zerorate_tools.runtimes import NAMES, find

    for name in (*NAMES, "x64"):
        try:
            find(name)
            print(f"{name:8} ready")
        except MissingRuntime as error:
            print(f"{name:8} missing: {error}")


@command("runtimes node", "print which Node.js and npm wasm would use")
def print_node(arguments: argparse.Namespace) -> None:
    from zerorate_tools.runtimes.node import node_command, npm_command

    print(*node_command())
    print(*npm_command())


def _benches(parser: argparse.ArgumentParser) -> None:
    """Add every bench that is there, or take any word where none is."""
    if find_spec("zerorate_bench") is None:
        parser.add_argument("bench", nargs="*", metavar="BENCH")
    else:
        from zerorate_bench.benches import add_benches

        add_benches(parser)


@command(
    "bench",
    "measure what this project claims",
    _benches,
    description="Measure the figures on the pages. `--quick` is a short run.",
)
def _refuse(arguments: argparse.Namespace) -> None:
    do = "unpack the source distribution and run `pip install -e '.[tools,bench]'` there"
    raise ZerorateError(f"the wheel has no benchmarks; {do}")
