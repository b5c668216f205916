"""The console blocks of a page: what each `$ command` in them prints, run top to bottom."""

import os
import re
import subprocess
import sys
from pathlib import Path

from zerorate_tools.demo import broad

from .pages import blocks

_NUMBER = re.compile(r"(?<![\w.])[+-]?\d[\d,]*(?:\.\d+)?(?:e[+-]?\d+)?")
#: A minute long; host_tests/package holds it to what the page shows, run away from the checkout.
DEMO = "zerorate demo --out shown"


def demo_shown(repository):
    """What docs/commands.md shows of the demo."""
    console = blocks(repository / "docs" / "commands.md", "console")
    (shown,) = (block.text for block in console if DEMO in commands(block))
    return shown


def refreshed(page, folder, but=None):
    """The text of a page with its console blocks run anew in `folder`, all but command `but`'s.

    Its Python blocks are run in their place, too. What would have to be fetched first is left as it
    stands. Raises ValueError where a Python block fails.
    """
    text = page.read_text(encoding="utf-8")
    parts, at = [], 0
    for block in blocks(page, "console", "python"):
        if block.language == "python":
            _run_program(block.text, folder)
            continue
        if not _needs_the_network(block) and but not in commands(block):
            parts += [text[at : block.start], _session(block.text, folder)]
            at = block.end
    return "".join([*parts, text[at:]])


def commands(block):
    """The commands of a console block."""
    return [line[2:] for line in block.text.splitlines() if line.startswith("$ ")]


def _needs_the_network(block):
    trial = broad.kept_in() / f"{broad.NAME}.mat"
    return "demo --real" in block.text and not trial.exists()


def _session(text, folder):
    lines = [line for line in text.splitlines() if line.startswith("$ ")]
    return "".join(f"{line}\n{_run(['sh', '-c', line[2:]], folder)}" for line in lines)


def _run_program(text, folder):
    done = _done([sys.executable, "-c", text], folder)
    if done.returncode:
        raise ValueError(f"{text}\n{done.stdout}")


def _run(command, folder):
    lines = _done(command, folder).stdout.splitlines()
    return "".join(f"{line.rstrip()}\n" for line in lines)


def _done(command, folder):
    path = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
    environment = {**os.environ, "PATH": path, "COLUMNS": "80", "TERM": "dumb"}
    return subprocess.run(
        command,
        cwd=folder,
        env=environment,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )


def same_but_for_rounding(one, other, relative=0.05):
    """Whether two texts have the same words, and numbers that differ by no more than a rounding.

    Fits in floating point come out a little different on another processor.
    """
    if _NUMBER.split(" ".join(one.split())) != _NUMBER.split(" ".join(other.split())):
        return False
    pairs = zip(_NUMBER.findall(one), _NUMBER.findall(other))
    return all(_close(_value(a), _value(b), relative) for a, b in pairs)


def _value(text):
    return float(text.replace(",", ""))


def _close(one, other, relative):
    return abs(one - other) <= max(relative * max(abs(one), abs(other)), 0.2)
