"""How much memory the firmware takes."""

import re

from zerorate import Corrector
from zerorate_bench.memory import import_heap_bytes

from .tolerances import IMPORT_BYTES, STATE_BYTES


def test_the_state_of_three_axes_stays_within_its_limit(capsys):
    size = len(Corrector().state) * 4
    with capsys.disabled():
        print(f"\nstate of three axes: {size} bytes")
    assert 0 < size <= STATE_BYTES


def test_importing_the_firmware_takes_no_more_heap_than_it_may(find_runtime, repository, capsys):
    find_runtime("wasm")
    taken = import_heap_bytes(repository / "firmware")
    source = (repository / "firmware" / "zerorate" / "corrector.py").read_text()
    held = int(re.search(r"^_held = \[bytearray\((\d+)\)\]$", source, re.MULTILINE)[1])
    with capsys.disabled():
        print(f"\nheap of `import zerorate` on wasm: {taken} bytes, {held} of them held")
    assert 8192 < taken - held <= IMPORT_BYTES
