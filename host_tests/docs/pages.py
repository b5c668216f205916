"""The pages for people: README.md and docs/*.md, and the blocks of code in them."""

import re
from dataclasses import dataclass
from pathlib import Path

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
