"""An emulated Raspberry Pi Pico with stock MicroPython, and an MPU-6050 on its I2C bus.

The processor is npm's rp2040js, which `zerorate runtimes get rp2040` fetches; MicroPython's own
image and the chip's boot ROM come from the folder named by the environment variable
ZERORATE_BOARDS. Without them find_pico raises MissingRuntime.
"""

from __future__ import annotations

import base64
import errno
import json
import os
import pty
import select
import signal
import socket
import subprocess
import threading
import tty
from array import array
from collections.abc import Sequence
from dataclasses import dataclass, field
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from zerorate import Corrector, Sensor
from zerorate.bursts import Bursts
from zerorate.model import EffectModel
from zerorate_tools.boards.connection import connected, output_of
from zerorate_tools.errors import MissingRuntime
from zerorate_tools.runtimes.node import install, locked_version, node_command
from zerorate_tools.runtimes.runtime import runtime_folder

from ..workload import REST

_HERE = Path(__file__).parent / "rp2040"
_PACKAGE = "rp2040js"
VARIABLE = "ZERORATE_BOARDS"
#: The clock that the emulated core runs at.
CORE_HZ = 125_000_000
SENSOR = (100.0, 131.0, 16384.0, 340.0, 36.53)
_MARKS = 3
_PATIENCE_S = 600


@dataclass(frozen=True)
class PicoParts:
    """What an emulated Pico is made of: files."""

    package: Path
    bootrom: Path
    firmware: Path


def boards_folder() -> Path:
    """The folder of boards' firmware. Raises MissingRuntime."""
    named = os.environ.get(VARIABLE)
    if not named:
        raise MissingRuntime(f"{VARIABLE} names no folder with boards' firmware")
    if not Path(named).is_dir():
        raise MissingRuntime(f"{VARIABLE} names {named}, which is no folder")
    return Path(named)


def find_pico(firmware: str = "RPI_PICO-*.bin") -> PicoParts:
    """The parts of an emulated Pico; firmware: a pattern of names. Raises MissingRuntime."""
    boards = boards_folder()
    images = sorted((boards / "firmware").glob(firmware))
    bootrom = boards / "emulator" / "bootrom.mjs"
    for what, there in ((f"firmware/{firmware}", images), (str(bootrom), bootrom.is_file())):
        if not there:
            raise MissingRuntime(f"{boards} holds no {what}")
    package = _folder() / "node_modules" / _PACKAGE
    if not package.is_dir():
        raise MissingRuntime(
            "the RP2040 emulator is not fetched yet; `zerorate runtimes get rp2040` fetches it"
        )
    return PicoParts(package, bootrom, images[-1])


def fetch_rp2040() -> None:
    """Install the emulator that package-lock.json pins. Raises MissingRuntime."""
    install(_HERE, _folder(), _PACKAGE)


def _folder() -> Path:
    return runtime_folder(f"rp2040-{locked_version(_HERE, _PACKAGE)}")


