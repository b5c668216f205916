"""Tables of one page copied into another's marked places, so that a figure is written once."""

import re

_PLACE = re.compile(r"<!-- table (\d+) of ([\w.-]+) -->\n.*?<!-- end -->", re.DOTALL)
_TABLE = re.compile(r"(?:^\|.*\n)+", re.MULTILINE)


def with_copied_tables(text, docs):
    """The text with each place `<!-- table N of PAGE --> ... <!-- end -->` filled anew.

    docs: the folder of the pages that are copied from.
    """

    def filled(match):
        page = (docs / match[2]).read_text(encoding="utf-8")
        table = _TABLE.findall(page)[int(match[1]) - 1]
        return f"<!-- table {match[1]} of {match[2]} -->\n{table}<!-- end -->"

    return _PLACE.sub(filled, text)
