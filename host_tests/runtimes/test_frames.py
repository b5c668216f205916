"""Bytecode frames: a hot function's must stay on the C stack, or every call takes a heap block."""

import re
import subprocess
from pathlib import Path

import pytest
from zerorate_tools.errors import ZerorateError
from zerorate_tools.kernels.reading import KernelFile, kernel_files
from zerorate_tools.runtimes.runtime import UnixPort

from .kernel_rules import remarks

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


# What the user's object runs at every sample, outside the kernels.
HOT_METHODS = {
    "corrector.py": ("update",),
    "others.py": ("update", "_sense_effects", "_ask_others", "_consider"),
    "bursts.py": ("update", "_one_by_one", "_update_at"),
    "model.py": ("channel",),
}
# Run as machine code only: bursts.py takes its samples one by one elsewhere.
NEVER_BYTECODE = {"block.py"}


@pytest.fixture(scope="module")
def x86(find_runtime):
    return find_runtime("x86")


def adder(terms):
    names = [f"x{i}" for i in range(terms)]
    return f"def add({', '.join(names)}):\n    return {' + '.join(names)}\n"


def test_locals_and_temporaries_are_counted(x86, tmp_path):
    source = tmp_path / "add.py"
    source.write_text(adder(9))
    assert frame_words(x86, source)["add"] == 9 + 2


def test_a_handler_costs_three_words(x86, tmp_path):
    source = tmp_path / "guarded.py"
    text = "def {}(a):\n    {}\n        return a\n    {}\n        return a\n"
    source.write_text(text.format("plain", "if a:", "else:"))
    plain = frame_words(x86, source)["plain"]
    source.write_text(text.format("guarded", "try:", "finally:"))
    assert frame_words(x86, source)["guarded"] >= plain + 3


@pytest.mark.parametrize(("terms", "fate"), [(9, "kept"), (10, "collected")])
def test_a_frame_above_the_limit_takes_heap_at_every_call(x86, tmp_path, terms, fate):
    source = tmp_path / "add.py"
    source.write_text(adder(terms))
    assert (frame_words(x86, source)["add"] > WORDS_ON_STACK) == (fate == "collected")
    # What is taken is given back on return: only the collection that it brings on can be seen.
    script = f"""
import gc
from add import add
gc.collect()
bytearray(20000)
gc.threshold(30000)
before = gc.mem_alloc()
for i in range(2000):
    add({", ".join("1" * terms)})
print("kept" if gc.mem_alloc() > before - 10000 else "collected")
"""
    assert x86.run(script, modules=[tmp_path], check=True).stdout.strip() == fate


def test_a_file_that_does_not_compile_is_named(x86, tmp_path):
    source = tmp_path / "broken.py"
    source.write_text("def (:\n")
    with pytest.raises(ZerorateError, match="broken.py does not compile on x86"):
        frame_words(x86, source)


def test_every_hot_function_of_every_kernel_keeps_its_frame_on_the_stack(x86, repository):
    files = kernel_files(repository / "firmware" / "zerorate")
    files = [file for file in files if file.name not in NEVER_BYTECODE]
    frames = {}
    for file in files:
        words = frame_words(x86, file)
        frames |= {f"{file.name} {name}": words[name] for name in KernelFile(file).kernels}
    assert len(frames) > len(files) > 0
    assert {name: words for name, words in frames.items() if words > WORDS_ON_STACK} == {}


def test_a_parameter_becomes_something_else_only_where_the_frame_is_full(x86, repository):
    full = 0
    for file in kernel_files(repository / "firmware" / "zerorate"):
        lines, words = file.read_text().splitlines(), frame_words(x86, file)
        for name, function in KernelFile(file).kernels.items():
            if remarks(function, lines):
                assert words[name] == WORDS_ON_STACK, f"{file.name} {name}"
                full += 1
    assert full


@pytest.mark.parametrize("name", HOT_METHODS)
def test_every_method_of_an_update_keeps_its_frame_on_the_stack(x86, repository, name):
    words = frame_words(x86, repository / "firmware" / "zerorate" / name)
    assert {m: words[m] for m in HOT_METHODS[name] if words[m] > WORDS_ON_STACK} == {}
