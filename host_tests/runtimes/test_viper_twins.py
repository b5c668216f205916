"""The viper twins: made from the kernel files, committed fresh, and equal in what they do."""

import pytest
from zerorate_tools.viper_twins import BadKernel, Twins, hot_functions, kernel_files, stale, write

# Every shape that is said otherwise in a twin: see zerorate_tools/twins.
SHAPES = '''

def first_above(s: ptr32, n: int, least: int) -> int:
    i = 0
    while i < n:
        j = i
        while j < n:
            if s[j] > least:
                return j
            j += 7
        i += 1
    return 0 - 1


def count_up(s: ptr32, by: int) -> int:
    s[0] += by
    if s[0] & 1:
        if by == 3:
            return s[0]
        s[1] ^= s[0]
    return s[0] + by


def clamped(value: int, most: int) -> int:
    if value > most:
        return most
    if value < 0 - most:
        value = 0 - most
    return value


def three(s: ptr32, at: int) -> int:
    i = 0
    total = 0
    while i < 3:
        if i != 1:
            total += s[at + i] * (i + 1)
        s[at + i] -= i
        i += 1
    s[at + i] = total & 1023
    return total


def shapes(s: ptr32, n: int) -> int:
    """Calls in every place."""
    total = s[0] + count_up(s, 3)
    total += clamped(total, 500) - clamped(s[3], 40) + s[1]
    if n > 2 and first_above(s, 40, 900) > 3:
        total += 5
    if n > 3 or count_up(s, 2) > 4:
        total ^= three(s, 4)
    else:
        total -= three(s, n)
    while clamped(total, 99) == 99:
        total -= 1000
    if three(s, n + 1) < 0 and count_up(s, 5) & 1 == 0:
        return first_above(s, 30, total)
    s[total & 7] += clamped(s[9], n)
    for i in range(3):
        if i * s[i] >= 0:
            total += i
    return clamped(total, 1000) if s[2] != s[3] else count_up(s, 1)


def twice(s: ptr32, n: int) -> int:
    """A kernel of more than one call site."""
    n = shapes(s, n & 7)
    return n + shapes(s, 2)
'''

KERNEL = '''"""What it does."""

try:
    from micropython import const
except ImportError:

    def const(value):
        return value


def ptr32(array):
    return array


_STEP = const(3)


def gather(s: ptr32, c: ptr32, n: int) -> int:
    total = 0
    for i in range(n):
        s[i] = (s[i] * _STEP - c[i]) >> 2
        total += s[i] if s[i] < 100 else s[i] // 7
    return total


def pass_on(s, c, n: int) -> int:
    p = ptr32(s)
    p[0] += 1
    return int(gather(s, c, n)) ^ (p[1] & 255)


def outer(s: ptr32, c: ptr32, n: int) -> int:
    """A kernel that calls kernels."""
    s[2] += gather(s, c, n) & 1
    gather(s, c, n)
    if gather(s, c, n - 1) > gather(s, c, pass_on(s, c, 1) & 3):
        return s[1]
    return gather(s, c, n) - 1


def in_the_open(s):
    return len(s)
'''

DRIVE = """
from array import array
from {package} import kernel
s = array("i", [(k * 7919) % 20011 - 10000 for k in range(40)])
c = array("i", [(k * 104729) % 4001 - 2000 for k in range(40)])
print([kernel.pass_on(s, c, 40) for k in range(6)], kernel.in_the_open(s), list(s))
print([kernel.outer(s, c, 40) for k in range(6)], list(s))
"""

DRIVE_SHAPES = """
from array import array
from {package} import shapes
for seed in range(60):
    s = array("i", [((k + seed) * 7919) % (20011 >> seed % 5) - 1000 for k in range(64)])
    print([shapes.twice(s, k) for k in range(12)], list(s))
"""

UNDER_LOCK = """
import gc, micropython
from array import array
from pack.viper import kernel
s, c = array("i", [5] * 40), array("i", [3] * 40)
def drive():
    for i in range(20):
        kernel.outer(s, c, 40)
drive()
micropython.heap_lock()
drive()
micropython.heap_unlock()
print("nothing taken")
"""


def twin(package):
    return Twins(kernel_files(package)).text(package / "kernel.py")


@pytest.fixture
def package(tmp_path):
    folder = tmp_path / "pack"
    folder.mkdir()
    (folder / "__init__.py").write_text("")
    (folder / "kernel.py").write_text(KERNEL)
    (folder / "object.py").write_text(
        "class Whole:\n    def use(self, n: int):\n        return kernel.pass_on, shapes.three\n"
    )
    return folder


