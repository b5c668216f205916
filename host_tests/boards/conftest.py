"""An emulated Pico with the firmware flashed, and its console."""

import time

import pytest
import serial
from zerorate_bench.boards.pico import EmulatedPico
from zerorate_tools.boards.flashing import flash

# The board's own seconds are a fraction of these where the machine is free.
PATIENCE_S = 240


class Console:
    """Lines that the board prints, and keys to it."""

    def __init__(self, port):
        self._serial = serial.Serial(port, timeout=0.2)
        self._rest = b""
        self.said = []

    def close(self):
        self._serial.close()

    def press(self, keys):
        """Send bytes as a terminal does."""
        self._serial.write(keys)

    def lines(self):
        """Whole lines, for as long as the board prints any in time."""
        until = time.monotonic() + PATIENCE_S
        while time.monotonic() < until:
            *whole, self._rest = (self._rest + self._serial.read(4096)).split(b"\n")
            for line in whole:
                self.said.append(line.decode(errors="replace").strip())
                yield self.said[-1]
        raise AssertionError(f"after {self.said} the board said no more than {self._rest!r}")

    def line_with(self, word):
        """The next line in which the word is."""
        return next(line for line in self.lines() if word in line)


@pytest.fixture(scope="session")
def flashed_pico(pico_parts, tmp_path_factory):
    """A Pico that was flashed with the rest path; port: a symbolic link to its serial device."""
    link = tmp_path_factory.mktemp("run") / "tty-a"
    with EmulatedPico(pico_parts, link=link) as board:
        board.flashed = flash(board.port, say=lambda line: None)
        yield board


@pytest.fixture(scope="module")
def pico(flashed_pico):
    """The same, which runs for this module alone: an idle board takes a whole processor."""
    flashed_pico.resume()
    yield flashed_pico
    flashed_pico.pause()
