"""The console blocks of a page: what each `$ command` in them prints, run top to bottom.

`make docs` writes what in docs/ is made by a command: tables, pictures, console output.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

from zerorate_tools.cli import parser
from zerorate_tools.demo import broad
from zerorate_tools.model.effects import ANY_CHANNEL, EFFECTS

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


_PLACE = re.compile(
    r"<!-- (?:options of ([\w ]+)|table (\d+) of ([\w.-]+)|effects) -->\n(.*?)<!-- end -->",
    re.DOTALL,
)
_TABLE = re.compile(r"(?:^\|.*\n)+", re.MULTILINE)


def with_tables(text, docs):
    """The text with all its marked places filled anew; docs: the folder of the other pages."""

    def filled(match):
        names, number, page, before = match.groups()
        if names:
            table = option_table(names.split())
        elif page:
            table = _TABLE.findall((docs / page).read_text(encoding="utf-8"))[int(number) - 1]
        else:
            table = effect_table()
        return match[0].replace(f"\n{before}<!-- end", f"\n{table}<!-- end")

    return _PLACE.sub(filled, text)


def effect_table():
    """Every effect that the loop knows: its kind, in words, what it says."""
    titles = [f"{'any channel: ' * (row.source == ANY_CHANNEL)}{row.title}" for row in EFFECTS]
    rows = [f"| `{row.kind}` | {t} | {row.meaning} |" for row, t in zip(EFFECTS, titles)]
    return "\n".join(["| effect | title | meaning |", "|---|---|---|", *rows, ""])


def option_table(names):
    """The arguments of a sub-command (or of one of its own) as a Markdown table.

    Of a command that has sub-commands only: these, each with what it does.
    """
    found = _parser_of(names)
    groups = [a for a in found._actions if isinstance(a, argparse._SubParsersAction)]
    if groups:
        rows = [f"| `{one.dest}` | {_text(one)} |" for one in groups[0]._choices_actions]
        return "\n".join([f"| `{' '.join(names)}` | |", "|---|---|", *rows, ""])
    rows = [
        f"| {_name(action)} | {_text(action)} |"
        for action in found._actions
        if not isinstance(action, argparse._HelpAction)
    ]
    return "\n".join(["| argument | |", "|---|---|", *rows, ""])


def commands_under(names=()):
    """The names of the sub-commands of `zerorate`, or of one of its commands."""
    return sorted(_choices(_parser_of(names)))


def _parser_of(names):
    found = parser()
    for name in names:
        found = _choices(found)[name]
    return found


def _choices(of):
    groups = [a for a in of._actions if isinstance(a, argparse._SubParsersAction)]
    return groups[0].choices if groups else {}


def _name(action):
    shown = action.metavar or (action.dest.upper() if action.nargs != 0 else "")
    if action.choices and not action.metavar:
        shown = "{" + ",".join(map(str, action.choices)) + "}"
    if not action.option_strings:
        return f"`{shown}`"
    if isinstance(action, argparse.BooleanOptionalAction):
        return " ".join(f"`{option}`" for option in action.option_strings)
    return "`" + f"{action.option_strings[-1]} {shown}".strip() + "`"


def _text(action):
    return (action.help or "").replace("|", "\\|").replace("%%", "%")


_BLOCK = re.compile(r"^```(\w+)\n(.*?)^```$", re.DOTALL | re.MULTILINE)


@dataclass(frozen=True)
class Block:
    """A fenced block: its language, its text and where the text is in the page."""

    language: str
    text: str
    start: int
    end: int


def pages(repository):
    """Every page, README.md first."""
    return [repository / "README.md", *sorted((repository / "docs").glob("**/*.md"))]


def blocks(page, *languages):
    """The blocks of a page in these languages, in order."""
    text = Path(page).read_text(encoding="utf-8")
    found = (Block(m[1], m[2], m.start(2), m.end(2)) for m in _BLOCK.finditer(text))
    return [block for block in found if block.language in languages]


def main(repository, only=()):
    """Write the pages anew; only: names of those whose commands are run, `none`, all by default."""
    docs = repository / "docs"
    for page in pages(repository):
        if blocks(page, "console") and (not only or page.name in only):
            print(page.relative_to(repository), flush=True)
            with tempfile.TemporaryDirectory() as folder:
                page.write_text(refreshed(page, folder), encoding="utf-8")
                for picture in ("shown/demo.png", "watch.png"):
                    if (Path(folder) / picture).exists():
                        shutil.copy(Path(folder) / picture, docs)
        page.write_text(with_tables(page.read_text(encoding="utf-8"), docs), encoding="utf-8")


if __name__ == "__main__":
    main(Path(__file__).resolve().parents[2], sys.argv[1:])
