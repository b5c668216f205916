"""The table of effects that the loop knows, from the catalogue and the words of the report."""

import re

from zerorate_tools.loop.search.catalogue import CATALOGUE, GENERIC, GROUPS
from zerorate_tools.report.kinds import KINDS

_PLACE = re.compile(r"<!-- effects -->\n.*?<!-- end -->", re.DOTALL)


def with_effect_table(text):
    """The text with each place `<!-- effects --> ... <!-- end -->` filled anew."""
    return _PLACE.sub(lambda match: f"<!-- effects -->\n{effect_table()}<!-- end -->", text)


def effect_table():
    """Every kind of the catalogue and every form of a channel: name, in words, what it says."""
    kinds = [row[0] for row in (*CATALOGUE, *GROUPS, *GENERIC)]
    rows = [f"| `{kind}` | {_title(kind)} | {KINDS[kind][1]} |" for kind in kinds]
    return "\n".join(["| effect | | |", "|---|---|---|", *rows, ""])


def _title(kind):
    words = KINDS[kind][0]
    return f"any channel: {words}" if kind.startswith("channel") else words
