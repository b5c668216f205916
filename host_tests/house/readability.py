"""How easily the pages for newcomers are read: python -m host_tests.house.readability [PAGE...]."""

import re
import sys
from pathlib import Path

import textstat
from markdown_it import MarkdownIt

#: Beside those of docs.
PAGES = ("README.md", "CONTRIBUTING.md", "CHANGELOG.md", "SECURITY.md")
#: Tables and lists of names.
_NO_PROSE = {"api.md", "glossary.md", "layout.md"}
MOST_WORDS_A_SENTENCE = 16
LEAST_READING_EASE = 55  # Flesch: 50 to 60 is "fairly difficult", 60 to 70 "plain English"

_NOT_PROSE = ("heading", "th", "td")


def pages(root):
    """Every page that is read as prose, below the folder `root`."""
    docs = sorted(p.relative_to(root).as_posix() for p in (root / "docs").glob("*.md"))
    names = (page for page in docs if Path(page).name not in _NO_PROSE and "figures" not in page)
    return [*PAGES, *names]


def prose(markdown):
    """The sentences of a page, one paragraph or list item a line.

    Headings, tables, code blocks and pictures are left out. A piece of code in a sentence counts as
    one short word. A full stop inside a word or a number is no end of a sentence.
    """
    lines, inside = [], ""
    for token in MarkdownIt().enable("table").parse(markdown):
        if token.type == "inline" and inside not in _NOT_PROSE:
            lines.append("".join(map(_text, token.children)))
        inside = token.type.removesuffix("_open") if token.nesting == 1 else ""
    ended = (re.sub(r"(?<=\w)\.(?=\w)", "", line).rstrip(" :;,") for line in lines)
    return "\n".join(line if line[-1] in ".!?)" else f"{line}." for line in ended if line)


def _text(token):
    """What a reader sees of a part of a line."""
    return {"text": token.content, "code_inline": "code", "softbreak": " "}.get(token.type, "")


def readability(markdown):
    """(mean words a sentence, Flesch reading ease) of a page's prose."""
    text = prose(markdown)
    return textstat.words_per_sentence(text), textstat.flesch_reading_ease(text)


def main(pages):
    """Print each page's figures beside its limits; 1 if a page misses one."""
    missed = False
    print(f"must be: at most {MOST_WORDS_A_SENTENCE} words, at least {LEAST_READING_EASE}")
    for page in pages:
        words, ease = readability(Path(page).read_text(encoding="utf-8"))
        missed |= words > MOST_WORDS_A_SENTENCE or ease < LEAST_READING_EASE
        print(f"{page}: {words:.1f} words a sentence, Flesch reading ease {ease:.0f}")
    return int(missed)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:] or pages(Path())))
