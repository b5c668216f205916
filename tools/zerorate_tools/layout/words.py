"""What a word, an array and a list of codes are."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

END = 2**30  # every word fits 31 bits


class Word:
    """One name of an array: its index, how many words it has (text where settings say), and why.

    least, most: what it can be; a line of the layout ends in both, or in neither where its unit
    says it (bits: 0..30) or it may be anything of 31 bits.
    """

    def __init__(self, index: int, line: Sequence[Any], while_text: str = "") -> None:
        self.name: str = line[0]
        self.count: int | str = line[1]
        self.unit, self.meaning, *limits = line[2:]
        self.index = index
        self.while_text = while_text
        self.limited = bool(limits)
        self.least: int
        self.most: int
        self.least, self.most = limits or ((0, 30) if self.unit == "bits" else (-END, END - 1))

    def bits(self) -> int:
        """Return what Array.bits says of one word."""
        return (96 if self.least < 0 else 64) + max(self.most, ~self.least).bit_length()


class Overlay:
    """Words in the place of others, from the word `at` on, `while_text`: when they are theirs."""

    def __init__(self, at: str, while_text: str, *lines: Sequence[Any]) -> None:
        self.at = at
        self.while_text = while_text
        self.lines = lines


class Array:
    """The words of an array or of a block in it. `array.NAME` is that word's index.

    letter: the kernels' name for the array or for the block's first word; base: where it begins.
    size_name: the constant that says how many words it has. Raises AttributeError for no word.
    """

    def __init__(
        self,
        title: str,
        letter: str,
        base: str,
        size_name: str,
        lines: Sequence[Sequence[Any]],
        overlays: Sequence[Overlay] = (),
        first: int = 0,
    ) -> None:
        self.title = title
        self.letter = letter
        self.base = base
        self.size_name = size_name
        self.words = self._placed(lines, first, "")
        last = self.words[-1]
        self.size = 0 if isinstance(last.count, str) else last.index + last.count
        for overlay in overlays:
            at = getattr(self, overlay.at)
            self.words = self.words + self._placed(overlay.lines, at, overlay.while_text)

    def _placed(self, lines: Sequence[Sequence[Any]], index: int, while_text: str) -> list[Word]:
        words: list[Word] = []
        for line in lines:
            words.append(Word(index, line, while_text))
            index += 0 if isinstance(words[-1].count, str) else words[-1].count
        return words

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
