"""The benches of `zerorate bench`: each is a sub-command, a row of BENCHES."""

import argparse
import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import partial
from importlib import import_module
from inspect import signature
from pathlib import Path
from typing import Any


@dataclass(frozen=True)
class Bench:
    """help: in a line; module: below zerorate_bench, loaded when the bench is run.

    The module's `run` makes the figures of the options that it takes by their names, `in_markdown`
    the text of them; the exit code says what its `passed` does, if it has one.
    options: flag -> what argparse takes for it.
    """

    help: str
    module: str
    options: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)


def add_benches(parser: argparse.ArgumentParser) -> None:
    """Register each bench as a sub-command."""
    benches = parser.add_subparsers(dest="bench", metavar="BENCH", required=True)
    for name, bench in BENCHES.items():
        own = benches.add_parser(name, help=bench.help, description=bench.help)
        for flag, how in bench.options.items():
            own.add_argument(flag, **how)
        own.add_argument("--out", type=Path, metavar="FILE", help="write Markdown, not print it")
        own.add_argument("--json", type=Path, metavar="FILE", help="write the figures there too")
        own.set_defaults(run=partial(_run, bench.module))


def _run(name: str, arguments: argparse.Namespace) -> int:
    module = import_module(f"zerorate_bench.{name}")
    options = vars(arguments)
    found = module.run(**{name: options[name] for name in signature(module.run).parameters})
    if getattr(arguments, "page", None):
        text = module.renewed(arguments.page.read_text(encoding="utf-8"), found["figures"])
    else:
        text = module.in_markdown(found)
    if arguments.out is None:
        print(text)
    else:
        _write(arguments.out, text)
    if arguments.json is not None:
        _write(arguments.json, json.dumps(found, indent=2) + "\n")
    return 1 if hasattr(module, "passed") and not module.passed(found) else 0


def _write(path: Path, text: str) -> None:
    from zerorate_tools.recordings.atomic import written_beside

    with written_beside(path) as temporary:
        temporary.write_text(text, encoding="utf-8")


_QUICK = {"--quick": {"action": "store_true", "help": "short recordings and one seed"}}
_FOLDER = {"type": Path, "metavar": "DIR"}
_BROAD = {"--data": {**_FOLDER, "help": "folder of BROAD trials (.mat)"}}
_MANY = {**_FOLDER, "nargs": "+", "required": True, "help": "folders of BROAD trials (.mat)"}
_FOLDERS = {"--data": _MANY}
_RECORDINGS = {"--data": {**_FOLDER, "help": "folder of real recordings"}}
_RESUME = {"--resume": {"type": Path, "metavar": "FILE", "help": "outcomes: go on from them"}}


def _number(default: float, what: str) -> dict[str, Any]:
    text = f"{what} ({default:g})"
    return {"type": type(default), "default": default, "metavar": "N", "help": text}


_PROCESSES = {"--processes": _number(2, "at once")}
BENCHES = {
    "accuracy": Bench("the bias error, beside other filters'", "accuracy", _QUICK),
    "boards": Bench("memory, time and numbers on an emulated Pico", "boards.measuring"),
    "cost": Bench("instructions, heap, sizes and replay speed", "cost_report", _QUICK),
    "deceived": Bench(
        *("how often it is certain of a wrong bias when turns look like one", "deceived"),
        {"--seeds": _number(50, "runs of each world")},
    ),
    "heading": Bench(
        "heading lost in motion, without and with the matrix of `close`", "heading", _FOLDERS
    ),
    "heading-simulated": Bench(
        *("errors of scale and axes in five kinds of simulated motion", "heading_simulated"),
        {"--devices": _number(80, "devices of each kind"), **_PROCESSES, **_RESUME},
    ),
    "heading-size": Bench(
        "time and memory of `close` in motion; exit code 1 if too much", "heading_size"
    ),
    "import": Bench(
        *("logs of other tools: right or refused; exit code 1 if one is wrong", "foreign_imports"),
        {"--only": {"metavar": "TEXT", "default": "", "help": "logs whose row holds it"}},
    ),
    "loop": Bench(
        *("what `close` finds, and what it finds wrongly", "loop.trials"),
        {
            "--nulls": _number(200, "recordings of nothing"),
            "--seeds": _number(20, "devices an effect"),
            **_PROCESSES,
            "--rows": {"metavar": "TEXT", "help": "only devices whose row or effect holds it"},
            "--page": {"type": Path, "metavar": "FILE", "help": "page to renew with the figures"},
            **_RECORDINGS,
            **_RESUME,
        },
    ),
    "motion": Bench("the bias learned in motion, beside vqf's", "motion", _BROAD),
    "own-axes": Bench(
        *("scale and axes that the filter in motion finds by itself", "own_axes"),
        {"--devices": _number(12, "simulated devices a row"), **_FOLDERS},
    ),
    "real": Bench("`close` on real recordings, each alone", "loop.real", _RECORDINGS),
    "real-motion": Bench(
        "the bias at the end of real motion, beside other filters'", "real_motion", _FOLDERS
    ),
    "singles": Bench(
        "`close` on one or two simulated recordings: does it make anything worse?",
        "loop.singles",
        {"--devices": _number(400, "devices"), **_PROCESSES, **_RESUME},
    ),
    "variants": Bench(
        "`close` on real recordings that were cut or damaged", "loop.variants", _RECORDINGS
    ),
}
