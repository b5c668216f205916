"""The benches of `zerorate bench`: each is a sub-command, a row of BENCHES."""

import argparse
import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from importlib import import_module
from pathlib import Path
from typing import Any

_QUICK_HOURS = (1.0, 4.0)
_QUICK_SEEDS = (1,)


@dataclass(frozen=True)
class Bench:
    """help: in a line; module: below zerorate_bench, loaded when the bench is run.

    found: the figures, of that module, the arguments and what is told of steps done; steps: how
    many, None where nobody knows; text: the module's function that makes figures Markdown; options:
    flag -> what argparse takes for it; judged: the exit code says what the module's `passed` does.
    """

    help: str
    module: str
    found: Callable[[Any, argparse.Namespace, Callable[[float], None]], Any]
    steps: Callable[[Any, argparse.Namespace], float | None] = lambda bench, a: None
    text: str = "in_markdown"
    options: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    judged: bool = False


def add_benches(parser: argparse.ArgumentParser) -> None:
    """Register each bench as a sub-command."""
    benches = parser.add_subparsers(dest="bench", metavar="BENCH", required=True)
    for name, bench in BENCHES.items():
        _add(benches.add_parser(name, help=bench.help, description=bench.help), bench)


def _add(parser, bench: Bench) -> None:
    for flag, how in bench.options.items():
        parser.add_argument(flag, **how)
    parser.add_argument("--out", type=Path, metavar="FILE", help="write Markdown, not print it")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the figures there too")
    parser.set_defaults(run=lambda arguments: _run(bench, arguments))


def _run(bench: Bench, arguments: argparse.Namespace) -> int:
    from zerorate_tools.progress import progress
    from zerorate_tools.recordings.atomic import written_beside

    module = import_module(f"zerorate_bench.{bench.module}")
    with progress("measuring", bench.steps(module, arguments)) as advance:
        found = bench.found(module, arguments, advance)
    if getattr(arguments, "page", None):
        text = module.renewed(arguments.page.read_text(encoding="utf-8"), found["figures"])
    else:
        text = getattr(module, bench.text)(found)
    if arguments.out is None:
        print(text)
    else:
        with written_beside(arguments.out) as temporary:
            temporary.write_text(text, encoding="utf-8")
    if arguments.json is not None:
        with written_beside(arguments.json) as temporary:
            temporary.write_text(json.dumps(found, indent=2) + "\n", encoding="utf-8")
    return 1 if bench.judged and not module.passed(found) else 0


def _hours(arguments: argparse.Namespace) -> tuple[float, ...]:
    from .replay_speed import HOURS

    return _QUICK_HOURS if arguments.quick else HOURS


def _seeds(arguments: argparse.Namespace) -> tuple[int, ...]:
    from .accuracy import SEEDS

    return _QUICK_SEEDS if arguments.quick else SEEDS


def _recordings(arguments: argparse.Namespace) -> Path:
    from zerorate_tools.errors import ZerorateError

    from .public_data import data_folder

    folder = arguments.data or data_folder()
    if folder is None or not Path(folder).is_dir():
        raise ZerorateError("no real recordings; name their folder with --data DIR")
    return Path(folder)


_QUICK = {"--quick": {"action": "store_true", "help": "short recordings and one seed"}}
_BROAD = {"--data": {"type": Path, "metavar": "DIR", "help": "folder of BROAD trials (.mat)"}}
_FOLDERS = {
    "--data": {
        **{"type": Path, "nargs": "+", "metavar": "DIR", "required": True},
        "help": "folders of BROAD trials (.mat)",
    }
}
_RECORDINGS = {"--data": {"type": Path, "metavar": "DIR", "help": "folder of real recordings"}}
_RESUME = {"--resume": {"type": Path, "metavar": "FILE", "help": "outcomes: go on from them"}}


def _number(default: float, what: str) -> dict[str, Any]:
    text = f"{what} ({default:g})"
    return {"type": type(default), "default": default, "metavar": "N", "help": text}


