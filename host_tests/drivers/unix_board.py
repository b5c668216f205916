"""MicroPython's unix port behind a pseudo-terminal: a board for mpremote and pyserial."""

import os
import pty
import signal
import subprocess
import threading
import time
import tty
from pathlib import Path

# A signal overtakes the bytes sent after it, as on no board.
_INTERRUPT_S = 0.05
_REPL = Path(__file__).parent / "on_micropython" / "board.py"


class UnixBoard:
    """A running board; port is its serial device, folder its file system.

    modules are folders on its path besides lib. drop(n) takes n bytes out of what it sends next.
    """

    def __init__(self, runtime, folder: Path, modules=()) -> None:
        self.folder = folder
        self._drop = 0
        self._master, slave = pty.openpty()
        tty.setraw(slave)
        self.port = os.ttyname(slave)
        self._slave = slave
        path = ":".join(["lib", *map(str, modules)])
        self._board = subprocess.Popen(
            [*runtime.launcher, str(runtime.executable), "-X", "heapsize=4m", str(_REPL)],
            cwd=folder,
            env={"MICROPYPATH": path, "HOME": str(folder)},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            bufsize=0,
        )
        self._board.stdout.read(len(b"ready\n"))
        for work in (self._to_board, self._from_board):
            threading.Thread(target=work, daemon=True).start()

    def drop(self, count: int) -> None:
        """Lose bytes on the way to the host."""
        self._drop += count

    def close(self) -> None:
        """Unplug."""
        self._board.kill()
        self._board.wait()

    def _to_board(self) -> None:
        while True:
            try:
                data = os.read(self._master, 4096)
            except OSError:
                return
            for at, part in enumerate(data.split(b"\x03")):
                if at:
                    self._board.send_signal(signal.SIGINT)
                    time.sleep(_INTERRUPT_S)
                try:
                    self._board.stdin.write(part)
                except OSError:
                    return

    def _from_board(self) -> None:
        while data := os.read(self._board.stdout.fileno(), 4096):
            lost = min(self._drop, len(data))
            self._drop -= lost
            os.write(self._master, data[lost:])
