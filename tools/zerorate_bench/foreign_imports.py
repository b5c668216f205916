"""Logs as other tools write them: imported rightly, or refused with the cure.

Each is imported by the command line with no more than a user of it knows. What comes out is held
against the truth of the log, sample by sample. A refusal's own words are tried: one of the readings
that they offer must be the right one.
"""

import contextlib
import io
import re
import shlex
import tempfile
from dataclasses import replace
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
from zerorate_tools.cli import main
from zerorate_tools.recordings import Recording, read_recording

from .foreign_logs import CORPUS, Log, World
from .tables import measured, table

RIGHT, BY_ITS_WORDS, REFUSED = "right", "right by its words", "refused with the cure"
WRONG, MISLED, NO_CURE = "WRONG", "its words are WRONG", "refused WITHOUT a cure"
_FLAGS = ("--map", "--hz", *(f"--{kind}-unit" for kind in ("time", "gyro", "accel", "temp")))
_FLAGS += ("--gyro-lsb-per-dps", "--accel-lsb-per-g", "--instance")
_BAD = (WRONG, MISLED, NO_CURE)
#: Root of the mean square of what may be off: a coarse LSB, half a period's noise.
_DPS, _G, _DEGC = 0.4, 0.02, 0.2
_WORST = 10.0
#: And what a scale may be: half a percent of the whole.
_SIZE = 0.005
_MOST_WORDS = 24
_CUT = re.compile(r"zerorate cut .* FOLDER")
_HEAD = """# Logs of other tools

`zerorate bench import` writes each of these logs as its tool does, and imports it by the command
line, with no more than a user of that tool knows. The exit code is 1 if one is wrong.
"""
_WORDS = f"""
| outcome | what it says |
| --- | --- |
| {RIGHT} | rates, forces, temperature and times are those that the log was made from, all of them |
| {BY_ITS_WORDS} | `import` refuses and offers words to type; a choice of them holds the right one |
| {REFUSED} | `import` refuses, and says what to do outside of it |

`import` accepts a name that no reading contradicts, such as a time in milliseconds that is called
seconds, if somebody might have recorded at that rate.
"""
_OPTION = re.compile(r"--[a-z-]+ (?:'[^']*'|[^\s,;()]+)(?: \(or [^)]*\))?")
#: A reading of time by another unit: `us (1000 Hz) or ms (1 Hz)`.
_UNIT_OF_TIME = re.compile(r"--time-unit ((?:\S+ \([^)]*\)(?: or )?)+)")


def run(only: str) -> dict[str, object]:
    """The outcome of each log whose description holds `only`."""
    logs = [log for log in CORPUS if only.lower() in log.what.lower()]
    return {"rows": [judged(log) for log in measured(logs)]}


def judged(log: Log) -> dict[str, str]:
    """What an import made of one log."""
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "log").mkdir()
        source = log.write(Path(folder) / "log", World(log.samples))
        outcome, said = _outcome(log, source, Path(folder) / "out.parquet")
    return {"log": log.what, "outcome": outcome, "said": said.replace(str(source), source.name)}


def _outcome(log: Log, source: Path, out: Path) -> tuple[str, str]:
    code, said = _imported(source, out, shlex.split(log.words))
    if code == 0:
        off = _off(read_recording(out, keep_gaps=True), log)
        return (WRONG, f"{off}; said: {said}") if off else (RIGHT, said)
    if "; " not in said:
        return NO_CURE, said
    if cut := _CUT.search(said):
        words = shlex.split(cut[0].replace("FOLDER", str(out.parent / "parts")))[1:]
        code, lines = _said(words)
        parts = [] if code else [Path(word) for line in lines for word in line.split()]
        shares = [_outcome(replace(log, least=0.4), part, out)[0] for part in parts]
        good = len(parts) > 1 and all(share in (RIGHT, BY_ITS_WORDS) for share in shares)
        return (BY_ITS_WORDS if good else MISLED), said
    ends = _followed(log, source, out, shlex.split(log.words), said)
    return (BY_ITS_WORDS if RIGHT in ends else MISLED if WRONG in ends else REFUSED), said


def _said(words: list[str]) -> tuple[int, list[str]]:
    """(exit code, lines of what was said) of a command."""
    stdout, stderr = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(stdout), contextlib.redirect_stderr(stderr):
        try:
            code = main(words)
        except SystemExit as refused:  # words that are no words of the command line
            code = int(refused.code or 0)
    return code, (stderr if code else stdout).getvalue().splitlines()


