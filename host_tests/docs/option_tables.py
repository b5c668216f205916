"""Tables of a sub-command's arguments, from the parser itself, into a page's marked places."""

import argparse
import re

from zerorate_tools.cli import parser

_PLACE = re.compile(r"<!-- options of ([\w ]+) -->\n.*?<!-- end -->", re.DOTALL)


def with_option_tables(text):
    """The text with each place `<!-- options of NAME --> ... <!-- end -->` filled anew."""

    def filled(match):
        return f"<!-- options of {match[1]} -->\n{option_table(match[1].split())}<!-- end -->"

    return _PLACE.sub(filled, text)


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
