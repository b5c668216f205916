"""The firmware and the driver put on a board: compiled for it, whole or not at all."""

from __future__ import annotations

import ast
from base64 import b64encode
from binascii import crc32
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from importlib.resources import files
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING

from ..bounds import bytes_of
from ..errors import InFile
from .compiling import board_files, machine_code, mpy_version
from .connection import BoardError, BoardFacts, ask, connected, output_of
from .parts import PACKAGES, REST, chosen_parts, heap_needed, needs, parts_there

if TYPE_CHECKING:
    from mpremote.transport_serial import SerialTransport

_LIBRARY = "lib"
_STAGE = "zerorate.new"
_PROGRAM, _PROGRAM_BEFORE = PurePosixPath("main.py"), "main.old.py"
_CHUNK = 1536  # bytes of a file, and characters, in a command: little for a board of 16 KB
_COMMAND = 2300
_TRIAL = """
import gc
gc.collect()
try:
    from zerorate.machine_code import chosen
    from zerorate.native import rest
    if chosen["rest"] != "machine code": print(chosen["rest"])
except Exception as error:
    print(repr(error))
"""


@dataclass
class Flashed:
    """What came of it: files -> bytes that the board has now, and how many of them were sent."""

    facts: BoardFacts
    files: dict[PurePosixPath, int]
    sent_bytes: int = 0
    sent: list[PurePosixPath] = field(default_factory=list)

    @property
    def total(self) -> int:
        """Bytes of all files."""
        return sum(self.files.values())


def flash(
    port: str,
    dry_run: bool = False,
    main: Path | None = None,
    say: Callable[[str], None] = print,
    model: Path | None = None,
    parts: Iterable[str] = (),
    only: bool = False,
) -> Flashed:
    """Put the packages into lib on the board at port, compiled for what it is.

    parts: what is sent besides the rest path, keys of PARTS; only: parts that the board has and
    that are not named are removed; main: a file that becomes main.py; model: a model.bin or
    model.json, to model.bin, where `EffectModel.load_file` finds it, with the part it needs. What
    the board has already is not sent again, be it from an attempt that was cut short; a package
    takes its place as a whole, after its files' CRC-32 was found right. dry_run only tells.
    Raises BoardError, BadModel, InFile, UnknownPart.
    """
    chosen = chosen_parts([*parts, *(["effects"] if model is not None else [])])
    extra = _own_files(main, model)
    if dry_run:
        return _told(port, chosen, extra, say, only)
    with connected(port) as board:
        installer = Installer(board, port, say)
        return installer.install(chosen, extra, only)


def _own_files(main: Path | None, model: Path | None) -> dict[PurePosixPath, bytes]:
    found = {}
    if model is not None:
        from ..model import encoded, read_model  # recording needs none of what these import

        found[PurePosixPath("model.bin")] = encoded(read_model(model))
    if main is not None:
        found[_PROGRAM] = _program(main)
    return found


def _program(path: Path) -> bytes:
    data, do = bytes_of(path, "name a program"), "name a program that the board can run"
    try:
        ast.parse(data, path.name)  # MicroPython's syntax is a part of Python's
    except (SyntaxError, ValueError) as error:  # the latter for a byte of zero
        raise InFile(path, f"no Python: {error}", do=do) from error
    return data


def _told(
    port: str,
    parts: tuple[str, ...],
    extra: dict[PurePosixPath, bytes],
    say: Callable[[str], None],
    only: bool,
) -> Flashed:
    try:
        with connected(port) as board:
            facts = ask(board)
            parts = Installer(board, port, say).with_those_there(parts, only)
    except BoardError as error:
        say(f"{error}\nWhat any board would get:")
        facts = BoardFacts()
    contents = {**_packages(parts, facts, machine_code(facts)), **extra}
    say(f"{facts}")
    for name, data in contents.items():
        say(f"{len(data):8d}  {name}")
    flashed = Flashed(facts, {name: len(data) for name, data in contents.items()})
    say(f"{flashed.total:8d}  bytes in {len(contents)} files, of {', '.join(parts)} (dry run)")
    for line in [*older(facts), *room(facts, parts, flashed.total)]:
        say(line)
    return flashed