class EmulatedPico:
    """A running Pico; `port` is its serial device, which anything that takes one can open.

    bias_lsb: of the gyroscope of the chip on its bus, which rests. link: a path that becomes a
    symbolic link to the port.
    """

    def __init__(
        self, parts: PicoParts, bias_lsb: Sequence[int] = (40, -25, 10), link: Path | None = None
    ) -> None:
        self._master, slave = pty.openpty()
        tty.setraw(slave)
        self.port = os.ttyname(slave)
        os.close(slave)
        if link is not None:
            link.symlink_to(self.port)
            self.port = str(link)
        ours, theirs = socket.socketpair()
        self._control = ours.makefile("rw", encoding="utf-8")
        ours.close()
        options = {
            "rp2040js": str(parts.package / "dist" / "esm" / "index.js"),
            "bootrom": str(parts.bootrom),
            "firmware": str(parts.firmware),
            "bias": [*bias_lsb],
            "control": theirs.fileno(),
        }
        program = ["--max-semi-space-size=32", str(_HERE / "pico.mjs"), json.dumps(options)]
        self._process = subprocess.Popen(
            [*node_command(), *program],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            bufsize=0,
            pass_fds=[theirs.fileno()],
        )
        theirs.close()
        self._closed = threading.Event()
        for work in (self._to_board, self._from_board):
            threading.Thread(target=work, daemon=True).start()

    def __enter__(self) -> EmulatedPico:
        return self

    def __exit__(self, *exc: object) -> None:
        self.close()

    def close(self) -> None:
        """Take it away: its port then fails."""
        self._closed.set()
        self._process.kill()
        self._process.wait()
        self._control.close()

    def pause(self) -> None:
        """Let it stand still and take no processor, until resume()."""
        self._process.send_signal(signal.SIGSTOP)

    def resume(self) -> None:
        """Let it go on."""
        self._process.send_signal(signal.SIGCONT)

    def ask(self, command: str, **arguments: Any) -> Any:
        """What the emulator answers to a command of pico.mjs."""
        self._control.write(json.dumps({"do": command, **arguments}) + "\n")
        self._control.flush()
        return json.loads(self._control.readline())

    def cut_power_after(self, operations: int) -> None:
        """Cut the power in the middle of a flash operation, after so many whole ones."""
        self.ask("cut", after=operations)

    def give(self, data: bytes) -> None:
        """Let programs on the board take data through the window."""
        self.ask("deck", bytes=base64.b64encode(data).decode())

    def taken(self) -> bytes:
        """What programs on the board have put through the window since the last call."""
        return base64.b64decode(self.ask("pile"))

    def _to_board(self) -> None:
        assert self._process.stdin is not None
        while not self._closed.is_set():
            try:
                data = os.read(self._master, 4096)
                self._process.stdin.write(data)
            except OSError as error:
                if error.errno != errno.EIO:  # which says that nobody has the port open
                    return
                self._closed.wait(0.02)  # time.sleep may be a test's own clock

    def _from_board(self) -> None:
        assert self._process.stdout is not None
        poll = select.poll()
        poll.register(self._master, select.POLLHUP)
        while data := self._process.stdout.read(4096):
            if not poll.poll(0):  # else nobody listens, and a board drops what it says
                os.write(self._master, data)


@dataclass(frozen=True)
class Play:
    """What is run: rows (n, 8) of dt_us and seven words, through a corrector of these options.

    state: what the corrector begins with, its own where None; its settings are always its own.
    at_once: samples a call, 0 for the kernels without the object; model: bytes of an effect model
    that is refined as well.
    """

    rows: NDArray[np.int32]
    options: dict[str, Any] = field(default_factory=REST.copy)
    sensor: tuple[float, ...] = SENSOR
    state: NDArray[np.int32] | None = None
    at_once: int = 1
    model: bytes = b""

    def corrector(self) -> Corrector:
        """A corrector as the play begins with."""
        made = Corrector(Sensor(*self.sensor), **self.options)
        if self.state is not None:
            made.state[:] = array("i", self.state.tolist())
        return made


@dataclass(frozen=True)
class Played:
    """How it ended: bytes of the frames, the settings and the states, and cycles of each call."""

    data: bytes
    cycles: tuple[int, ...] = ()


def on_pico(pico: EmulatedPico, play: Play) -> Played:
    """Run it on a Pico that has the packages. Raises BoardError and mpremote's errors."""
    pico.give(play.corrector().state.tobytes() + play.rows.astype("<i4").tobytes())
    pico.ask("spans")
    pico.taken()
    p = play
    call = f"run({p.options!r}, {p.sensor!r}, {len(p.rows)}, {p.at_once}, {p.model!r})\n"
    text = files(__package__).joinpath("on_pico.py").read_text(encoding="utf-8")
    with connected(pico.port) as board:
        output_of(board, text + call, patience_s=_PATIENCE_S)
    spans = pico.ask("spans")
    own = min(spans[:_MARKS])
    return Played(pico.taken(), tuple(span - own for span in spans[_MARKS:]))


def on_host(play: Play) -> Played:
    """The same here, by CPython."""
    corrector = play.corrector()
    if play.model:
        effects = EffectModel()
        effects.load(play.model, corrector.sensor)
        effects.refine()
        corrector.use_model(effects)
    left, rows, size = array("i"), play.rows.astype(np.int32), play.at_once
    if size > 1:
        take = Bursts(corrector).update
        for at in range(0, len(rows) - size + 1, size):
            frames = array("i", rows[at : at + size].tobytes())
            take(frames, size)
            left.extend(frames)
    else:
        for row in rows:
            sample = array("i", row[1:].tobytes())
            corrector.update(sample, int(row[0]))
            left.extend(sample)
    c = corrector
    for words in (c.settings, c.motion_settings, c.gravity_settings, c.motion, c.gravity, c.state):
        if words is not None:
            left.extend(words)
    return Played(left.tobytes())
