"""The words of a stored state by name: `zerorate state show`."""

import re
import zlib
from dataclasses import dataclass
from itertools import product
from os import PathLike
from pathlib import Path

import numpy as np
from zerorate import Corrector
from zerorate.model import EffectModel

from .. import layout
from ..bounds import bytes_of
from ..errors import InFile, ZerorateError
from ..layout import SETTINGS, Names, named, named_source, named_state

_MAGIC, _HEADER, _CRC = b"ZRS", 20, 4
_STATE_VERSION = 2  # the models of a store are of version 1
_FRACTION = re.compile(r"_Q(\d+)\b")


@dataclass(frozen=True)
class Word:
    """A word of a state: array and number in it, name, raw value, unit by the layout."""

    array: str
    number: int
    name: str
    raw: int
    unit: str

    @property
    def value(self) -> float:
        """The raw value in its unit: `_Q8` in a name is eight bits of fraction."""
        bits = _FRACTION.search(self.name)
        return self.raw / 2.0 ** int(bits[1]) if bits else float(self.raw)

    @property
    def shown(self) -> str:
        """The value with its unit, or what a code stands for."""
        kind, _, codes = self.unit.partition(" ")
        if kind == "code":
            numbers = getattr(layout, codes).numbers
            return next((name for name, n in numbers.items() if n == self.raw), "no such code")
        return f"{self.value:g} {self.unit}" if self.unit or self.value != self.raw else ""


def words_of_file(
    path: str | PathLike[str], options: dict[str, object] | None = None
) -> list[Word]:
    """Every word of a state (`replay --state`) or of a store (a board's learned.bin).

    options: the keywords of zerorate.Corrector that the state was made with, where they change its
    size. Raises InFile.
    """
    data = bytes_of(path, "name a state or a store")
    if data.startswith(_MAGIC):
        words = np.frombuffer(_newest_record(Path(path), data), "<i4")
        first = len(words) - SETTINGS.size  # its settings lie behind the state
        settings = words[first:].tolist()
        arrays = [("state", named_state(settings)), ("settings", named(SETTINGS, SETTINGS.size))]
    else:
        words = np.frombuffer(data[: len(data) // 4 * 4], "<i4")
        arrays = _arrays(Path(path), len(words), options or {})
    places = [(array, n, *one) for array, names in arrays for n, one in enumerate(names)]
    return [Word(a, n, name, int(raw), unit) for (a, n, name, unit), raw in zip(places, words)]


def _newest_record(path: Path, data: bytes) -> bytes:
    """The payload of the newest whole state in a store: two slots, behind them a model's two."""
    found = []
    for at in (m.start() for m in re.finditer(_MAGIC, data)):
        size = int.from_bytes(data[at + 6 : at + 8], "little")
        record = data[at : at + _HEADER + size + _CRC]
        whole = zlib.crc32(record[:-_CRC]).to_bytes(4, "little") == record[-_CRC:]
        if whole and record[4] == _STATE_VERSION:
            found.append((int.from_bytes(record[8:12], "little"), record[_HEADER:-_CRC]))
    if not found:
        raise InFile(path, "no state of this store is whole", do="load an older copy")
    return max(found)[1]


def _arrays(path: Path, length: int, options: dict[str, object]) -> list[tuple[str, Names]]:
    """The arrays of a state file of so many words, with the names of theirs."""
    try:
        corrector = Corrector(**{**options, "motion": True, "gravity": True})
    except (TypeError, ValueError) as error:
        raise ZerorateError(f"--set: {error}") from error
    state = named_state(corrector.settings)
    sizes = {"motion": len(corrector.motion), "gravity": len(corrector.gravity)}
    sizes["effects"] = len(EffectModel().e)
    for there in product((False, True), repeat=len(sizes)):
        others = [name for name, is_there in zip(sizes, there) if is_there]
        if length == len(state) + sum(sizes[name] for name in others):
            return [("state", state), *((n, named_source(n, sizes[n])) for n in others)]
    problem = f"{4 * length} bytes where a state with these settings has {4 * len(state)}"
    raise InFile(path, problem, do="name a state, or its settings with --set")


def in_words(words: list[Word]) -> str:
    """A line a word: its number in its array, name, raw value, and value with unit."""
    lines, array = [], ""
    for word in words:
        if word.array != array:
            array = word.array
            lines.append(f"{array}: word, name, raw, in its unit")
        lines.append(f"{word.number:5} {word.name:34} {word.raw:11} {word.shown}".rstrip())
    return "\n".join(lines)
