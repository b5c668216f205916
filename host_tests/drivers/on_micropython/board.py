"""A board's raw REPL (MicroPython docs, reference/repl.rst) on standard input and output.

The unix port has no raw REPL of its own; with this it is a board to mpremote.
"""

import sys

BANNER = b"raw REPL; CTRL-B to exit\r\n>"
WINDOW = 512
write = sys.stdout.buffer.write


def read():
    """One byte from the host."""
    byte = sys.stdin.buffer.read(1)
    if not byte:
        raise SystemExit
    return byte


def raw_paste():
    """The source that comes window by window."""
    write(b"R\x01" + bytes([WINDOW & 0xFF, WINDOW >> 8]))
    source = bytearray()
    while (byte := read()) != b"\x04":
        source.extend(byte)
        if len(source) % WINDOW == 0:
            write(b"\x01")
    write(b"\x04")
    return bytes(source)


def execute(source, names):
    try:
        exec(source, names)
        write(b"\x04\x04>")
    except BaseException as error:
        write(b"\x04")
        sys.print_exception(error)
        write(b"\x04>")


def serve():
    """Do what the host says, until it is gone."""
    names, source, is_raw = {}, bytearray(), False
    write(b"ready\n")
    while True:
        try:
            byte = read()
            if byte == b"\x01":
                source, is_raw = bytearray(), True
                write(BANNER)
            elif byte == b"\x02":
                is_raw = False
            elif is_raw and byte == b"\x05":
                if read() == b"A" and read() == b"\x01":
                    execute(raw_paste(), names)
            elif is_raw and byte == b"\x04" and source:
                write(b"OK")
                execute(bytes(source), names)
                source = bytearray()
            elif is_raw and byte == b"\x04":  # a soft reset
                names = {}
                write(b"OK\r\nMPY: soft reboot\r\n" + BANNER)
            elif is_raw:
                source.extend(byte)
        except KeyboardInterrupt:
            pass


serve()
