"""The benches of `zerorate bench`: each is a sub-command, a row of BENCHES."""

import argparse
import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from importlib import import_module
from inspect import signature
from pathlib import Path
from typing import Any


@dataclass(frozen=True)
class Bench:
    """help: in a line; module: below zerorate_bench, loaded when the bench is run.

    The module's `run` makes the figures, `in_markdown` the text of them; `steps`, if it has one,
    says how often `run` calls `advance`. `run` and `steps` take the options by their names.
    options: flag -> what argparse takes for it; judged: the exit code says what `passed` does.
    """

    help: str
    module: str
    options: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    judged: bool = False


def add_benches(parser: argparse.ArgumentParser) -> None:
    """Register each bench as a sub-command."""
    benches = parser.add_subparsers(dest="bench", metavar="BENCH", required=True)
    for name, bench in BENCHES.items():
        _add(benches.add_parser(name, help=bench.help, description=bench.help), bench)


def _add(parser: argparse.ArgumentParser, bench: Bench) -> None:
    for flag, how in bench.options.items():
        parser.add_argument(flag, **how)
    parser.add_argument("--out", type=Path, metavar="FILE", help="write Markdown, not print it")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the figures there too")
    parser.set_defaults(run=lambda arguments: _run(bench, arguments))


def _run(bench: Bench, arguments: argparse.Namespace) -> int:
    from zerorate_tools.progress import progress
    from zerorate_tools.recordings.atomic import written_beside

    module = import_module(f"zerorate_bench.{bench.module}")
    steps = _called(module.steps, arguments) if hasattr(module, "steps") else None
    with progress("measuring", steps) as advance:
        found = _called(module.run, arguments, advance=advance)
    if getattr(arguments, "page", None):
        text = module.renewed(arguments.page.read_text(encoding="utf-8"), found["figures"])
    else:
        text = module.in_markdown(found)
    if arguments.out is None:
        print(text)
    else:
        with written_beside(arguments.out) as temporary:
            temporary.write_text(text, encoding="utf-8")
    if arguments.json is not None:
        with written_beside(arguments.json) as temporary:
            temporary.write_text(json.dumps(found, indent=2) + "\n", encoding="utf-8")
    return 1 if bench.judged and not module.passed(found) else 0


def _called(function: Callable[..., Any], arguments: argparse.Namespace, **more: Any) -> Any:
    """What a function returns of the options that it takes."""
    options = {**vars(arguments), **more}
    return function(**{n: options[n] for n in signature(function).parameters if n in options})


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
        "time and memory of `close` in motion; exit code 1 if too much",
        "heading_size",
        judged=True,
    ),
    "import": Bench(
        *("logs of other tools: right or refused; exit code 1 if one is wrong", "foreign_imports"),
        {"--only": {"metavar": "TEXT", "default": "", "help": "logs whose row holds it"}},
        judged=True,
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
