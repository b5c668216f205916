"""The C yardstick as a program: its text, how it is compiled, how it is run.

Usage: `yardstick COUNT CALL AT_ONCE [TIMES]` in a folder with settings.bin, state.bin and
frames.bin (int32 each; a frame is dt_us and seven words). It takes the first COUNT frames, AT_ONCE
in one call, with CALL 0 without calling the kernels, and writes state.out and frames.out (verdict
and seven words each).
"""

from __future__ import annotations

import importlib.util
import shutil
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path

from ..errors import MissingRuntime, ZerorateError
from ..runtimes.runtime import Job, Runtime
from ..runtimes.unix_port import qemu_arm
from .c_kernels import kernels_in_c

TARGETS = {"x86": "x86-linux-musl", "armhf": "arm-linux-musleabihf", "host": ""}
_FLAGS = ("-O2", "-fwrapv", "-fno-sanitize=undefined")
# the instruction sets that Debian's interpreters are built for
_MACHINES = {"x86": ("-static", "-mcpu=i686"), "armhf": ("-static", "-mthumb")}
_MAIN = """
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static size_t words;

static int32_t *whole(const char *name) {
    FILE *file = fopen(name, "rb");
    if (!file) exit(2);
    fseek(file, 0, SEEK_END);
    words = (size_t)ftell(file) / 4;
    rewind(file);
    int32_t *content = malloc(words * 4);
    if (!content || fread(content, 4, words, file) != words) exit(2);
    fclose(file);
    return content;
}

static void keep(const char *name, const int32_t *content, size_t count) {
    FILE *file = fopen(name, "wb");
    if (!file || fwrite(content, 4, count, file) != count || fclose(file)) exit(2);
}

int main(int argc, char **argv) {
    int32_t *c = whole("settings.bin");
    int32_t *s = whole("state.bin");
    size_t state_words = words;
    int32_t *frames = whole("frames.bin");
    size_t count = argc > 2 ? (size_t)atoi(argv[1]) : 0;
    int call = argc > 2 && atoi(argv[2]);
    size_t at_once = argc > 3 ? (size_t)atoi(argv[3]) : 1;
    int times = argc > 4 ? atoi(argv[4]) : 1;
    int32_t x[9];
    if (count > words / 8) exit(2);
    int32_t *first_state = malloc(state_words * 4);
    int32_t *first_frames = malloc(words * 4);
    if (!first_state || !first_frames) exit(2);
    memcpy(first_state, s, state_words * 4);
    memcpy(first_frames, frames, words * 4);
again:
    for (size_t i = 0; at_once > 1 && i < count; i += at_once) {
        int32_t most = (int32_t)(count - i < at_once ? count - i : at_once);
        if (call) block_block(s, frames + 8 * i, c, x, most);
    }
    for (size_t i = 0; at_once == 1 && i < count; i++) {
        int32_t *frame = frames + 8 * i;
        memcpy(x, frame + 1, 7 * sizeof *x);
        if (call) frame[0] = step_step(s, c, x, frame[0]);
        memcpy(frame + 1, x, 7 * sizeof *x);
    }
    if (--times > 0) {
        memcpy(s, first_state, state_words * 4);
        memcpy(frames, first_frames, words * 4);
        goto again;
    }
    keep("state.out", s, state_words);
    keep("frames.out", frames, words);
    return 0;
}
"""


def program_in_c(package: Path) -> str:
    """The whole program for the firmware in the folder `package`."""
    return kernels_in_c(package, ("step", "step"), ("block", "block")) + _MAIN


class CProgram(Runtime):
    """A compiled yardstick, run as an interpreter is; the script is not looked at."""

    viper = False

    def __init__(self, program: Path, target: str) -> None:
        self.name = f"C on {target}"
        self._command = [qemu_arm(), str(program)] if target == "armhf" else [str(program)]

    def command(self, job: Job) -> list[str]:
        return [*self._command, *job.args]


def compiled(source: Path, program: Path, target: str) -> CProgram:
    """Compile `source` for host, x86 or armhf. Raises MissingRuntime, or ZerorateError."""
    command = _compiler(target)
    flags = [*_FLAGS, *_MACHINES.get(target, ())]
    done = subprocess.run(
        [*command, *flags, str(source), "-o", str(program)], capture_output=True, text=True
    )
    if done.returncode:
        raise ZerorateError(f"the C yardstick does not compile for {target}: {done.stderr[:400]}")
    return CProgram(program, target)


def _compiler(target: str) -> list[str]:
    if target == "host" and (found := shutil.which("cc")):
        return [found]
    if importlib.util.find_spec("ziglang") is None:
        raise MissingRuntime(f"no C compiler for {target} here; `pip install ziglang` is one")
    command = [sys.executable, "-m", "ziglang", "cc"]
    return [*command, "-target", TARGETS[target]] if TARGETS[target] else command


def main(arguments: Sequence[str]) -> int:
    """Write the program's text to a file."""
    package = Path(importlib.util.find_spec("zerorate").origin).parent  # type: ignore
    Path(arguments[0]).write_text(program_in_c(package), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
