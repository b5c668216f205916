"""Tries a part's machine code on a known answer before it is used."""

# by their names with u MicroPython does not look for them on its file system first: 4 ms each
try:
    from uarray import array
except ImportError:
    from array import array
try:
    from ubinascii import crc32
except ImportError:
    crc32 = None  # type: ignore[assignment]

# a board without the decorator would stop dead at such a file, so that it must be asked before
_TRIED = "import micropython\n@micropython.asm_%s\ndef f():\n    data(2, 1)\n"


def tried(part, kind):
    """(the part's code of that kind, run(a, b, c, what), or None, and what `chosen` is to say)."""
    # Such code is right only if it does to known arrays what the kernels did when it was made.
    try:
        exec(_TRIED % kind, {})
        name = "zerorate.native." + kind + "_" + part
        file = __import__(name, None, None, ("run",))
    except (SyntaxError, NameError):
        return None, "bytecode: this interpreter takes no machine code"
    except (ImportError, ValueError):
        return None, "bytecode: its machine code is not here, or is another board's"
    if answer(file.run, file.KNOWN) != file.ANSWER:
        return None, "bytecode: its machine code gives wrong numbers here"
    return file.run, "machine code"


def answer(run, known):
    """CRC-32, four bytes, of what calls of `run` leave in arrays that begin as `known` says.

    known: how often, `what`, how many words of the third array are made anew for each call and how
    many bits they have, then the arrays: number of words, index and value of those that are not 0,
    first of those that fit 16 bits.
    """
    a = _array(known[4])
    b = _array(known[5])
    c = _array(known[6])
    what = known[1]
    number = 1
    for _ in range(known[0]):
        for i in range(known[2]):
            number = (number * 75 + 74) % 65537
            c[i] += (number >> 16 - known[3]) - (c[i] >> 1)
        run(a, b, c, what)
    left = bytes(a) + bytes(c)
    if crc32 is not None:
        return (crc32(left) & 0xFFFFFFFF).to_bytes(4, "little")
    from .storage.plain_crc32 import plain_crc32

    crc = bytearray(4)
    plain_crc32(left, crc)
    return bytes(crc)


def _array(known):
    found = array("i", [0] * known[0])
    for pairs in array("h", known[1]), array("i", known[2]):
        for i in range(0, len(pairs), 2):
            found[pairs[i]] = pairs[i + 1]
    return found
