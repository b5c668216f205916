"""The marked places of a page: arguments of commands, effects, tables copied from other pages.

One begins with `<!-- options of NAME -->`, `<!-- effects -->` or `<!-- table N of PAGE -->`, so
that a figure is written once, and ends with `<!-- end -->`.
"""

import argparse
import re

from zerorate_tools.cli import parser
from zerorate_tools.model.effects import ANY_CHANNEL, EFFECTS

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
    return "\n".join(["| effect | | |", "|---|---|---|", *rows, ""])


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
