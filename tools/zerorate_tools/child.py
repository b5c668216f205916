"""The command of a Python child that runs no code from the folder one stands in."""

import os
import sys

# -I leaves out the working folder and PYTHONPATH; the parent's own paths come as an argument.
_BEGIN = "import os, sys; sys.path[:] = sys.argv.pop().split(os.pathsep); "


def python_child(code: str, *arguments: str) -> list[str]:
    """The command that runs code, which sees the arguments from sys.argv[1] on."""
    paths = os.pathsep.join(filter(None, sys.path))
    return [sys.executable, "-I", "-c", _BEGIN + code, *arguments, paths]
