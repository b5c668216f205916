"""The table of effects that the loop knows, from the rows of model/effects.py."""

import re

from zerorate_tools.model.effects import ANY_CHANNEL, EFFECTS

_PLACE = re.compile(r"<!-- effects -->\n.*?<!-- end -->", re.DOTALL)


def with_effect_table(text):
    """The text with each place `<!-- effects --> ... <!-- end -->` filled anew."""
    return _PLACE.sub(lambda match: f"<!-- effects -->\n{effect_table()}<!-- end -->", text)


def effect_table():
    """Every row: its kind, in words, what it says."""
    rows = [f"| `{row.kind}` | {_title(row)} | {row.meaning} |" for row in EFFECTS]
    return "\n".join(["| effect | | |", "|---|---|---|", *rows, ""])


def _title(row):
    return f"any channel: {row.title}" if row.source == ANY_CHANNEL else row.title
