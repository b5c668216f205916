"""The driver and the fakes run on MicroPython, and a read takes nothing from its heap."""

from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
SCRIPTS = Path(__file__).parent / "on_micropython"
MODULES = [ROOT / "drivers", ROOT / "host_tests" / "fakes"]


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
