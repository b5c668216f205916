"""A board's raw REPL (MicroPython docs, reference/repl.rst) on standard input and output.

The unix port has no raw REPL of its own; with this it is a board to mpremote.
"""

import sys

BANNER = b"raw REPL; CTRL-B to exit\r\n>"
WINDOW = 512


def read():
    """One byte, whatever interrupts."""
    while True:
        try:
            byte = sys.stdin.buffer.read(1)
        except KeyboardInterrupt:
            continue
        if not byte:
            raise SystemExit
        return byte


def write(data):
    sys.stdout.buffer.write(data)


def raw_paste():
    write(b"R\x01" + bytes([WINDOW & 0xFF, WINDOW >> 8]))
    source = bytearray()
    while True:
        byte = read()
        if byte == b"\x04":
            write(b"\x04")
            return bytes(source)
        source.extend(byte)
        if len(source) % WINDOW == 0:
            write(b"\x01")


def execute(source, names):
    try:
        exec(source, names)
        write(b"\x04\x04>")
    except BaseException as error:
        write(b"\x04")
        sys.print_exception(error)
        write(b"\x04>")


class Repl:
    """The raw REPL's state between bytes."""

    def __init__(self):
        self.names = {}
        self.source = bytearray()
        self.raw = False

    def take(self, byte):
        """One byte from the host."""
        if byte == b"\x01":
            self.raw = True
            self.source = bytearray()
            write(BANNER)
        elif byte == b"\x02":
            self.raw = False
        elif self.raw and byte == b"\x05":
            if read() == b"A" and read() == b"\x01":
                execute(raw_paste(), self.names)
        elif self.raw and byte == b"\x04":
            self.run()
        elif self.raw:
            self.source.extend(byte)

    def run(self):
        """What was sent; nothing is a soft reset."""
        source = bytes(self.source)
        self.source = bytearray()
        if source:
            write(b"OK")
            execute(source, self.names)
        else:
            self.names = {}
            write(b"OK\r\nMPY: soft reboot\r\n" + BANNER)


repl = Repl()
begun = False
while True:
    try:
        if not begun:
            begun = True
            write(b"ready\n")
        repl.take(read())
    except KeyboardInterrupt:
        pass
