"""The driver and the fakes run on MicroPython, and a read takes nothing from its heap."""

import re
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SCRIPTS = Path(__file__).parent / "on_micropython"
MODULES = [ROOT / "drivers", ROOT / "host_tests" / "fakes"]
HOT = {
    "mpu6050.py": "read read_sample verify doubt check _is_configured _is_kept",
    "data_registers.py": "read read_sample _is_suspect _is_one_word_repeated _has_leapt "
    "_read_again",
    "registers.py": "decode read_register read_into _transfer",
    "fifo.py": "read _load _count _count_bytes _take _transfer _align _deliver _is_doubtful",
    "data_ready.py": "_on_edge take",
}
STATE_WORDS = 11
WORDS_A_HANDLER = 3


def run(runtime, script):
    return runtime.run(SCRIPTS / script, modules=MODULES, check=True).stdout.strip()


def test_a_recording_with_faults_reads_as_on_cpython(micropython, find_runtime):
    script = "read_whole_recording.py"
    assert run(micropython, script) == run(find_runtime("cpython"), script)


def test_two_thousand_reads_under_heap_lock(micropython):
    assert run(micropython, "read_without_heap.py") == "39 True 0"


def test_a_thousand_frames_of_the_fifo_under_heap_lock(micropython):
    assert run(micropython, "fifo_without_heap.py") == "1000 True 0 4"


def test_two_thousand_interrupts_under_heap_lock(micropython):
    assert run(micropython, "data_ready_without_heap.py") == "1000 1000"


def frames(x86, source):
    """{function: words of its frame} as the x86 interpreter's compiler prints them."""
    command = [*x86.launcher, str(x86.executable), "-v", "-v", "-v", str(source)]
    printed = subprocess.run(command, capture_output=True, text=True, check=False).stdout
    block = r"code block '(\w+)'.*?\(N_STATE (\d+)\)\n\(N_EXC_STACK (\d+)\)"
    found = re.findall(block, printed, re.DOTALL)
    return {name: int(state) + WORDS_A_HANDLER * int(handlers) for name, state, handlers in found}


@pytest.mark.parametrize("module", sorted(HOT))
def test_no_frame_of_the_hot_path_goes_to_the_heap(find_runtime, module):
    words = frames(find_runtime("x86"), ROOT / "drivers" / "zerorate_i2c" / module)
    assert {name: words[name] for name in HOT[module].split() if words[name] > STATE_WORDS} == {}
