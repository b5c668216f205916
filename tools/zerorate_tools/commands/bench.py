"""`zerorate bench`: what is claimed, measured; each bench is a sub-command, a row of BENCHES."""

import argparse
import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

_MORE = """\
Without a BENCH it measures what a sample costs, the replay, and the bias error beside everyone
else's, and says beside each figure what it must be: a quarter of an hour. The others are run by
name. `--quick` is a look at the same tables in a few minutes, not to be quoted.
"""
_QUICK_HOURS = (1.0, 4.0)
_QUICK_SEEDS = (1,)

#: What is printed, and the figures for --json.
Found = tuple[str, Any]


@dataclass(frozen=True)
class Bench:
    """help: in a line; measure: of the arguments; options: flag -> what argparse takes for it;
    passed: whether the figures are well, by which the exit code is chosen."""

    help: str
    measure: Callable[[argparse.Namespace], Found]
    options: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    passed: Callable[[Any], bool] = lambda found: True


def add_parser(subparsers) -> None:
    """Register the sub-command and its benches."""
    parser = subparsers.add_parser(
        "bench", help="measure what this project claims", description=_MORE
    )
    _add(parser, Bench("", _cost_and_accuracy, _QUICK))
    benches = parser.add_subparsers(dest="bench", metavar="BENCH")
    for name, bench in BENCHES.items():
        _add(benches.add_parser(name, help=bench.help, description=bench.help), bench)


def _add(parser, bench: Bench) -> None:
    for flag, how in bench.options.items():
        parser.add_argument(flag, **how)
    parser.add_argument("--out", type=Path, metavar="FILE", help="write Markdown, not print it")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the figures there too")
    parser.set_defaults(run=lambda arguments: _run(bench, arguments))


def _run(bench: Bench, arguments: argparse.Namespace) -> int:
    from ..recordings.atomic import written_beside

    text, found = bench.measure(arguments)
    if arguments.out is None:
        print(text)
    else:
        with written_beside(arguments.out) as temporary:
            temporary.write_text(text, encoding="utf-8")
    if arguments.json is not None:
        with written_beside(arguments.json) as temporary:
            temporary.write_text(json.dumps(found, indent=2) + "\n", encoding="utf-8")
    return 0 if bench.passed(found) else 1


def _hours(arguments: argparse.Namespace) -> tuple[float, ...]:
    from ..bench.replay_speed import HOURS

    return _QUICK_HOURS if arguments.quick else HOURS


def _seeds(arguments: argparse.Namespace) -> tuple[int, ...]:
    from ..bench.accuracy import SEEDS

    return _QUICK_SEEDS if arguments.quick else SEEDS


def _cost_and_accuracy(arguments: argparse.Namespace) -> Found:
    from ..bench.cost_and_accuracy import in_markdown, measure, steps
    from ..progress import progress

    seeds = _seeds(arguments)
    with progress("measuring", steps(seeds)) as advance:
        found = measure(_hours(arguments), seeds, advance)
    return in_markdown(found), found


def _accuracy(arguments: argparse.Namespace) -> Found:
    from ..bench.accuracy_report import accuracy, in_markdown, steps
    from ..progress import progress

    seeds = _seeds(arguments)
    with progress("measuring accuracy", steps(seeds)) as advance:
        found = accuracy(advance, seeds)
    return in_markdown(found), found


def _boards(arguments: argparse.Namespace) -> Found:
    from ..bench.boards import in_markdown, measure
    from ..bench.boards.measuring import STEPS
    from ..progress import progress

    with progress("measuring on a Pico", STEPS) as advance:
        found = measure(advance)
    return in_markdown(found), found


def _compare(arguments: argparse.Namespace) -> Found:
    from ..bench.compared import in_markdown, run
    from ..progress import progress

    with progress("recordings") as advance:
        found = run(_recordings(arguments), advance)
    return in_markdown(found), found


def _compare_passed(found: Any) -> bool:
    from ..bench.compared import passed

    return passed(found)


def _cost(arguments: argparse.Namespace) -> Found:
    from ..bench.cost import STEPS, cost
    from ..bench.cost_report import in_markdown
    from ..progress import progress

    with progress("measuring cost", STEPS) as advance:
        found = cost(advance, _hours(arguments))
    return in_markdown(found), found


def _faults(arguments: argparse.Namespace) -> Found:
    from ..bench.faults import run, table

    found = run()
    return table(found), found


def _no_fault_passed(found: Any) -> bool:
    from ..bench.faults import passed

    return passed(found)


def _filters(arguments: argparse.Namespace) -> Found:
    from ..bench.filters import in_markdown, run
    from ..progress import progress

    with progress("trials") as advance:
        found = run(arguments.data, advance)
    return in_markdown(found), found


def _fleet(arguments: argparse.Namespace) -> Found:
    from ..bench.fleet import WORKERS, markdown, run, steps
    from ..progress import progress

    sizes = sorted(arguments.devices)
    with progress("devices", steps(sizes, WORKERS)) as advance:
        found = run(sizes, advance=advance)
    return markdown(found), found


def _import(arguments: argparse.Namespace) -> Found:
    from ..bench.import_size import in_words, run
    from ..progress import progress

    with progress("importing", 2) as advance:
        found = run(arguments.gb, arguments.folder, advance)
    return in_words(found), found


