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


@pytest.fixture(scope="module")
def program(repository, tmp_path_factory):
    folder = tmp_path_factory.mktemp("yardstick")
    source = folder / "yardstick.c"
    source.write_text(program_in_c(repository / "firmware" / "zerorate"))
    try:
        return compiled(source, folder / "yardstick", "host")
    except MissingRuntime as missing:
        pytest.skip(str(missing))


def on_cpython(work):
    """(state, verdict and corrected words of every frame), bytes."""
    state, settings = array("i", work.state.tolist()), array("i", work.settings.tolist())
    frames = array("i")
    for row in work.rows.tolist():
        frame = array("i", row[1:])
        frames.append(step.step(state, settings, frame, row[0]))
        frames.extend(frame)
    return state.tobytes(), frames.tobytes()


@pytest.mark.parametrize("at_once", [1, 64])
def test_c_ends_in_the_state_that_python_ends_in(work, program, at_once):
    done = program.run(
        "\n",
        [COUNT, 1, at_once],
        files_in=work.files(),
        files_out=["state.out", "frames.out"],
        check=True,
    )
    assert done.files["state.out"] != work.files()["state.bin"]
    assert (done.files["state.out"], done.files["frames.out"]) == on_cpython(work)


def test_the_committed_text_is_fresh(repository):
    committed = repository / "host_tests" / "yardstick" / "yardstick.c"
    wanted = program_in_c(repository / "firmware" / "zerorate")
    assert committed.read_text() == wanted, f"python -m zerorate_tools.bench.c_program {committed}"


def test_text_outside_the_subset_is_refused_with_its_line(tmp_path):
    (tmp_path / "one.py").write_text("ptr32 = None\n\n\ndef f(s: ptr32) -> int:\n    return 1.5\n")
    with pytest.raises(NotKernel, match=r"one.py: row 5: Constant is not in the kernel subset"):
        kernels_in_c(tmp_path, ("one", "f"))
