"""The whole benchmark of the loop, which can be broken off and taken up again."""

import os
import tempfile
from collections.abc import Callable, Iterator
from os import PathLike
from pathlib import Path

from ..outcomes import outcomes
from ..public_data import data_folder
from ..tables import machine, machine_line, table
from .devices import Device, devices
from .figures import Figure, figures
from .files import ROWS, file_devices, look_at_files
from .quiet import FOLDER, write_blocks
from .rests import rest_figures
from .run_trial import Outcome, run_trial
from .size import figures_of, measured


def run(
    nulls: int = 200,
    seeds: int = 20,
    processes: int = 2,
    data: str | PathLike[str] | None = None,
    resume: str | PathLike[str] | None = None,
    size: bool = True,
    rows: str | None = None,
    advance: Callable[[float], None] = lambda n: None,
) -> dict:
    """Run it and return the figures and tables as plain values; `markdown` makes them readable.

    nulls: devices of each kind of nothing; seeds: devices an effect; data: folder of the real
    recordings, else ZERORATE_DATA, else none; resume: a file of outcomes, one a line, that a run
    broken off goes on from; size: time and memory
    of a device of 4 sessions of 8 hours at 100 Hz; rows: only devices whose key holds this text,
    and nothing else.
    """
    folder = Path(data) if data else data_folder()
    with tempfile.TemporaryDirectory() as scratch:
        quiet = write_blocks(folder, Path(scratch)) if folder and folder.is_dir() else []
        os.environ[FOLDER] = scratch
        every = [*devices(nulls, seeds, quiet), *file_devices(-(-seeds // 2))]
        every = [d for d in every if not rows or rows in d.key]
        seen = list(looked_at(every, processes, Path(resume) if resume else None, advance))
    found = figures(seen, whole=not rows)
    if not rows:
        found += rest_figures() + (figures_of(measured()) if size else [])
    result: dict = {"devices": len(seen), "machine": machine()}
    result["cpu_s_a_device"] = sum(o.cpu_s for o in seen) / max(len(seen), 1)
    if folder and folder.is_dir() and not rows:
        from .real import real_rows

        result["real_recordings"] = real_rows(folder)
    result["figures"] = [f.to_dict() for f in found]
    result["false_alarms"] = _examples(seen)
    return result


def looked_at(
    every: list[Device],
    processes: int = 1,
    kept: Path | None = None,
    advance: Callable[[float], None] = lambda n: None,
) -> Iterator[Outcome]:
    """The outcome of every device; what `kept` has already is not looked at again."""
    for row in outcomes(_look, every, processes, kept, advance):
        device = row.pop("device")
        device["effects"] = tuple((name, size) for name, size in device["effects"])
        yield Outcome(Device(**device), **row)


def _look(device: Device) -> Outcome:
    return look_at_files(device) if device.row in ROWS else run_trial(device)


def _examples(outcomes: list[Outcome], most: int = 20) -> list[list]:
    """[row, seed, names] of devices without an effect in which one was found."""
    nothing = [o for o in outcomes if not o.device.effects and o.found]
    return [[o.device.row, o.device.seed, o.found, o.confidence] for o in nothing[:most]]


def markdown(result: dict) -> str:
    """The figures as Markdown, the missed ones first."""
    rows = [Figure(**{k: v for k, v in f.items() if k != "met"}) for f in result["figures"]]
    missed = [f.name for f in rows if f.met is False]
    head = f"{len(missed)} of {sum(f.met is not None for f in rows)} figures missed"
    head_line = f"# What closing the loop finds, on {result['devices']} devices"
    parts = [head_line, "", "`zerorate bench loop` wrote this page. " + machine_line()]
    parts += [f"{head}: {'; '.join(missed)}." if missed else "Every figure is reached.", ""]
    parts.append(figure_table(result["figures"]))
    if "real_recordings" in result:
        parts += ["## Real recordings", "", _real(result["real_recordings"])]
    return "\n".join(parts)


def renewed(page: str, figures: list[dict]) -> str:
    """A page of `markdown` with these figures in the place of its own of the same name, or after
    the last where it has none, and its head told anew."""
    lines = [*page.splitlines(), ""]
    for line in figure_table(figures).strip().splitlines()[2:]:
        name = _name(line)
        at = next((i for i, old in enumerate(lines) if _name(old) == name), None)
        if at is None:
            at = lines.index("", lines.index(next(x for x in lines if x.startswith("| ---"))))
            lines.insert(at, line)
        lines[at] = line
    missed = [_name(line) for line in lines if " | NO | " in line]
    head = next(i for i, line in enumerate(lines) if line and i > 2)
    lines[head] = f"Missed: {'; '.join(missed)}." if missed else "Every figure is reached."
    return "\n".join(lines).rstrip("\n") + "\n"


def _name(line: str) -> str:
    return line.split(" | ")[0].removeprefix("| ")


def figure_table(figures: list[dict]) -> str:
    """A row a figure, as `Figure.to_dict` has it."""
    rows = [Figure(**{k: v for k, v in f.items() if k != "met"}) for f in figures]
    header = ("figure", "measured", "limit", "reached", "95 % interval", "devices")
    return table(header, [_cells(f) for f in rows])


def _cells(f: Figure) -> tuple:
    unit = "" if f.unit == "%" else f" {f.unit}"
    sign = "at most" if f.at_most else "at least"
    limit = "" if f.limit is None else f"{sign} {f.limit:g}"
    span = "" if f.low is None else f"{f.low:.1f}-{f.high:.1f}"
    digits = 1 if f.unit == "%" else 3
    reached = {None: "", True: "yes", False: "NO"}[f.met]
    return f.name, f"{f.value:.{digits}f}{unit}", limit, reached, span, f.devices


def _real(rows: dict[str, dict]) -> str:
    keys = list(dict.fromkeys(k for row in rows.values() for k in row))
    header = ("recording", *(k.replace("_", " ") for k in keys))
    return table(header, [(name, *(row.get(k, "") for k in keys)) for name, row in rows.items()])