def test_only_files_with_pointer_parameters_are_kernels(package):
    assert [path.name for path in kernel_files(package)] == ["kernel.py"]


def test_annotated_functions_are_hot(package):
    assert hot_functions(package / "kernel.py") == ["gather", "pass_on", "outer"]


def test_every_annotated_function_and_no_other_is_decorated(package):
    lines = twin(package).splitlines()
    decorated = [lines[i + 1] for i, line in enumerate(lines) if line == "@micropython.viper"]
    assert [line.split("(")[0] for line in decorated] == ["def gather", "def pass_on", "def outer"]


def test_what_is_written_out_wherever_it_is_called_has_no_twin_of_its_own(package):
    (package / "shapes.py").write_text("ptr32 = None\n" + SHAPES)
    write(package)
    text = (package / "viper" / "shapes.py").read_text()
    assert "first_above_result" in text and "def first_above" not in text


def test_a_twin_has_no_stand_in_for_pointers(package):
    assert "def ptr32" not in twin(package)


def test_a_twin_imports_other_modules_from_one_package_up(package):
    file = package / "kernel.py"
    file.write_text("from .object import Whole\n" + KERNEL)
    text = twin(package)
    assert "from ..object import Whole" in text


def test_a_decorated_kernel_is_refused_with_its_line(package):
    file = package / "kernel.py"
    file.write_text(KERNEL.replace("def gather", "@staticmethod\ndef gather"))
    with pytest.raises(BadKernel, match=r"kernel.py: row 19: gather has a decorator"):
        twin(package)


def test_a_changed_kernel_and_a_lost_one_make_twins_stale(package):
    write(package)
    assert stale(package) == []
    (package / "viper" / "lost.py").write_text("")
    (package / "kernel.py").write_text(KERNEL.replace("const(3)", "const(5)"))
    assert [path.name for path in stale(package)] == ["kernel.py", "lost.py"]
    write(package)
    assert stale(package) == []


def test_a_twin_does_what_its_kernel_does(package, viper_runtime):
    write(package)
    plain, viper = (
        viper_runtime.run(DRIVE.format(package=p), modules=[package.parent], check=True).stdout
        for p in ("pack", "pack.viper")
    )
    assert len(plain) > 200
    assert plain == viper


def test_every_shape_does_what_it_did(package, viper_runtime):
    (package / "shapes.py").write_text("ptr32 = None\n" + SHAPES)
    write(package)
    assert (
        "first_above(" not in (package / "viper" / "shapes.py").read_text().split("def shapes")[1]
    )
    plain, viper = (
        viper_runtime.run(
            DRIVE_SHAPES.format(package=p), modules=[package.parent], heap=4 << 20, check=True
        ).stdout
        for p in ("pack", "pack.viper")
    )
    assert len(set(plain.splitlines())) == 60
    assert plain == viper


def test_a_loop_of_known_length_is_unrolled_over_a_pointer(package):
    (package / "shapes.py").write_text("ptr32 = None\n" + SHAPES)
    write(package)
    text = (package / "viper" / "shapes.py").read_text()
    three = text.split("def three")[1].split("@micropython")[0]
    assert "s_at = ptr32(int(s) + (at << 2))" in three
    assert "s_at[2] = s_at[2] - 2" in three and "while" not in three


def test_a_kernel_that_calls_kernels_takes_nothing_from_the_heap(package, viper_runtime):
    write(package)
    result = viper_runtime.run(UNDER_LOCK, modules=[package.parent], check=True)
    assert result.stdout.strip() == "nothing taken"


def test_arrays_are_passed_on_as_objects_and_results_taken_as_integers(package, monkeypatch):
    monkeypatch.setattr("zerorate_tools.twins.inlining.ONCE", 0)
    monkeypatch.setattr("zerorate_tools.twins.inlining.SMALL", 0)
    write(package)
    text = (package / "viper" / "kernel.py").read_text()
    assert "def outer(s_, c_, n: int) -> int:" in text
    assert "    s = ptr32(s_)\n" in text
    assert "int(gather(c_, n, s_)) & 1" in text and "\n    gather(c_, n, s_)\n" in text


def test_the_committed_twins_are_fresh(repository):
    firmware = repository / "firmware" / "zerorate"
    assert kernel_files(firmware)
    assert stale(firmware) == [], "`make viper` writes them again"