def _packages(parts: tuple[str, ...], facts: BoardFacts, code: str) -> dict[PurePosixPath, bytes]:
    return {_LIBRARY / name: data for name, data in board_files(parts, facts, code).items()}


def older(facts: BoardFacts) -> list[str]:
    """A line where a newer MicroPython would run machine code, and this one does not."""
    newest = mpy_version()
    kinds = ("armv", "rv32")
    if facts.mpy[0] != newest[0] or facts.mpy >= newest or facts.architecture[:4] not in kinds:
        return []
    cycles = needs()["cycles"]
    slower = round(cycles["bytecode"] / cycles["median"], -1)
    return [
        f"this MicroPython loads no machine code of .mpy {newest[0]}.{newest[1]}: kernels run as "
        f"bytecode, some {slower:.0f} times slower; MicroPython 1.23 or newer runs it"
    ]


def room(facts: BoardFacts, parts: Iterable[str], total: int) -> list[str]:
    """What is needed of flash and heap beside what the board has, in lines."""
    needed = heap_needed(parts, machine_code(facts))
    has = f"; it has {facts.heap_free:,} free" if facts.heap_free else ""
    lines = [f"heap needed: {needed:,} bytes{has}"]
    if facts.disk_free:
        # a full littlefs counts below zero
        lines.append(f"flash needed: {total:,} bytes; it has {max(0, facts.disk_free):,} free")
    if facts.heap_free and facts.heap_free < needed:
        lines.append(
            "that is more heap than this board has: freeze the packages, or leave out a part"
        )
    return lines


