"""The C yardstick: generated from the kernels, and equal to them to the last bit."""

from array import array

import pytest
from zerorate import step
from zerorate_tools.bench.c_expressions import NotKernel
from zerorate_tools.bench.c_kernels import kernels_in_c
from zerorate_tools.bench.c_program import compiled, program_in_c
from zerorate_tools.bench.workload import workload
from zerorate_tools.errors import MissingRuntime

COUNT = 1500


@pytest.fixture(scope="module")
def work():
    return workload(COUNT)


def on_cpython(work):
    state, settings = array("i", work.state.tolist()), array("i", work.settings.tolist())
    for row in work.rows.tolist():
        step.step(state, settings, array("i", row[1:]), row[0])
    return state.tobytes()


def test_c_ends_in_the_state_that_python_ends_in(work, repository, tmp_path):
    source = tmp_path / "yardstick.c"
    source.write_text(program_in_c(repository / "firmware" / "zerorate"))
    try:
        program = compiled(source, tmp_path / "yardstick", "host")
    except MissingRuntime as missing:
        pytest.skip(str(missing))
    done = program.run("\n", [COUNT, 1], files_in=work.files(), files_out=["state.out"], check=True)
    assert done.files["state.out"] != work.files()["state.bin"]
    assert done.files["state.out"] == on_cpython(work)


def test_the_committed_text_is_fresh(repository):
    committed = repository / "host_tests" / "yardstick" / "yardstick.c"
    wanted = program_in_c(repository / "firmware" / "zerorate")
    assert committed.read_text() == wanted, f"python -m zerorate_tools.bench.c_program {committed}"


def test_text_outside_the_subset_is_refused_with_its_line(tmp_path):
    (tmp_path / "one.py").write_text("ptr32 = None\n\n\ndef f(s: ptr32) -> int:\n    return 1.5\n")
    with pytest.raises(NotKernel, match=r"one.py: row 5: Constant is not in the kernel subset"):
        kernels_in_c(tmp_path, ("one", "f"))