_PROCESSES = {"--processes": _number(2, "at once")}
BENCHES = {
    "accuracy": Bench(
        *("the bias error, beside other filters'", "accuracy"),
        lambda bench, a, advance: bench.accuracy(advance, _seeds(a)),
        lambda bench, a: bench.steps(_seeds(a)),
        options=_QUICK,
    ),
    "boards": Bench(
        *("memory, time and numbers on an emulated Pico", "boards"),
        lambda bench, a, advance: bench.measure(advance),
        lambda bench, a: bench.STEPS,
    ),
    "compare": Bench(
        "what `compare` says of real recordings; exit code 1 if the truth contradicts it",
        "compared",
        lambda bench, a, advance: bench.run(_recordings(a), advance),
        options=_RECORDINGS,
        judged=True,
    ),
    "cost": Bench(
        *("instructions, heap, sizes and replay speed", "cost_report"),
        lambda bench, a, advance: bench.cost(advance, _hours(a)),
        lambda bench, a: bench.STEPS,
        options=_QUICK,
    ),
    "deceived": Bench(
        *("how often it is certain of a wrong bias when turns look like one", "deceived"),
        lambda bench, a, advance: bench.run(a.seeds, advance),
        lambda bench, a: bench.steps(a.seeds),
        options={"--seeds": _number(50, "runs of each world")},
    ),
    "faults": Bench(
        "every fault of a bus and every cut of a write; exit code 1 if one goes unnoticed",
        "faults",
        lambda bench, a, advance: bench.run(),
        judged=True,
    ),
    "fleet": Bench(
        *("many devices at once, and what a prior gains", "fleet"),
        lambda bench, a, advance: bench.run(sorted(a.devices), advance=advance),
        lambda bench, a: bench.steps(a.devices, bench.WORKERS),
        options={
            "--devices": {
                **{"type": int, "nargs": "+", "metavar": "N", "default": (100, 500, 2000)},
                "help": "sizes of the fleet (100 500 2000)",
            }
        },
    ),
    "heading": Bench(
        *("heading lost in motion, without and with the matrix of `close`", "heading"),
        lambda bench, a, advance: bench.run(a.data, advance),
        options=_FOLDERS,
    ),
    "heading-simulated": Bench(
        *("errors of scale and axes in five kinds of simulated motion", "heading_simulated"),
        lambda bench, a, advance: bench.run(a.devices, a.processes, a.resume, advance),
        lambda bench, a: bench.steps(a.devices),
        options={"--devices": _number(80, "devices of each kind"), **_PROCESSES, **_RESUME},
    ),
    "heading-size": Bench(
        "time and memory of `close` in motion; exit code 1 if too much",
        "heading_size",
        lambda bench, a, advance: bench.run(),
        judged=True,
    ),
    "import": Bench(
        "logs of other tools: right or refused; exit code 1 if one is wrong",
        "foreign_imports",
        lambda bench, a, advance: bench.run(a.only, advance),
        lambda bench, a: bench.steps(),
        options={"--only": {"metavar": "TEXT", "default": "", "help": "logs whose row holds it"}},
        judged=True,
    ),
    "import-size": Bench(
        *("time and memory to import a huge CSV", "foreign_imports"),
        lambda bench, a, advance: bench.run_import_size(a.gb, a.folder, advance),
        lambda bench, a: 2,
        "in_words",
        {
            "--gb": _number(1.0, "its size"),
            "--folder": {"type": Path, "metavar": "DIR", "help": "with room for 2.5 times that"},
        },
    ),
    "loop": Bench(
        *("what `close` finds, and what it finds wrongly", "loop"),
        lambda bench, a, advance: bench.run(
            *(a.nulls, a.seeds, a.processes),
            **{name: getattr(a, name) for name in ("data", "resume", "rows")},
        ),
        text="markdown",
        options={
            "--nulls": _number(200, "recordings of nothing"),
            "--seeds": _number(20, "devices an effect"),
            **_PROCESSES,
            "--rows": {"metavar": "TEXT", "help": "only devices whose row or effect holds it"},
            "--page": {"type": Path, "metavar": "FILE", "help": "page to renew with the figures"},
            **_RECORDINGS,
            **_RESUME,
        },
    ),
    "motion": Bench(
        *("the bias learned in motion, beside vqf's", "motion_table"),
        lambda bench, a, advance: bench.run(a.data),
        options=_BROAD,
    ),
    "own-axes": Bench(
        *("scale and axes that the filter in motion finds by itself", "own_axes"),
        lambda bench, a, advance: bench.run(a.devices, a.data, advance),
        lambda bench, a: 2 * len(bench.WORLDS),
        options={"--devices": _number(12, "simulated devices a row"), **_FOLDERS},
    ),
    "real": Bench(
        *("`close` on real recordings, each alone", "loop.real"),
        lambda bench, a, advance: bench.real_rows(_recordings(a)),
        text="in_words",
        options=_RECORDINGS,
    ),
    "real-motion": Bench(
        *("the bias at the end of real motion, beside other filters'", "real_motion"),
        lambda bench, a, advance: bench.run(a.data, advance),
        options=_FOLDERS,
    ),
    "service": Bench(
        *("`zerorate run` under faults, kills, full disks", "service"),
        lambda bench, a, advance: bench.run(a.hours, a.faults),
        text="in_words",
        options={"--hours": _number(24.0, "simulated"), "--faults": _number(1000, "how many")},
    ),
    "singles": Bench(
        "`close` on one or two simulated recordings: does it make anything worse?",
        "loop.singles",
        lambda bench, a, advance: bench.run_singles(a.devices, a.processes, a.resume, advance),
        lambda bench, a: a.devices,
        "in_words",
        {"--devices": _number(400, "devices"), **_PROCESSES, **_RESUME},
    ),
    "variants": Bench(
        "`close` on real recordings that were cut or damaged",
        "loop.variants",
        lambda bench, a, advance: bench.variant_rows(_recordings(a), advance),
        text="in_words",
        options=_RECORDINGS,
    ),
}
