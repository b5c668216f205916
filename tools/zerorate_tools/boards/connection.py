"""A MicroPython board on a serial port, through mpremote's raw REPL."""

from __future__ import annotations

import ast
import errno
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stdout, suppress
from dataclasses import dataclass
from io import StringIO
from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import MissingLibrary, ZerorateError

if TYPE_CHECKING:
    from mpremote.transport_serial import SerialTransport
    from serial import Serial

# A board that is just starting loses the key that stops its program; it is pressed again. Its own
# programs and a busy machine between them may take long to answer.
_PATIENCE_S = (3, 10, 30)
_LONG_S = 120
_QUESTION = """
import gc, os, sys
gc.collect()
i = sys.implementation
s = os.statvfs(".") if hasattr(os, "statvfs") else (0, 0, 0, 0)
print(repr((getattr(i, "_machine", sys.platform), tuple(i.version[:3]), getattr(i, "_mpy", 0),
    gc.mem_free(), s[0] * s[3])))
"""
#: sys.implementation._mpy >> 10, as MicroPython's py/persistentcode.h numbers them.
_ARCHITECTURES = (
    *("", "x86", "x64", "armv6", "armv6m", "armv7m", "armv7em", "armv7emsp", "armv7emdp"),
    *("xtensa", "xtensawin", "rv32imc", "rv64imc"),
)


#: errno -> why a port does not open, and what to do.
_CLOSED: dict[int | None, str] = {
    errno.EACCES: "no permission; sudo usermod -aG dialout $USER, then log in again",
    errno.EPERM: "no permission; sudo usermod -aG dialout $USER, then log in again",
    errno.EBUSY: "another program has it open; close that terminal, Thonny or mpremote",
    errno.EAGAIN: "another program has it open; close that terminal, Thonny or mpremote",
}


class BoardError(ZerorateError):
    """A board that does not answer, or does not do what it was told."""


@contextmanager
def connected(port: str, go_on: bool = True) -> Iterator[SerialTransport]:
    """Yield mpremote's transport with the board in its raw REPL, restarted: its memory is empty.

    Behind it the board is restarted once more and runs its main.py, unless go_on is False.
    Raises MissingLibrary without mpremote and BoardError for a port that cannot be opened or a
    board that says nothing.
    """
    try:
        from mpremote.transport import TransportError, TransportExecError
        from mpremote.transport_serial import SerialTransport
    except ImportError as error:
        raise MissingLibrary("mpremote") from error
    try:
        transport = SerialTransport(port, timeout=2)
    except (TransportError, OSError, ValueError) as error:  # the last: a URL of no known kind
        raise BoardError(_why_closed(port)) from error
    try:
        _stop(transport)
        yield transport
    except TransportExecError as error:
        raise BoardError(f"{port}: {said(error.error_output)}") from error
    except TransportError as error:
        raise BoardError(
            f"{port}: {error}; is MicroPython on this board, and does "
            "its program end at Ctrl-C (no bare `except:`)?"
        ) from error
    finally:
        if go_on:
            _let_run(transport.serial)
        transport.close()


@contextmanager
def listening(port: str) -> Iterator[Serial]:
    """Yield the open serial port with nothing sent to it. Raises MissingLibrary and BoardError."""
    try:
        from serial import Serial
    except ImportError as error:
        raise MissingLibrary("mpremote") from error
    try:
        serial = Serial(port, 115200, timeout=0.2, exclusive=True)
    except (OSError, ValueError) as error:
        raise BoardError(_why_closed(port)) from error
    with serial:
        yield serial


def _stop(transport: SerialTransport) -> None:
    """Stop what runs, and restart the board into its raw REPL. Raises TransportError."""
    from mpremote.transport import TransportError

    for patience_s in _PATIENCE_S:
        try:
            with redirect_stdout(StringIO()):  # where mpremote prints what came instead
                transport.enter_raw_repl(soft_reset=True, timeout_overall=patience_s)
            return
        except TransportError:
            if patience_s == _PATIENCE_S[-1]:
                raise


def _why_closed(port: str) -> str:
    """Why a port cannot be opened, which mpremote does not tell, and what to do."""
    if port == "fake:":
        return "fake: is an emulated chip without a board; name a board's port, as /dev/ttyACM0"
    from serial import Serial

    try:
        Serial(port, exclusive=True).close()
    except (OSError, ValueError) as error:
        if (code := getattr(error, "errno", None)) in _CLOSED:
            return f"{port}: {_CLOSED[code]}"
        what = "is no serial port" if Path(port).exists() else "is not there"
        return f"{port}: {what}; {_plugged_in()}"
    return f"{port}: could not be opened a moment ago; try again"


def _plugged_in() -> str:
    from serial.tools.list_ports import comports

    ports = [port.device for port in comports() if port.vid is not None]
    if not ports:
        return "USB lists no board; has the cable data wires?"
    return f"USB ports here: {', '.join(sorted(ports))}"


def said(traceback: str) -> str:
    """What a program of these tools met on a board, and what to do; at the end there may be the
    prompt of the raw REPL."""
    lines = [line.strip("\x04\r >") for line in traceback.split("\n")]
    last = [line for line in lines if line][-1]
    if last.startswith("MemoryError"):
        return (
            "the board has too little heap free; let its boot.py take less, leave out parts, or "
            "freeze the packages into its image (docs/boards.md)"
        )
    if last.startswith(("OSError: 28", "OSError: [Errno 28]")):  # most boards name no ENOSPC
        return "the board's file system is full; delete files on it: mpremote rm :FILE"
    sends = "; zerorate flash sends it" if "no module named 'zerorate" in last else ""
    return f"the board says: {last}{sends}"


def _let_run(serial: Serial) -> None:
    """Leave the raw REPL and restart, in the keys of a terminal: what runs ends, main.py begins."""
    with suppress(OSError):  # it may have been unplugged
        serial.write(b"\r\x03\x03\r\x02\x04")
        serial.flush()


def output_of(transport: SerialTransport, program: str, patience_s: float | None = None) -> str:
    """What a program that is run to its end on the board prints. Raises its error.

    patience_s: for how long the board may print nothing; two minutes where None.
    """
    from mpremote.transport import TransportExecError

    said, error = transport.exec_raw(program, timeout=patience_s or _LONG_S)
    if error:
        raise TransportExecError(said, error.decode())
    return said.decode()


@dataclass(frozen=True)
class BoardFacts:
    """What was found out.

    mpy: version and sub-version of the .mpy files that it loads, (0, 0) for none; architecture:
    of machine code in them, "" for none; heap_free, disk_free: bytes, disk_free 0 if unknown.
    """

    machine: str = "a board of any kind"
    version: tuple[int, ...] = ()
    mpy: tuple[int, int] = (6, 0)
    architecture: str = ""
    heap_free: int = 0
    disk_free: int = 0

    def __str__(self) -> str:
        if not self.version:
            return self.machine
        version = ".".join(map(str, self.version))
        code = self.architecture or "bytecode alone"
        return f"{self.machine}, MicroPython {version}, .mpy {self.mpy[0]}.{self.mpy[1]}, {code}"


def ask(board: SerialTransport) -> BoardFacts:
    """The facts of a board in its raw REPL."""
    machine, version, mpy, heap_free, disk_free = ast.literal_eval(output_of(board, _QUESTION))
    number = mpy >> 10
    return BoardFacts(
        machine,
        version,
        (mpy & 0xFF, mpy >> 8 & 3),
        _ARCHITECTURES[number] if number < len(_ARCHITECTURES) else "",
        heap_free,
        disk_free,
    )
