"""How large the frames of a file's functions are, as MicroPython's own compiler prints them.

A bytecode frame of more than 11 words (py/vm.c, VM_MAX_STATE_ON_STACK) takes a heap block at every
call, which neither heap_lock nor gc.mem_alloc() before and after can see.
"""

import re
import subprocess
from pathlib import Path

from zerorate_tools.errors import ZerorateError
from zerorate_tools.runtimes.native import UnixPort

#: Words that a frame may have before it goes to the heap.
WORDS_ON_STACK = 11

_WORDS_PER_HANDLER = 3
_BLOCK = re.compile(r"code block '(.+?)'.*?\(N_STATE (\d+)\)\n\(N_EXC_STACK (\d+)\)", re.DOTALL)


def frame_words(runtime: UnixPort, source: Path) -> dict[str, int]:
    """Words of each function's bytecode frame, by the function's plain name.

    Of functions with the same name (methods of two classes) the largest frame counts.
    Raises ZerorateError when the file does not compile.
    """
    compile_only = ["-X", "compile-only", "-v", "-v", "-v", str(source)]
    command = [*runtime.launcher, str(runtime.executable), *compile_only]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        said = done.stderr.strip().splitlines() or ["no message"]
        raise ZerorateError(f"{source} does not compile on {runtime.name}: {said[-1]}")
    words: dict[str, int] = {}
    for name, state, handlers in _BLOCK.findall(done.stdout):
        size = int(state) + _WORDS_PER_HANDLER * int(handlers)
        words[name] = max(size, words.get(name, 0))
    return words
