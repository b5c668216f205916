"""Decides between a part's machine code and its bytecode."""

import sys

from ..unloading import unload

# what MicroPython calls its processor -> which code runs there (sys.implementation._mpy)
_CODE = {3: "thumb", 4: "thumb", 5: "thumb", 6: "thumb", 7: "thumb", 8: "thumb", 11: "rv32"}

# part -> its machine code, and what runs it and why, for Corrector.explain
code = {}  # type: ignore[var-annotated]
chosen = {}  # type: ignore[var-annotated]


def machine_code(part):
    """The part's machine code, run(a, b, c, what), or None where bytecode is to be used.

    a, b, c: arrays or ints; what: an int or an array.
    """
    kind = _CODE.get(getattr(sys.implementation, "_mpy", 0) >> 10 & 15)
    code[part] = None
    chosen[part] = "bytecode: there is no machine code for this processor"
    if kind:
        from .trying import tried

        code[part], chosen[part] = tried(part, kind)
        unload("zerorate.native", "trying")
    return code[part]
