"""What a word, an array and a list of codes are, and the table of words.csv.

A line of the table is a word of an array. It takes the index behind the word before it. Where
`array` is ARRAY@WORD the lines stand in the place of others, from that word on, while what `while`
says holds. `count` is text where settings say how many there are. `least` and `most` are what a
word can be; both are empty where its unit says it (bits: 0..30) or it may be anything of 31 bits.

What is used most stands below word 48, which is two bytes less of bytecode than a word from 64 on.
What one loop clears or copies stands together.
"""

from __future__ import annotations

import csv
from collections.abc import Mapping
from importlib.resources import files
from itertools import groupby

END = 2**30  # every word fits 31 bits
_Line = Mapping[str, str]


def _lines_by_array() -> dict[tuple[str, str], list[_Line]]:
    """(array, while) -> its lines, in their order."""
    text = files(__package__).joinpath("words.csv").read_text(encoding="utf-8")
    lines = csv.DictReader(text.splitlines())
    return {key: list(own) for key, own in groupby(lines, lambda w: (w["array"], w["while"]))}


LINES = _lines_by_array()


class Word:
    """One name of an array: its index, how many words it has (text where settings say), and why.

    least, most: what it can be; limited: whether its line says so.
    """

    def __init__(self, index: int, line: _Line) -> None:
        self.name, self.unit, self.meaning = line["name"], line["unit"], line["meaning"]
        self.count: int | str = int(line["count"]) if line["count"].isdigit() else line["count"]
        self.index, self.while_text = index, line["while"]
        self.limited = bool(line["least"])
        self.least, self.most = (0, 30) if self.unit == "bits" else (-END, END - 1)
        if self.limited:
            self.least, self.most = int(line["least"], 0), int(line["most"], 0)

    def bits(self) -> int:
        """Return what Array.bits says of one word."""
        return (96 if self.least < 0 else 64) + max(self.most, ~self.least).bit_length()


class Array:
    """The words of an array or of a block in it. `array.NAME` is that word's index.

    name: of its lines; letter: the kernels' name for the array or for the block's first word; base:
    where it begins. size_name: the constant that says how many words it has. first: the first
    word's index. Raises AttributeError for no word.
    """

    def __init__(
        self, name: str, title: str, letter: str, base: str, size_name: str = "", first: int = 0
    ) -> None:
        self.title, self.letter, self.base, self.size_name = title, letter, base, size_name
        self.words = _placed(LINES[name, ""], first)
        last = self.words[-1]
        self.size = 0 if isinstance(last.count, str) else last.index + last.count
        for (array, _), lines in LINES.items():
            of, _, at = array.partition("@")
            if of == name and at:
                self.words += _placed(lines, getattr(self, at))

    def bits(self) -> bytes:
        """Return ASCII that says of every word whose place no setting moves how many bits it has.

        64 and the number of bits; 96 and the bits beside the sign where a word may be negative.
        """
        words = [word for word in self.words if not word.while_text]
        counted = [(word, word.count) for word in words if isinstance(word.count, int)]
        return bytes(word.bits() for word, count in counted for _ in range(count))

    def __getattr__(self, name: str) -> int:
        for word in self.words:
            if word.name == name:
                return word.index
        raise AttributeError(name)


def _placed(lines: list[_Line], index: int) -> list[Word]:
    words: list[Word] = []
    for line in lines:
        words.append(Word(index, line))
        index += 0 if isinstance(words[-1].count, str) else words[-1].count
    return words


class Codes:
    """Numbers that stand for something. `codes.NAME` is the number.

    owner: the file in which applications find them by name, "" where they are the kernels' own;
    ordered: names of numbers that count up from `first`; said: instead of them name -> what a board
    says of it, in the file and under the name of `said_in`.
    """

    def __init__(
        self,
        title: str,
        owner: str,
        ordered: str = "",
        first: int = 0,
        said_in: str = "",
        said: Mapping[str, str] | None = None,
        **numbers: int,
    ) -> None:
        self.title = title
        self.owner = owner
        self.said_in = tuple(said_in.split())
        self.said = dict(said or {})
        names = [*ordered.split(), *self.said]
        self.numbers = {name: i for i, name in enumerate(names, first)} | numbers

    def __getattr__(self, name: str) -> int:
        if name in self.numbers:
            return self.numbers[name]
        raise AttributeError(name)
