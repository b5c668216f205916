"""A MicroPython board on a serial port, through mpremote's raw REPL."""

from collections.abc import Iterator
from contextlib import contextmanager

from ..errors import MissingLibrary, ZerorateError

# A board's own programs and a busy machine between them may take long to answer.
_PATIENCE_S = 30
_LONG_S = 120


class BoardError(ZerorateError):
    """A board that does not answer, or does not do what it was told."""


@contextmanager
def connected(port: str) -> Iterator:
    """Yield mpremote's transport with the board in its raw REPL, restarted: its memory is empty.

    Raises MissingLibrary without mpremote and BoardError for a port that cannot be opened or a
    board that says nothing.
    """
    try:
        from mpremote.transport import TransportError
        from mpremote.transport_serial import SerialTransport
    except ImportError as error:
        raise MissingLibrary("mpremote") from error
    try:
        transport = SerialTransport(port, timeout=2)
    except TransportError as error:
        raise BoardError(f"{port}: cannot be opened; is the board plugged in?") from error
    try:
        transport.enter_raw_repl(soft_reset=True, timeout_overall=_PATIENCE_S)
        yield transport
    except TransportError as error:
        raise BoardError(f"{port}: {error}; is MicroPython on this board?") from error
    finally:
        transport.close()


def told(transport, program: str, patience_s: float | None = None) -> str:
    """What a program that is run to its end on the board prints. Raises its error.

    patience_s: for how long the board may print nothing.
    """
    from mpremote.transport import TransportExecError

    said, error = transport.exec_raw(program, timeout=patience_s or _LONG_S)
    if error:
        raise TransportExecError(said, error.decode())
    return said.decode()
