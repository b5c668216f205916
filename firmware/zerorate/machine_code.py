"""Which kernels run: machine code where it is right, else bytecode; native/ asks."""

import gc
import sys

# part -> what runs it and why, for Corrector.explain
chosen = {}  # type: ignore[var-annotated]


def machine_code(part):
    """The part's machine code, run(a, b, c, what), or None where bytecode is to be used.

    a, b, c: arrays, addresses of such, or ints; what: an int or an array.
    """
    # what MicroPython calls its processor: 3 to 8 are Cortex-M, 11 is RV32
    processor = getattr(sys.implementation, "_mpy", 0) >> 10 & 15
    kind = "thumb" if 3 <= processor <= 8 else "rv32"
    if kind == "rv32" and processor != 11:
        if sys.implementation.name == "micropython":  # on a host there is nothing to choose
            chosen[part] = "bytecode: there is no machine code for this processor"
        return None
    if chosen:  # the first finds an empty heap; each wants up to 10 KB of it in one piece
        gc.collect()
    from .trying import tried

    code, chosen[part] = tried(part, kind)
    unload("zerorate.native", kind + "_" + part)
    unload("zerorate", "trying")
    return code


def unload(package, name):
    """On a board let the module `name` of `package` go; it is loaded again when imported again."""
    if sys.implementation.name == "micropython":
        sys.modules.pop(package + "." + name, None)
        sys.modules[package].__dict__.pop(name, None)