class Installer:
    """Puts files on a board in its raw REPL."""

    def __init__(self, board: SerialTransport, port: str, say: Callable[[str], None]) -> None:
        self._board, self._port, self._say = board, port, say
        self._waiting: list[str] = []
        text = files(__package__).joinpath("on_board/install.py").read_text(encoding="utf-8")
        self._do(text)

    def with_those_there(self, parts: tuple[str, ...], only: bool) -> tuple[str, ...]:
        """The parts with those that the board has, or, with only, without; says which."""
        names = [name for package in PACKAGES for name in self._there(f"{_LIBRARY}/{package}")]
        there = parts_there(PurePosixPath(name).relative_to(_LIBRARY) for name in names)
        before = [part for part in chosen_parts(there) if part in there.difference(parts, {REST})]
        if before and only:
            self._say(f"removed, for it is not named: {', '.join(before)}")
        elif before:
            self._say(f"kept, as sent before: {', '.join(before)} (--only removes it)")
        return parts if only else chosen_parts([*parts, *before])

    def install(
        self, parts: tuple[str, ...], extra: dict[PurePosixPath, bytes], only: bool = False
    ) -> Flashed:
        """All of it; see flash."""
        facts = ask(self._board)
        self._say(f"{facts}")
        for package in PACKAGES:  # what an attempt before this one left whole beside main.py
            self._do(f"if is_folder({package!r}): put_in_place(None, {package!r}, {_LIBRARY!r})")
        code = machine_code(facts)
        for line in older(facts):
            self._say(line)
        parts = self.with_those_there(parts, only)
        flashed = self._install_packages(_packages(parts, facts, code), facts)
        if code and (why := self._do(_TRIAL).strip()):
            self._say(f"         the machine code does not run here ({why}): bytecode in its place")
            sent = flashed.sent_bytes
            flashed = self._install_packages(_packages(parts, facts, ""), facts)
            flashed.sent_bytes += sent
        flashed.files.update({name: len(data) for name, data in extra.items()})
        for name, data in extra.items():
            self._install_file(name, data, flashed)
        sent, total = flashed.sent_bytes, flashed.total
        self._say(f"{total:8d}  bytes in {len(flashed.files)} files, {sent} of them sent")
        return flashed

    def _install_packages(self, contents: dict[PurePosixPath, bytes], facts: BoardFacts) -> Flashed:
        flashed = Flashed(facts, {name: len(data) for name, data in contents.items()})
        for package in PACKAGES:
            below = PurePosixPath(_LIBRARY, package)
            wanted = {name: data for name, data in contents.items() if name.is_relative_to(below)}
            self._install_package(package, wanted, flashed)
        self._do(f"remove({_STAGE!r})")
        return flashed

    def _install_package(
        self, package: str, wanted: dict[PurePosixPath, bytes], flashed: Flashed
    ) -> None:
        place, stage = f"{_LIBRARY}/{package}", f"{_STAGE}/{package}"
        there = self._there(place)
        if there == {str(name): _mark(data) for name, data in wanted.items()}:
            for name, data in wanted.items():
                self._tell(name, data, "the same already")
            return
        staged = self._there(stage)
        for name, data in wanted.items():
            self._stage(name, data, there, staged, flashed)
        names = [str(_staged(name)) for name in wanted]
        self._do(f"keep_only({stage!r}, {names!r})")
        self._check({str(_staged(name)): data for name, data in wanted.items()}, stage)
        self._do(f"put_in_place({stage!r}, {package!r}, {_LIBRARY!r})")

    def _stage(
        self,
        name: PurePosixPath,
        data: bytes,
        there: dict[str, tuple[int, int]],
        staged: dict[str, tuple[int, int]],
        flashed: Flashed,
    ) -> None:
        target = str(_staged(name))
        if staged.get(target) == _mark(data):
            self._tell(name, data, "sent before")
        elif there.get(str(name)) == _mark(data):
            self._later(f"make_folders({target!r})\ncopy({str(name)!r}, {target!r})")
            self._tell(name, data, "the same already")
        else:
            self._send(target, data)
            self._sent(name, data, flashed)

    def _install_file(self, name: PurePosixPath, data: bytes, flashed: Flashed) -> None:
        if self._there(str(name)) == {str(name): _mark(data)}:
            self._tell(name, data, "the same already")
            return
        if name == _PROGRAM:
            self._keep_own()
        new = f"{name}.new"
        self._send(new, data)
        self._check({new: data}, new)
        self._do(f"replace({new!r}, {str(name)!r})")
        self._sent(name, data, flashed)

    def _keep_own(self) -> None:
        """Copy the program that is there before the first one that is sent: nobody may have it."""
        if self._there(str(_PROGRAM)) and not self._there(_PROGRAM_BEFORE):
            self._do(f"copy({str(_PROGRAM)!r}, {_PROGRAM_BEFORE!r})")
            self._say(f"         the {_PROGRAM} that was there is kept as {_PROGRAM_BEFORE}")

    def _sent(self, name: PurePosixPath, data: bytes, flashed: Flashed) -> None:
        flashed.sent.append(name)
        flashed.sent_bytes += len(data)
        self._tell(name, data, "written")

    def _tell(self, name: PurePosixPath, data: bytes, how: str) -> None:
        self._say(f"{len(data):8d}  {name}  {how}")

    def _send(self, path: str, data: bytes) -> None:
        self._later(f"make_folders({path!r})")
        for at in range(0, max(1, len(data)), _CHUNK):
            text = b64encode(data[at : at + _CHUNK]).decode()
            self._later(f"put({path!r}, {text!r}, {'ab' if at else 'wb'!r})")

    def _later(self, command: str) -> None:
        """Run it with others, for asking takes longer than what is done."""
        if sum(map(len, self._waiting)) + len(command) > _COMMAND:
            self._do()
        self._waiting.append(command)

    def _do(self, command: str = "") -> str:
        """Run what waits, then this; what it printed."""
        waiting, self._waiting = [*self._waiting, command], []
        return output_of(self._board, "\n".join(waiting))

    def _there(self, path: str) -> dict[str, tuple[int, int]]:
        """File -> size and CRC-32, of a file or of all below a folder."""
        said = self._do(f"tell({path!r})")
        found = [ast.literal_eval(line) for line in said.splitlines() if line.strip()]
        return {
            name: (size, self._read_back(name) if crc is None else crc) for name, size, crc in found
        }

    def _read_back(self, path: str) -> int:
        return crc32(bytes(self._board.fs_readfile(path)))

    def _check(self, wanted: dict[str, bytes], path: str) -> None:
        there = self._there(path)
        for name, data in wanted.items():
            if there.get(name) != _mark(data):
                raise BoardError(
                    f"{self._port}: {name} did not arrive whole and nothing was replaced; "
                    "flash again, what did arrive is kept"
                )


def _staged(name: PurePosixPath) -> PurePosixPath:
    return PurePosixPath(_STAGE, *name.parts[1:])


def _mark(data: bytes) -> tuple[int, int]:
    return len(data), crc32(data)