def _loop(arguments: argparse.Namespace) -> Found:
    from ..bench.loop import markdown, renewed, run

    options = {name: getattr(arguments, name) for name in ("data", "resume", "plots", "rows")}
    found = run(arguments.nulls, arguments.seeds, arguments.processes, **options)
    if arguments.page:
        page = arguments.page.read_text(encoding="utf-8")
        return renewed(page, found["figures"]), found
    return markdown(found), found


def _motion(arguments: argparse.Namespace) -> Found:
    from ..bench.motion import run
    from ..bench.motion_table import table

    found = run(arguments.data)
    return table(found), found


def _peers(arguments: argparse.Namespace) -> Found:
    from ..bench.peer_differences import CASES, in_markdown, peer_differences
    from ..progress import progress

    with progress("simulating", len(CASES)) as advance:
        found = peer_differences(_seeds(arguments), advance)
    return in_markdown(found), {"cases": found}


def _real(arguments: argparse.Namespace) -> Found:
    from ..bench.loop.real import in_words, real_rows

    rows = real_rows(_recordings(arguments), arguments.plots)
    return in_words(rows), rows


def _recordings(arguments: argparse.Namespace) -> Path:
    from ..bench.public_data import data_folder
    from ..errors import ZerorateError

    folder = arguments.data or data_folder()
    if folder is None or not Path(folder).is_dir():
        raise ZerorateError("no real recordings; name their folder with --data DIR")
    return Path(folder)


def _refine(arguments: argparse.Namespace) -> Found:
    from ..bench.second_unit import run, table

    found = run(arguments.seeds)
    return table(found), found


def _service(arguments: argparse.Namespace) -> Found:
    from ..bench.service import in_words, run

    found = run(arguments.hours, arguments.faults)
    return in_words(found), found


def _singles(arguments: argparse.Namespace) -> Found:
    from ..bench.loop.singles import in_words, run_singles
    from ..progress import progress

    with progress("closing", arguments.devices) as advance:
        found = run_singles(arguments.devices, arguments.processes, arguments.resume, advance)
    return in_words(found), found


_QUICK = {"--quick": {"action": "store_true", "help": "short recordings and one seed"}}
_BROAD = {"--data": {"type": Path, "metavar": "DIR", "help": "folder of BROAD trials (.mat)"}}
_RECORDINGS = {"--data": {"type": Path, "metavar": "DIR", "help": "folder of real recordings"}}
_RESUME = {"--resume": {"type": Path, "metavar": "FILE", "help": "outcomes: go on from them"}}
_PLOTS = {"--plots": {"type": Path, "metavar": "DIR", "help": "PNGs of the real recordings"}}


def _number(default: float, what: str) -> dict[str, Any]:
    told = f"{what} ({default:g})"
    return {"type": type(default), "default": default, "metavar": "N", "help": told}


BENCHES = {
    "accuracy": Bench("the bias error beside everyone else's", _accuracy, _QUICK),
    "boards": Bench("memory, time and numbers on an emulated Pico", _boards),
    "compare": Bench(
        "what `compare` says of real recordings; exit code 1 where the truth denies it",
        _compare,
        _RECORDINGS,
        passed=_compare_passed,
    ),
    "cost": Bench("instructions, heap, sizes and replay speed", _cost, _QUICK),
    "faults": Bench(
        "every fault of a bus and every cut of a write; exit code 1 when one goes unnoticed",
        _faults,
        passed=_no_fault_passed,
    ),
    "filters": Bench("heading of attitude filters fed by zerorate", _filters, _BROAD),
    "fleet": Bench(
        "many devices at once, and what a prior is worth",
        _fleet,
        {
            "--devices": {
                **{"type": int, "nargs": "+", "metavar": "N", "default": (100, 500, 2000)},
                "help": "sizes of the fleet (100 500 2000)",
            }
        },
    ),
    "import": Bench(
        "seconds and memory of importing a huge CSV, made and not kept",
        _import,
        {
            "--gb": _number(1.0, "its size"),
            "--folder": {"type": Path, "metavar": "DIR", "help": "with room for 2.5 times that"},
        },
    ),
    "loop": Bench(
        "what closing the loop finds, and what it invents",
        _loop,
        {
            "--nulls": _number(200, "recordings of nothing"),
            "--seeds": _number(20, "devices an effect"),
            "--processes": _number(2, "at once"),
            "--rows": {"metavar": "TEXT", "help": "only devices whose row or effect holds it"},
            "--page": {"type": Path, "metavar": "FILE", "help": "page to renew with the figures"},
            **_RECORDINGS,
            **_RESUME,
            **_PLOTS,
        },
    ),
    "motion": Bench("the bias learned in motion beside vqf's", _motion, _BROAD),
    "peers": Bench("what the figures of other filters hang on", _peers, _QUICK),
    "real": Bench(
        "closing the loop on real recordings, each alone", _real, {**_RECORDINGS, **_PLOTS}
    ),
    "refine": Bench(
        "one unit's effect model on another unit, refined",
        _refine,
        {"--seeds": _number(20, "units")},
    ),
    "service": Bench(
        "`zerorate run` through faults, kills, full disks",
        _service,
        {"--hours": _number(24.0, "simulated"), "--faults": _number(1000, "how many")},
    ),
    "singles": Bench(
        "one or two simulated recordings: whether what is deployed makes anything worse",
        _singles,
        {
            "--devices": _number(400, "devices"),
            "--processes": _number(2, "at once"),
            **_RESUME,
        },
    ),
}
