"""The exported C is the firmware: it compiles alone, and gives the golden numbers."""

import ctypes
import shutil
import subprocess
from array import array

import numpy as np
import pytest
from zerorate import Sensor
from zerorate_tools.cli import main
from zerorate_tools.kernels.export import export_c

from ..firmware import trace
from ..firmware.trace_on_host import checksums, corrector_for, frames

pytestmark = pytest.mark.skipif(not shutil.which("cc"), reason="no C compiler (cc) here")
WARNINGS = ["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror"]


def sources_in(folder):
    """The firmware and its test program, as a compiler takes them."""
    return ["-I", folder, folder / "zerorate.c", folder / "test" / "zerorate_test.c"]


def test_the_test_program_says_that_the_state_is_equal(tmp_path, capsys):
    assert main(["export", "c", str(tmp_path / "c")]) == 0
    names = {line.rpartition("/c/")[2] for line in capsys.readouterr().out.splitlines()}
    assert {"zerorate.h", "zerorate.c", "zerorate_units.h", "test/zerorate_test.c"} <= names
    sources, program = sources_in(tmp_path / "c"), tmp_path / "program"
    subprocess.run(["cc", *WARNINGS, "-O1", *sources, "-o", program], check=True)
    assert subprocess.run([program], check=True, capture_output=True).stdout.startswith(b"equal")


def test_it_ends_the_golden_trace_in_the_golden_state(tmp_path, golden):
    export_c(tmp_path, Sensor(*trace.SENSOR))
    library = tmp_path / "zerorate.so"
    subprocess.run(
        ["cc", "-O1", "-shared", "-fPIC", tmp_path / "zerorate.c", "-o", library], check=True
    )
    made, corrector = ctypes.CDLL(str(library)), corrector_for("default")
    z = (ctypes.c_int32 * (len(corrector.state) + len(corrector.settings)))()
    made.zerorate_begin(z)
    z[len(corrector.state) :] = list(corrector.settings)  # the trace has limits of its own
    rows, dt_us = frames(trace.UPDATES["default"])
    for row, dt in zip(rows, dt_us.tolist()):
        made.zerorate_update(z, (ctypes.c_int32 * 7)(*row.tolist()), dt)
    state = array("i", z[: len(corrector.state)])
    assert checksums(state.tobytes(), b"")["state"] == golden["default"]["state"]


def test_a_model_is_applied_to_every_sample_as_on_a_board(tmp_path, matrix_model):
    assert main(["export", "c", str(tmp_path / "c"), "--model", str(matrix_model.path)]) == 0
    sources = sources_in(tmp_path / "c")
    subprocess.run(["cc", *WARNINGS, *sources, "-o", tmp_path / "program"], check=True)
    subprocess.run([tmp_path / "program"], check=True, capture_output=True)
    library = tmp_path / "zerorate.so"
    subprocess.run(["cc", "-shared", "-fPIC", *sources[:3], "-o", library], check=True)
    made, z = ctypes.CDLL(str(library)), (ctypes.c_int32 * 4096)()
    made.zerorate_begin(z)
    lsb, left = matrix_model.lsb_per_dps, []
    for rate in matrix_model.rates_dps:
        words = [round(v * lsb) for v in rate]
        sample = (ctypes.c_int32 * 7)(0, 0, 16384, 0, *words)
        made.zerorate_update(z, sample, 10000)
        left.append([(sample[4 + i] - words[i]) / lsb for i in range(3)])
    # each rate is rounded to an LSB on its way in and out, and what that leaves over is carried
    wanted = -matrix_model.rates_dps @ matrix_model.error.T
    np.testing.assert_allclose(left, wanted, atol=1.1 / lsb)


def test_a_scale_that_cannot_be_is_one_line(tmp_path, capsys):
    assert main(["export", "c", str(tmp_path), "--odr-hz", "0"]) == 2
    assert capsys.readouterr().err == "zerorate: odr_hz must be 0.01..8000, not 0.0\n"