def _followed(log: Log, source: Path, out: Path, typed: list[str], said: str) -> set[str]:
    """Where the ready words of a refusal lead, and those of the next one."""
    ends = set()
    for words in _offers(said) if len(typed) < _MOST_WORDS else ():
        code, again = _imported(source, out, [*typed, *words])
        if code:
            ends |= _followed(log, source, out, [*typed, *words], again)
        else:
            ends.add(WRONG if _off(read_recording(out, keep_gaps=True), log) else RIGHT)
        if RIGHT in ends:
            break
    return ends


def _imported(source: Path, out: Path, words: list[str]) -> tuple[int, str]:
    """(exit code, what was said) of the command."""
    code, lines = _said(["import", str(source), "--out", str(out), *words])
    return code, " / ".join(line.strip() for line in (lines if code else lines[1:]))


def _offers(said: str) -> list[list[str]]:
    """Every reading of a refusal's ready words, each as arguments; [] where it has none."""
    choices: list[list[str]] = []
    times = _UNIT_OF_TIME.search(said)
    if times:
        choices.append([f"--time-unit {unit}" for unit in re.findall(r"(\S+) \(", times[1])])
        said = said.replace(times[0], "")
    for found in _OPTION.findall(said):
        first, _, others = found.partition(" (or ")
        flag = first.split()[0]
        if "COLUMN" not in first and flag in _FLAGS and first not in [one[0] for one in choices]:
            words = re.findall(r"[^\s,)]+", others)
            choices.append([first, *(f"{flag} {unit}" for unit in words if "--" not in unit)])
    if not choices:
        return []
    return [shlex.split(" ".join(words)) for words in product(*choices)][:64]


def _off(recording: Recording, log: Log) -> str:
    """What is not as the truth has it, in words; empty where nothing is."""
    world = World(log.samples)
    t_s = recording.columns["t_us"] * 1e-6
    at = np.rint((t_s - t_s[0]) * world.hz).astype(int)
    # a part of a log begins later than the world, as its own times say
    own = min(max(0, round(float(t_s[0]) * world.hz)), world.samples)
    first = min((0, 1, 2, own), key=lambda n: _far(recording, world.dps, at, n))
    at = at + first
    if (at < 0).any() or (at >= world.samples).any() or (np.diff(at) <= 0).any():
        return f"its times are not those of the log: {t_s[-1] - t_s[0]:.4g} s"
    if not log.least * world.samples <= len(at) <= log.most * world.samples:
        return f"{len(at)} samples of {world.samples}"
    read = [("rates", recording.gyro_dps(), world.dps[at], _DPS)]
    if "ax" in recording.columns:
        read.append(("forces", recording.accel_g(), world.g[at], _G))
    if "temp" in recording.columns:
        read.append(("temperature", recording.temp_degc(), world.degc[at], _DEGC))
    return ", ".join(said for one in read if (said := _unlike(*one)))


def _unlike(name: str, found: np.ndarray, true: np.ndarray, most: float) -> str:
    """In words, how far what was read is off; empty where it is as the truth has it."""
    error, size = found - true, float(np.sum(found * true) / np.sum(true**2))
    rms, worst = float(np.sqrt(np.mean(error**2))), float(np.abs(error).max())
    if rms <= most and worst <= _WORST * most and abs(size - 1.0) <= _SIZE:
        return ""
    return f"{name} off by {rms:.3g}, at most {worst:.3g}, {size:.4f} times as large"


def _far(recording: Recording, truth: np.ndarray, at: np.ndarray, first: int) -> float:
    inside = (at + first >= 0) & (at + first < len(truth))
    if not inside.any():
        return float("inf")
    return float(np.mean(np.abs(recording.gyro_dps()[inside] - truth[at[inside] + first])))


def passed(found: dict[str, Any]) -> bool:
    """Whether nothing is wrong, misleading or without a cure."""
    return not any(row["outcome"] in _BAD for row in found["rows"])


def in_markdown(found: dict[str, Any]) -> str:
    """A page: how many there are of each outcome, then each log."""
    outcomes = [row["outcome"] for row in found["rows"]]
    kinds = (RIGHT, BY_ITS_WORDS, REFUSED, *_BAD)
    counted = table(["of", *kinds], [[len(outcomes), *(outcomes.count(kind) for kind in kinds)]])
    rows = [[row["log"], row["outcome"]] for row in found["rows"]]
    return f"{_HEAD}\n{counted}{_WORDS}\n{table(['log', 'import'], rows)}"
